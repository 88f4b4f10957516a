// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/frame_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/random.hpp"

namespace sparse_mocap::eom2014 {
namespace {

using sparse_mocap::testing::Random;

constexpr double kWidth = 0.6;

// The probability to go from one of six frames to another; two sequences of three frames.
double step(int from, int to) {
  const int end = from < 3 ? 3 : 6;
  double probability = 0.0, rest = 1.0;
  for (const auto& [by, share] : {std::pair{0, 0.2}, {1, 0.5}, {2, 0.25}}) {
    if (from + by >= end) continue;
    rest -= share;
    if (to == from + by) probability += share;
  }
  return probability + rest / 6.0;
}

TEST(EomFramePath, AgreesWithEveryWayThroughTheFrames) {
  Random random(2);
  const Eigen::MatrixXd training = random.matrix(6, 2, 1.0), features = random.matrix(4, 2, 1.0);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(4, 6);
  for (int way = 0; way < 6 * 6 * 6 * 6; ++way) {
    const std::vector<int> frames{way % 6, way / 6 % 6, way / 36 % 6, way / 216};
    double probability = 1.0;
    for (int t = 0; t < 4; ++t) {
      const int frame = frames[static_cast<std::size_t>(t)];
      const double distance = (training.row(frame) - features.row(t)).norm() / kWidth;
      probability *= std::exp(-0.5 * distance * distance);
      if (t > 0) probability *= step(frames[static_cast<std::size_t>(t - 1)], frame);
    }
    for (int t = 0; t < 4; ++t) expected(t, frames[static_cast<std::size_t>(t)]) += probability;
  }
  for (Eigen::Index t = 0; t < 4; ++t) expected.row(t) /= expected.row(t).sum();
  EXPECT_LT((frame_posterior(features, training, {0, 3}, kWidth) - expected).norm(), 1e-10);
}

TEST(EomFramePath, ReadingsUnlikeAllFramesStillHaveProbabilities) {
  const Eigen::MatrixXd training = Eigen::MatrixXd::Random(5, 2);
  const Eigen::MatrixXd far = Eigen::MatrixXd::Constant(3, 2, 1e6);
  const Eigen::MatrixXd found = frame_posterior(far, training, {0}, 0.01);
  EXPECT_TRUE(found.allFinite());
  EXPECT_LT((found.rowwise().sum().array() - 1.0).abs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace sparse_mocap::eom2014
