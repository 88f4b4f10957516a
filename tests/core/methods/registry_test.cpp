// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/methods/registry.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "sparse_mocap/base/errors.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

std::string complaint(const std::function<void()>& call) {
  try {
    call();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

std::shared_ptr<const MotionDatabase> small_database() {
  return testing::database_of({testing::swaying_motion(testing::template_skeleton(), 1, 60, 25.0)});
}

TEST(Registry, MakesEveryMethodInEveryPreset) {
  const auto database = small_database();
  EXPECT_FALSE(method_names().empty());
  for (const auto name : method_names()) {
    EXPECT_FALSE(method_presets(name).empty());
    for (const auto preset : method_presets(name)) {
      const auto method = make_method(name, preset, database, testing::paper_sensors());
      const auto take = testing::readings_of(*database, 0, testing::paper_sensors());
      EXPECT_EQ(method->solve(take, Progress()).size(), take.size()) << name << " " << preset;
    }
  }
}

TEST(Registry, ListsWhatItKnowsWhenAskedForSomethingElse) {
  const auto database = small_database();
  const auto sensors = testing::paper_sensors();
  for (const auto& text : {complaint([] { method_presets("magic"); }), complaint([&] {
                             make_method("magic", "default", database, sensors);
                           })}) {
    EXPECT_NE(text.find("'magic'"), std::string::npos) << text;
    for (const auto name : method_names()) EXPECT_NE(text.find(name), std::string::npos);
  }
  for (const auto name : method_names()) {
    const auto text = complaint([&] { make_method(name, "fancy", database, sensors); });
    EXPECT_NE(text.find("'fancy'"), std::string::npos) << text;
    for (const auto preset : method_presets(name)) EXPECT_NE(text.find(preset), std::string::npos);
  }
}

TEST(Registry, HandsExclusionsOn) {
  const auto database = small_database();
  EXPECT_NE(complaint([&] {
              make_method("tautges2011", "default", database, testing::paper_sensors(), {0});
            }),
            "");
}

}  // namespace
}  // namespace sparse_mocap
