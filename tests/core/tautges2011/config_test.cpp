// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/config.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap::tautges2011 {
namespace {

// What the configuration complains about after the change, "" if nothing.
std::string complaint(const std::function<void(Config&)>& change) {
  Config config;
  change(config);
  try {
    config.validate();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

void expect_refused(const std::string& name, double Config::*setting,
                    const std::vector<double>& values) {
  for (const double value : values) {
    const std::string text = complaint([&](Config& config) { config.*setting = value; });
    EXPECT_NE(text.find(name), std::string::npos) << name << " = " << value << ": " << text;
  }
}

const double kNan = std::nan("");

TEST(Config, RefusesNumbersOutsideTheirRangeNamingThem) {
  expect_refused("neighbour_fraction", &Config::neighbour_fraction, {0.0, -1.0, 1.1, kNan});
  expect_refused("path_fraction", &Config::path_fraction, {0.0, -1.0, 1.1, kNan});
  expect_refused("leg_weight", &Config::leg_weight, {0.0, -1.0, 1e9, kNan});
  expect_refused("sharpness", &Config::sharpness, {-0.1, 1e9, kNan});
  expect_refused("offline_smoothing_s", &Config::offline_smoothing_s, {-0.1, 2.0, kNan});
  expect_refused("regression_ridge", &Config::regression_ridge, {-1.0, kNan});
  expect_refused("kernel_power", &Config::kernel_power, {0.0, -1.0, 2.1, kNan});
  expect_refused("pca_variance", &Config::pca_variance, {0.0, 1.1, kNan});
  expect_refused("foot_lock", &Config::foot_lock, {-0.1, 1.1, kNan});
  expect_refused("weight", &Config::w_prior, {-1.0, kNan, 1e9});
  expect_refused("weight", &Config::w_contr, {-1.0, kNan, 1e9});
  expect_refused("weight", &Config::w_motion, {-1.0, kNan});
  expect_refused("weight", &Config::w_smooth, {-1.0, kNan});
  expect_refused("w_pose", &Config::w_pose, {0.0});
  expect_refused("w_prior", &Config::w_prior, {0.0});
}

TEST(Config, RefusesCountsAndGraphsThatCannotWork) {
  const auto refuses = [](const std::string& name, const std::function<void(Config&)>& change) {
    const std::string text = complaint(change);
    EXPECT_NE(text.find(name), std::string::npos) << name << ": " << text;
  };
  refuses("num_neighbours", [](Config& c) { c.num_neighbours = 0; });
  refuses("num_neighbours", [](Config& c) { c.num_neighbours = 1'000'000'000; });
  refuses("num_paths", [](Config& c) { c.num_paths = 0; });
  refuses("num_paths", [](Config& c) { c.num_paths = c.num_neighbours + 1; });
  refuses("max_iterations", [](Config& c) { c.max_iterations = 0; });
  refuses("penalty", [](Config& c) { c.olng.penalty = -1.0; });
  refuses("forgetting", [](Config& c) { c.olng.forgetting = 1.1; });
  refuses("forgetting", [](Config& c) { c.olng.forgetting = kNan; });
  refuses("window", [](Config& c) { c.olng.window = -1; });
  refuses("features", [](Config& c) { c.features.parts.clear(); });
}

TEST(Config, StatesTheRangeAndTheValue) {
  EXPECT_EQ(complaint([](Config& c) { c.foot_lock = 1.5; }),
            "foot_lock must be between 0.000000 and 1.000000, got 1.500000");
}

TEST(Preset, EachIsValid) {
  for (const auto name : preset_names()) EXPECT_NO_THROW(preset(name).validate()) << name;
  EXPECT_EQ(preset_names().front(), "default");
}

TEST(Preset, NamedPaperHasThePapersNumbers) {
  const Config paper = preset("paper");
  EXPECT_EQ(paper.num_neighbours, 4096);
  EXPECT_EQ(paper.num_paths, 256);
  EXPECT_EQ(paper.w_prior, 5.0);
  EXPECT_EQ(paper.w_contr, 1.0);
  EXPECT_EQ(paper.w_pose, 0.6);
  EXPECT_EQ(paper.w_motion, 0.2);
  EXPECT_EQ(paper.w_smooth, 0.2);
  EXPECT_EQ(paper.kernel_power, 0.5);
  EXPECT_EQ(paper.pca_variance, 0.99);
  EXPECT_EQ(paper.weight_rule, WeightRule::linear);
  EXPECT_EQ(paper.pose_space, PoseSpace::angles);
  EXPECT_EQ(paper.motion_rule, MotionRule::taylor);
  EXPECT_EQ(paper.features.look_ahead(), 0);
  EXPECT_GT(paper.olng.window, 0);
}

TEST(Preset, UnknownListsTheKnownOnes) {
  try {
    preset("fast");
    FAIL();
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("'fast'"), std::string::npos);
    for (const auto name : preset_names()) EXPECT_NE(text.find(name), std::string::npos);
  }
}

}  // namespace
}  // namespace sparse_mocap::tautges2011
