// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/features.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/synthetic.hpp"

namespace sparse_mocap::tautges2011 {
namespace {

using testing::database_of;
using testing::paper_sensors;
using testing::swaying_motion;
using testing::template_skeleton;

FeatureLayout layout_of(std::vector<std::vector<Tap>> parts) {
  FeatureLayout layout;
  layout.parts = std::move(parts);
  return layout;
}

TEST(FeatureLayout, OfThePaperIsTheReadingItself) {
  const FeatureLayout layout;
  EXPECT_EQ(layout.num_dimensions(4), 12);
  EXPECT_EQ(layout.look_ahead(), 0);
  EXPECT_EQ(layout.reach_back(), 0);
}

TEST(FeatureLayout, KnowsHowFarItReaches) {
  const FeatureLayout layout = layout_of({{{-6, 1.0}, {1, 0.5}}, {{3, 1.0}}});
  EXPECT_EQ(layout.num_dimensions(2), 12);
  EXPECT_EQ(layout.look_ahead(), 3);
  EXPECT_EQ(layout.reach_back(), 6);
}

TEST(GaussianTaps, SumToOneAndPeakAtTheCentre) {
  const auto taps = gaussian_taps(-2.0, 1.5, -6, 1);
  ASSERT_EQ(taps.size(), 8U);
  double total = 0.0;
  for (const Tap& tap : taps) {
    total += tap.weight;
    EXPECT_LE(tap.weight, taps[4].weight);
  }
  EXPECT_EQ(taps[4].frame, -2);
  EXPECT_NEAR(total, 1.0, 1e-12);
  EXPECT_NEAR(taps[5].weight / taps[4].weight, std::exp(-0.5 / 2.25), 1e-12);
}

// Readings of one sensor: 1, 2, 4, 8, ... in all three columns, times 1, 10, 100.
FeatureRows powers(Eigen::Index rows) {
  FeatureRows out(rows, 3);
  for (Eigen::Index t = 0; t < rows; ++t) {
    const float value = std::ldexp(1.0F, static_cast<int>(t));
    out.row(t) << value, 10 * value, 100 * value;
  }
  return out;
}

TEST(FeatureAt, IsTheWeightedSumOfItsTaps) {
  const FeatureLayout layout = layout_of({{{0, 1.0}, {-1, -0.5}}, {{2, 2.0}}});
  const std::vector<float> weights{1.0F, 2.0F, 3.0F};
  std::vector<float> feature(6);
  feature_at(powers(8), 0, 8, 3, layout, weights, feature);
  EXPECT_EQ(feature, (std::vector<float>{6, 120, 1800, 64, 1280, 19200}));
}

TEST(FeatureAt, HoldsTheOutermostReadingBeyondTheKnownRows) {
  const FeatureLayout layout = layout_of({{{-5, 1.0}}, {{5, 1.0}}});
  const std::vector<float> weights{1.0F, 1.0F, 1.0F};
  std::vector<float> feature(6);
  feature_at(powers(8), 2, 6, 4, layout, weights, feature);
  EXPECT_EQ(feature, (std::vector<float>{4, 40, 400, 32, 320, 3200}));
}

TEST(FeatureAt, KeepsSilenceInThePartsThatMeetIt) {
  FeatureRows readings = powers(4);
  readings(1, 1) = std::numeric_limits<float>::quiet_NaN();
  const FeatureLayout layout = layout_of({{{0, 1.0}}, {{-1, 1.0}}});
  const std::vector<float> weights{1.0F, 1.0F, 1.0F};
  std::vector<float> feature(6);
  feature_at(readings, 0, 4, 2, layout, weights, feature);
  EXPECT_EQ(feature[1], 40.0F);
  EXPECT_TRUE(std::isnan(feature[4]));
  EXPECT_EQ(feature[3], 2.0F);
}

TEST(DatabaseReadings, AreThoseOfTheSensorsInTheirOrderAndPlace) {
  const auto database = database_of({swaying_motion(template_skeleton(), 1, 30, 50.0)});
  const std::vector<WornSensor> sensors{{find_site("head"), 1.0}, {find_site("left_ankle"), 0.25}};
  const FeatureRows readings = database_readings(*database, sensors);
  ASSERT_EQ(readings.cols(), 6);
  for (int n = 0; n < database->num_frames(); ++n) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(readings(n, k), database->specific_force_end()(n, 3 * find_site("head") + k));
      const int column = 3 * find_site("left_ankle") + k;
      EXPECT_NEAR(readings(n, 3 + k),
                  0.75F * database->specific_force_pivot()(n, column) +
                      0.25F * database->specific_force_end()(n, column),
                  1e-5F);
    }
  }
}

TEST(DatabaseFeatures, DoNotReachOverClipBorders) {
  const auto database = database_of({swaying_motion(template_skeleton(), 1, 16, 50.0),
                                     swaying_motion(template_skeleton(), 2, 16, 50.0)});
  const FeatureRows readings = database_readings(*database, paper_sensors());
  const FeatureLayout layout = layout_of({{{-3, 1.0}}, {{2, 1.0}}});
  const std::vector<float> weights(12, 1.0F);
  const FeatureRows features = database_features(*database, readings, layout, weights);
  for (const Clip& clip : database->clips()) {
    for (int n = clip.begin; n < clip.end; ++n) {
      EXPECT_EQ(FeatureRows(features.row(n).head(12)),
                FeatureRows(readings.row(std::max(n - 3, clip.begin))));
      EXPECT_EQ(FeatureRows(features.row(n).tail(12)),
                FeatureRows(readings.row(std::min(n + 2, clip.end - 1))));
    }
  }
}

}  // namespace
}  // namespace sparse_mocap::tautges2011
