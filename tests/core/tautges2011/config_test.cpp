// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/config.hpp"

#include <gtest/gtest.h>

#include <string>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap::tautges2011 {
namespace {

TEST(Config, HasThePapersNumbers) {
  const Config paper = config_of({});
  EXPECT_EQ(paper.num_neighbours, 4096);
  EXPECT_EQ(paper.num_paths, 256);
  EXPECT_EQ(paper.w_prior, 5.0);
  EXPECT_EQ(paper.w_contr, 1.0);
  EXPECT_EQ(paper.w_pose, 0.6);
  EXPECT_EQ(paper.w_motion, 0.2);
  EXPECT_EQ(paper.w_smooth, 0.2);
  EXPECT_EQ(paper.pca_variance, 0.99);
  EXPECT_EQ(paper.prior, PriorModel::kernel);
  EXPECT_TRUE(paper.is_time_warping);
  EXPECT_NO_THROW(options().validate(paper));
}

TEST(Config, TakesTheOptionsThatAreNamed) {
  const Config config = config_of({"paper",
                                   {{"num_neighbours", "512"},
                                    {"window_readings", "8"},
                                    {"w_contr", "0.25"},
                                    {"prior", "normal"},
                                    {"is_time_warping", "false"}}});
  EXPECT_EQ(config.num_neighbours, 512);
  EXPECT_EQ(config.window_readings, 8);
  EXPECT_EQ(config.w_contr, 0.25);
  EXPECT_EQ(config.prior, PriorModel::normal);
  EXPECT_FALSE(config.is_time_warping);
}

TEST(Config, RefusesAnUnknownPreset) {
  try {
    config_of({"fast", {}});
    FAIL() << "nothing was thrown";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "unknown preset 'fast'; tautges2011 has paper");
  }
}

// The paper: K = 4096 and I = 256 of 560,000 frames.
TEST(Config, ShrinksWithSmallDatabasesOnly) {
  const Config large = Config().scaled_to(560'000);
  EXPECT_EQ(large.num_neighbours, 4096);
  EXPECT_EQ(large.num_paths, 256);
  const Config small = Config().scaled_to(30'000);
  EXPECT_EQ(small.num_neighbours, 1500);
  EXPECT_EQ(small.num_paths, 32);
  const Config tiny = Config().scaled_to(3);
  EXPECT_EQ(tiny.num_neighbours, 1);
  EXPECT_EQ(tiny.num_paths, 1);
  Config unscaled;
  unscaled.scales_with_database = false;
  EXPECT_EQ(unscaled.scaled_to(30'000).num_neighbours, 4096);
  EXPECT_EQ(unscaled.scaled_to(30'000).num_paths, 256);
}

}  // namespace
}  // namespace sparse_mocap::tautges2011
