// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/config.hpp"

#include <gtest/gtest.h>

#include <tuple>
#include <utility>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap::path_regression {
namespace {

TEST(Config, OfLiveQualityLooksOneFrameAhead) {
  const Config config = live_config();
  EXPECT_NO_THROW(options().validate(config));
  EXPECT_EQ(retrieval::FeatureLayout(config.features, 25.0).look_ahead(), 1);
  EXPECT_EQ(retrieval::FeatureLayout(config.features, 50.0).look_ahead(), 2);
  EXPECT_EQ(retrieval::FeatureLayout(config.regression_features, 25.0).look_ahead(), 1);
  EXPECT_GT(config.fit.step, 0.0);
}

TEST(Config, OfWholeTakesLooksAsFarAheadAsBack) {
  const Config config = whole_take_config();
  EXPECT_NO_THROW(options().validate(config));
  for (const auto& parts : {config.features, config.regression_features}) {
    const retrieval::FeatureLayout layout(parts, 25.0);
    EXPECT_EQ(layout.look_ahead(), layout.reach_back());
  }
  EXPECT_GT(config.num_paths, live_config().num_paths);
}

TEST(Config, TakesSettingsOnTopOfEither) {
  const MethodSettings settings{
      "default", {{"sharpness", "2.5"}, {"contact_weight", "7"}, {"use_tempo_copies", "false"}}};
  for (const auto& [config, base] : {std::pair{live_config(settings), live_config()},
                                     std::pair{whole_take_config(settings), whole_take_config()}}) {
    EXPECT_EQ(config.sharpness, 2.5);
    EXPECT_EQ(config.fit.contact, 7.0);
    EXPECT_FALSE(config.use_tempo_copies);
    EXPECT_EQ(config.forgetting, base.forgetting);
  }
  EXPECT_THROW(live_config({"paper", {}}), ConfigError);
  EXPECT_THROW(live_config({"default", {{"lag_s", "0.6"}}}), ConfigError);
}

TEST(Config, HoldsPosesBackForWhatRetrievalLeavesOfTheLag) {
  EXPECT_EQ(live_config().held_frames(25.0), 0);
  for (const auto& [lag_s, at_25_hz, at_50_hz] :
       {std::tuple{"0.08", 1, 2}, {"0.1", 1, 3}, {"0.2", 4, 8}, {"0.4", 9, 18}}) {
    const Config config = live_config({"default", {{"lag_s", lag_s}}});
    EXPECT_EQ(config.held_frames(25.0), at_25_hz) << lag_s;
    EXPECT_EQ(config.held_frames(50.0), at_50_hz) << lag_s;
  }
}

}  // namespace
}  // namespace sparse_mocap::path_regression
