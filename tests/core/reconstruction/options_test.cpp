// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/reconstruction/options.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

namespace sparse_mocap {
namespace {

enum class Colour { red, green };

struct Settings {
  double weight = 0.5;
  int count = 3;
  bool is_used = true;
  Colour colour = Colour::green;
};

OptionTable<Settings> table() {
  return OptionTable<Settings>()
      .number("weight", &Settings::weight, 0.0, 2.5, "how much it counts")
      .integer("count", &Settings::count, 1, 100, "how many")
      .flag("is_used", &Settings::is_used, "whether it is used")
      .choice("colour", &Settings::colour, {"red", "green"}, "which colour");
}

std::string complaint(const std::function<void()>& call) {
  try {
    call();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

std::string complaint_about(const std::string& name, const std::string& text) {
  Settings settings;
  return complaint([&] { table().apply({{name, text}}, settings); });
}

TEST(OptionTable, DescribesNamesRangesAndDefaults) {
  const auto options = table().described(Settings());
  ASSERT_EQ(options.size(), 4U);
  EXPECT_EQ(options[0].name, "weight");
  EXPECT_EQ(options[0].help, "how much it counts");
  EXPECT_EQ(options[0].highest, 2.5);
  EXPECT_EQ(options[0].default_value, "0.5");
  EXPECT_EQ(options[1].kind, OptionInfo::Kind::integer);
  EXPECT_EQ(options[1].default_value, "3");
  EXPECT_EQ(options[2].default_value, "true");
  EXPECT_EQ(options[3].choices, (std::vector<std::string>{"red", "green"}));
  EXPECT_EQ(options[3].default_value, "green");
}

TEST(OptionTable, SetsWhatIsNamedAndLeavesTheRest) {
  Settings settings;
  table().apply({{"weight", "1.25"}, {"is_used", "false"}, {"colour", "red"}}, settings);
  EXPECT_EQ(settings.weight, 1.25);
  EXPECT_EQ(settings.count, 3);
  EXPECT_FALSE(settings.is_used);
  EXPECT_EQ(settings.colour, Colour::red);
  table().apply({{"count", "1e2"}, {"is_used", "1"}}, settings);
  EXPECT_EQ(settings.count, 100);
  EXPECT_TRUE(settings.is_used);
}

TEST(OptionTable, WhatItDescribesCanBeSet) {
  Settings changed{1.0 / 3.0, 77, false, Colour::red}, settings;
  for (const auto& option : table().described(changed))
    table().apply({{option.name, option.default_value}}, settings);
  EXPECT_EQ(settings.weight, changed.weight);
  EXPECT_EQ(settings.count, changed.count);
  EXPECT_EQ(settings.is_used, changed.is_used);
  EXPECT_EQ(settings.colour, changed.colour);
}

TEST(OptionTable, SaysWhatIsPossible) {
  EXPECT_EQ(complaint_about("weight", "3"), "weight must be a number from 0 to 2.5, got '3'");
  EXPECT_EQ(complaint_about("count", "2.5"),
            "count must be a whole number from 1 to 100, got '2.5'");
  EXPECT_EQ(complaint_about("is_used", "yes"), "is_used must be true or false, got 'yes'");
  EXPECT_EQ(complaint_about("colour", "blue"), "colour must be one of red, green, got 'blue'");
  for (const char* text : {"", "nan", "inf", "1,5", "1.5x", " 1", "0x1"})
    EXPECT_NE(complaint_about("weight", text), "") << text;
  EXPECT_EQ(complaint_about("weigth", "1"),
            "unknown option 'weigth'; did you mean 'weight'? Known are weight, count, is_used, "
            "colour");
}

TEST(OptionTable, ChecksSettingsThatWereMadeInCode) {
  EXPECT_NO_THROW(table().validate({}));
  EXPECT_NE(complaint([] {
              table().validate({-1.0, 3, true, Colour::red});
            }).find("weight"),
            std::string::npos);
  EXPECT_NE(complaint([] { table().validate({std::nan(""), 3, true, Colour::red}); }), "");
}

TEST(OptionTable, MayBeEmpty) {
  Settings settings;
  EXPECT_EQ(complaint([&] {
              OptionTable<Settings>().apply({{"weight", "1"}}, settings);
            }),
            "unknown option 'weight'; this method has none");
}

}  // namespace
}  // namespace sparse_mocap
