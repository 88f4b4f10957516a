// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/features.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sparse_mocap/retrieval/signals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::retrieval {
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

TEST(SmoothedSignals, BecomeTapsThatSumToTheGainAndPeakAtTheCentre) {
  const FeatureLayout layout({{{-0.08, 0.06, -0.24, 0.04, 1.0}}}, 25.0);
  const auto& taps = layout.parts.front();
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

// The same stretch of time at twice the rate, the same weight of each moment.
TEST(SmoothedSignals, ReachAsFarAtEveryRate) {
  const std::vector<FeaturePart> part{{{-0.08, 0.06, -0.24, 0.04, -0.5}}};
  const FeatureLayout slow(part, 25.0), fast(part, 50.0);
  EXPECT_EQ(fast.look_ahead(), 2 * slow.look_ahead());
  EXPECT_EQ(fast.reach_back(), 2 * slow.reach_back());
  double total = 0.0;
  for (const Tap& tap : fast.parts[0]) total += tap.weight;
  EXPECT_NEAR(total, -0.5, 1e-12);
  EXPECT_NEAR(fast.parts[0][2].weight / fast.parts[0][4].weight,
              slow.parts[0][1].weight / slow.parts[0][2].weight, 1e-12);
}

// Averages that overlap in one part add up.
TEST(SmoothedSignals, MayBeSubtracted) {
  const FeatureLayout change({{{0.0, 0.04, 0.0, 0.0, 0.5}, {-0.16, 0.04, -0.16, -0.16, -0.5}}},
                             25.0);
  ASSERT_EQ(change.parts[0].size(), 2U);
  EXPECT_EQ(change.parts[0][0].frame, 0);
  EXPECT_EQ(change.parts[0][0].weight, 0.5);
  EXPECT_EQ(change.parts[0][1].frame, -4);
  EXPECT_EQ(change.parts[0][1].weight, -0.5);
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
  const FeatureRows rows = powers(8);
  feature_at({rows, 0, 8, 3}, layout, weights, feature);
  EXPECT_EQ(feature, (std::vector<float>{6, 120, 1800, 64, 1280, 19200}));
}

TEST(FeatureAt, HoldsTheOutermostReadingBeyondTheKnownRows) {
  const FeatureLayout layout = layout_of({{{-5, 1.0}}, {{5, 1.0}}});
  const std::vector<float> weights{1.0F, 1.0F, 1.0F};
  std::vector<float> feature(6);
  const FeatureRows rows = powers(8);
  feature_at({rows, 2, 6, 4}, layout, weights, feature);
  EXPECT_EQ(feature, (std::vector<float>{4, 40, 400, 32, 320, 3200}));
}

TEST(FeatureAt, KeepsSilenceInThePartsThatMeetIt) {
  FeatureRows readings = powers(4);
  readings(1, 1) = std::numeric_limits<float>::quiet_NaN();
  const FeatureLayout layout = layout_of({{{0, 1.0}}, {{-1, 1.0}}});
  const std::vector<float> weights{1.0F, 1.0F, 1.0F};
  std::vector<float> feature(6);
  feature_at({readings, 0, 4, 2}, layout, weights, feature);
  EXPECT_EQ(feature[1], 40.0F);
  EXPECT_TRUE(std::isnan(feature[4]));
  EXPECT_EQ(feature[3], 2.0F);
}

TEST(DatabaseFeatures, DoNotReachOverClipBorders) {
  const auto database = database_of({swaying_motion(template_skeleton(), 1, 16, 50.0),
                                     swaying_motion(template_skeleton(), 2, 16, 50.0)});
  const FeatureRows readings =
      database_signals(*database, compared_signals(paper_sensors(), false));
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
}  // namespace sparse_mocap::retrieval
