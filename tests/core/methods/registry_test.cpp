// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/methods/registry.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <string>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/database/model.hpp"
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

MethodContext small_context() {
  MethodContext context;
  context.database =
      testing::database_of({testing::swaying_motion(testing::template_skeleton(), 1, 60, 25.0)});
  context.sensors = testing::paper_sensors();
  return context;
}

// With all that the method asks of sensors.
MethodContext context_for(const MethodEntry& method) {
  MethodContext context = small_context();
  for (Sensor& sensor : context.sensors)
    sensor.channels = method.info.required_channels | method.info.one_channel_of;
  return context;
}

void make(const MethodEntry& method, const MethodSettings& settings, const MethodContext& context) {
  if (method.make_live != nullptr) make_live_method(method, settings, context);
  if (method.make_whole_take != nullptr) make_whole_take_method(method, settings, context);
}

// What is wrong with the settings, and with what the method has to work with.
std::string refusal(const MethodEntry& method, const MethodSettings& settings,
                    const MethodContext& context) {
  return complaint([&] { make(method, settings, context); });
}

TEST(Registry, DescribesEveryMethod) {
  ASSERT_FALSE(methods().empty());
  EXPECT_EQ(methods().front().info.name, "path_regression");
  std::set<std::string> names;
  for (const auto& [info, make_live, make_whole_take, train, segment] : methods()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_FALSE(info.title.empty());
    EXPECT_FALSE(info.summary.empty());
    EXPECT_FALSE(info.presets.empty());
    EXPECT_FALSE((info.required_channels | info.one_channel_of).is_empty());
    EXPECT_TRUE(info.optional_channels.has_all(info.one_channel_of));
    EXPECT_LE(info.fewest_sensors, info.most_sensors);
    EXPECT_TRUE(make_live != nullptr || make_whole_take != nullptr);
    EXPECT_TRUE(train != nullptr || !info.needs_model);
    std::set<std::string> options;
    for (const auto& option : info.options) {
      EXPECT_TRUE(options.insert(option.name).second) << option.name;
      EXPECT_FALSE(option.help.empty()) << option.name;
      EXPECT_NO_THROW(parsed_option(option, option.default_value)) << option.name;
    }
  }
}

TEST(Registry, MakesEveryMethodInEveryPresetWithEveryOption) {
  for (const auto& method : methods()) {
    if (method.info.needs_model || method.info.needs_body) continue;
    MethodSettings settings;
    for (const auto& option : method.info.options)
      settings.options[option.name] = option.default_value;
    for (const auto& preset : method.info.presets) {
      settings.preset = preset.name;
      EXPECT_EQ(refusal(method, settings, context_for(method)), "") << method.info.name;
    }
  }
}

TEST(Registry, MakesTheVariantsOfEveryExperiment) {
  for (const auto& method : methods()) {
    for (const auto& experiment : method.info.experiments) {
      EXPECT_FALSE(experiment.help.empty());
      EXPECT_GE(experiment.variants.size(), 2U);
      if (method.info.needs_model || method.info.needs_body) continue;
      for (const auto& variant : experiment.variants) {
        MethodContext context = context_for(method);
        if (!variant.sensors.empty()) context.sensors = variant.sensors;
        EXPECT_EQ(refusal(method, {"", variant.options}, context), "") << variant.label;
      }
    }
  }
}

TEST(Registry, ListsWhatItKnowsWhenAskedForSomethingElse) {
  std::string names;
  for (const auto& method : methods()) names += (names.empty() ? "" : ", ") + method.info.name;
  EXPECT_EQ(complaint([] { find_method("magic"); }), "unknown method 'magic'; known are " + names);
  for (const auto& method : methods()) {
    if (method.info.needs_model || method.info.needs_body) continue;
    const auto preset = refusal(method, {"fancy", {}}, context_for(method));
    EXPECT_NE(preset.find("'fancy'"), std::string::npos) << preset;
    for (const auto& known : method.info.presets)
      EXPECT_NE(preset.find(known.name), std::string::npos) << preset;
    const auto option = refusal(method, {"", {{"num_neighbors", "3"}}}, context_for(method));
    EXPECT_NE(option.find("did you mean 'num_neighbours'"), std::string::npos) << option;
  }
}

TEST(Registry, SaysWhatAMethodLacks) {
  const MethodEntry& method = methods().front();
  const auto refused = [&](const std::function<void(MethodContext&)>& change) {
    MethodContext context = small_context();
    change(context);
    return refusal(method, {}, context);
  };
  EXPECT_EQ(refused([](auto& c) { c.database = nullptr; }),
            "method path_regression needs a motion database (--database)");
  EXPECT_EQ(refused([](auto& c) { c.sensors.clear(); }),
            "method path_regression needs 1 to 14 sensors, got 0");
  EXPECT_EQ(refused([](auto& c) { c.sensors[1].channels = Channel::orientation; }),
            "method path_regression needs specific_force of every sensor, and right_wrist does not "
            "give it");
  EXPECT_EQ(refused([](auto& c) { c.excluded_clips = {0}; }),
            "every clip of the database is excluded");
}

TEST(Registry, AsksForOneOfSeveralChannels) {
  const MethodEntry& method = find_method("liu2011");
  MethodContext context = context_for(method);
  for (const Channel channel : {Channel::position, Channel::orientation}) {
    context.sensors[1].channels = channel;
    EXPECT_EQ(refusal(method, {}, context), "");
  }
  context.sensors[1].channels = Channel::specific_force;
  EXPECT_EQ(
      refusal(method, {}, context),
      "method liu2011 needs orientation or position of every sensor, and right_wrist does not "
      "give it");
}

TEST(Registry, SaysWhichWayAMethodDoesNotWork) {
  const MethodEntry& method = find_method("tautges2011");
  EXPECT_EQ(complaint([&] { make_whole_take_method(method, {}, small_context()); }),
            "method tautges2011 has no best quality: it works live only, frame by frame");
  MethodEntry whole_takes_only = methods().front();
  whole_takes_only.make_live = nullptr;
  EXPECT_NE(complaint([&] {
              make_live_method(whole_takes_only, {}, small_context());
            }).find("does not work live"),
            std::string::npos);
}

TEST(TrainModel, RefusesMethodsThatLearnNothing) {
  EXPECT_EQ(complaint([] { train_model(methods().front(), {}, {{}}, Progress()); }),
            "method path_regression needs no trained model: it works on a motion database as it "
            "is");
}

}  // namespace
}  // namespace sparse_mocap
