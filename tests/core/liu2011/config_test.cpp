// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/config.hpp"

#include <gtest/gtest.h>

#include "sparse_mocap/base/errors.hpp"
#include "support/refusals.hpp"

namespace sparse_mocap::liu2011 {
namespace {

TEST(Config, SearchesByTheSensorsUnlessAskedForThePaper) {
  EXPECT_GT(config_of({}).search_position_per_m, 0.0);
  EXPECT_GT(config_of({}).search_orientation, 0.0);
  const Config paper = config_of({"paper", {}});
  EXPECT_EQ(paper.search_position_per_m, 0.0);
  EXPECT_EQ(paper.search_orientation, 0.0);
  EXPECT_EQ(paper.history_trust, 1.0);
  EXPECT_FALSE(paper.joint_residuals);
  EXPECT_EQ(paper.num_neighbours, config_of({}).num_neighbours);
}

TEST(Config, TakesTheOptionsThatAreNamed) {
  const Config config = config_of(
      {"paper", {{"prior", "local_pca"}, {"search_orientation", "2"}, {"num_neighbours", "40"}}});
  EXPECT_EQ(config.prior, PriorModel::local_pca);
  EXPECT_EQ(config.search_orientation, 2.0);
  EXPECT_EQ(config.num_neighbours, 40);
}

TEST(Config, RefusesAnUnknownPreset) {
  EXPECT_REFUSED(ConfigError, "unknown preset 'fast'; liu2011 has default and paper",
                 config_of({"fast", {}}));
}

TEST(Config, HasPosesForTheHistory) {
  Config config;
  config.history_s = 0.1;
  EXPECT_EQ(config.num_poses(40.0), 4);
  EXPECT_EQ(config.num_poses(25.0), 3);
  EXPECT_EQ(config.num_poses(10.0), 2);  // a velocity takes two
}

}  // namespace
}  // namespace sparse_mocap::liu2011
