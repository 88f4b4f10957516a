// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/known_readings.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sparse_mocap::eom2014 {
namespace {

// A cycle of so many frames, in all channels.
ReadingRows cycle_of(double period_frames, double size, Eigen::Index num_frames) {
  ReadingRows rows(num_frames, 6);
  for (Eigen::Index t = 0; t < num_frames; ++t)
    for (Eigen::Index c = 0; c < 6; ++c)
      rows(t, c) = size * std::sin(2.0 * kPi * static_cast<double>(t) / period_frames +
                                   static_cast<double>(c));
  return rows;
}

KnownReadings two_types() {
  KnownReadings known;
  known.rows.resize(160, 6);
  known.rows << cycle_of(33.0, 4.0, 80), cycle_of(20.0, 9.0, 80);
  known.begins = {0, 80};
  known.type_begins = {0, 80};
  known.scale = ReadingScale::of(known.rows);
  return known;
}

TEST(EomKnownReadings, TellWhichTypeOfMotionATakeIs) {
  ReadingRows take(120, 6);
  take << cycle_of(36.0, 4.4, 60), cycle_of(18.0, 8.5, 60);
  const Eigen::MatrixXd weights = type_weights(take, two_types());
  ASSERT_EQ(weights.rows(), 120);
  ASSERT_EQ(weights.cols(), 2);
  for (Eigen::Index t = 0; t < 120; ++t) EXPECT_NEAR(weights.row(t).sum(), 1.0, 1e-9);
  EXPECT_GT(weights.col(0).head(50).minCoeff(), 0.9);
  EXPECT_GT(weights.col(1).tail(50).minCoeff(), 0.9);
}

TEST(EomKnownReadings, AreOfOneTypeWhereNoOtherIsKnown) {
  KnownReadings known = two_types();
  known.type_begins = {0};
  EXPECT_EQ(type_weights(cycle_of(20.0, 9.0, 12), known), Eigen::MatrixXd::Ones(12, 1));
}

// The probabilities of all ways through three readings, added up one by one.
TEST(EomKnownReadings, WeightsAreThoseOfAllWaysThroughTheTypes) {
  const KnownReadings known = two_types();
  ReadingRows take = cycle_of(33.0, 4.0, 3);
  take.row(1) *= 1.3;
  const Eigen::MatrixXd found = type_weights(take, known);
  Eigen::MatrixXd emitted(3, 2);
  const Eigen::MatrixXd own = features(take, known.scale, 8);
  const Eigen::MatrixXd all = sequence_features(known.rows, known.begins, known.scale, 8);
  for (Eigen::Index t = 0; t < 3; ++t)
    for (Eigen::Index k = 0; k < 2; ++k) {
      double nearest = 1e9;
      for (Eigen::Index i = 80 * k; i < 80 * (k + 1); ++i)
        nearest = std::min(nearest, (all.row(i) - own.row(t)).squaredNorm());
      emitted(t, k) = std::exp(-0.5 * nearest / 0.25);
    }
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3, 2);
  for (int way = 0; way < 8; ++way) {
    double probability = 1.0;
    for (int t = 0; t < 3; ++t) {
      probability *= emitted(t, (way >> t) & 1);
      if (t > 0) probability *= ((way >> t) & 1) == ((way >> (t - 1)) & 1) ? 0.995 : 0.005;
    }
    for (int t = 0; t < 3; ++t) expected(t, (way >> t) & 1) += probability;
  }
  expected.array().colwise() /= expected.rowwise().sum().array();
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace sparse_mocap::eom2014
