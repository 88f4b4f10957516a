// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/motion_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "sparse_mocap/base/errors.hpp"
#include "support/random.hpp"
#include "support/refusals.hpp"

namespace sparse_mocap::eom2014 {
namespace {

using sparse_mocap::testing::Random;

// Two sequences of a movement that comes round, with a little noise.
MotionData made_data(int frames, double noise) {
  Random random(3);
  const Eigen::VectorXd amplitude = random.column(6, 1.0), phase = random.column(6, 3.0);
  MotionData data;
  data.poses.resize(frames, 6);
  data.velocities.resize(frames - 2, 6);
  for (int t = 0; t < frames; ++t)
    data.poses.row(t) =
        (amplitude.array() * (phase.array() + 0.3 * t).sin()).matrix() + random.column(6, noise);
  for (int t = 1, row = 0; t < frames; ++t) {
    if (t == frames / 2) continue;
    data.velocities.row(row++) = 30.0 * (data.poses.row(t) - data.poses.row(t - 1));
    data.steps.push_back(t);
  }
  return data;
}

double central_difference(const std::function<double(double)>& value) {
  constexpr double kStep = 1e-5;
  return (value(kStep) - value(-kStep)) / (2.0 * kStep);
}

TEST(EomMotionModel, RefusesTooFewFramesAndWhatDoesNotMove) {
  MotionData few = made_data(6, 0.0);
  EXPECT_REFUSED(ConfigError, "at least 10 frames, got 6",
                 MotionModel::learnt(few, LearningSettings(), Progress()));
  MotionData still = made_data(20, 0.0);
  still.poses.setOnes();
  EXPECT_REFUSED(ConfigError, "nothing moves",
                 MotionModel::learnt(still, LearningSettings(), Progress()));
}

TEST(EomMotionModel, GradientOfThePosteriorIsItsNumericalOne) {
  MotionData data = made_data(14, 0.05);
  data.poses.rowwise() -= data.poses.colwise().mean().eval();
  data.velocities.rowwise() -= data.velocities.colwise().mean().eval();
  Random random(5);
  Latent latent{random.matrix(14, 2, 1.0), {{0.9, 1.3, 0.2}}, {{1.1, 0.7, 0.4, 0.3}}};
  const Posterior posterior = log_posterior(data, latent);
  for (Eigen::Index i = 0; i < 14; ++i)
    for (Eigen::Index d = 0; d < 2; ++d)
      EXPECT_NEAR(posterior.by_X(i, d), central_difference([&](double by) {
                    Latent moved = latent;
                    moved.X(i, d) += by;
                    return log_posterior(data, moved).value;
                  }),
                  1e-5)
          << i << ", " << d;
  for (Eigen::Index k = 0; k < 3; ++k)
    EXPECT_NEAR(posterior.by_alpha[k], central_difference([&](double by) {
                  Latent moved = latent;
                  moved.pose.alpha[k] += by;
                  return log_posterior(data, moved).value;
                }),
                1e-5)
        << k;
  for (Eigen::Index k = 0; k < 4; ++k)
    EXPECT_NEAR(posterior.by_beta[k], central_difference([&](double by) {
                  Latent moved = latent;
                  moved.velocity.beta[k] += by;
                  return log_posterior(data, moved).value;
                }),
                1e-5)
        << k;
}

TEST(EomMotionModel, LearningRaisesThePosterior) {
  const MotionData data = made_data(40, 0.02);
  const MotionModel once = MotionModel::learnt(data, {3, 1}, Progress());
  const MotionModel often = MotionModel::learnt(data, {3, 300}, Progress());
  EXPECT_GT(often.log_posterior(), once.log_posterior() + 10.0);
}

TEST(EomMotionModel, InterpolatesWhatItWasLearntFrom) {
  const MotionData data = made_data(40, 0.0);
  const MotionModel learnt = MotionModel::learnt(data, {3, 100}, Progress());
  Latent latent = learnt.latent();
  latent.pose.alpha[2] = 1e-6;
  latent.velocity.beta[3] = 1e-6 * latent.velocity.beta[3];
  const MotionModel model(data, latent);
  for (int t = 0; t < data.num_frames(); ++t)
    EXPECT_LT((model.pose(latent.X.row(t)) - data.poses.row(t).transpose()).norm(), 1e-2) << t;
  for (std::size_t row = 0; row < data.steps.size(); ++row) {
    const int t = data.steps[row];
    const Eigen::VectorXd velocity = data.velocities.row(static_cast<Eigen::Index>(row));
    EXPECT_LT((model.velocity(latent.X.row(t), latent.X.row(t - 1)) - velocity).norm(),
              0.1 * velocity.norm())
        << t;
  }
}

TEST(EomMotionModel, FarFromEverythingItIsTheMeanPose) {
  const MotionData data = made_data(20, 0.0);
  const MotionModel model = MotionModel::learnt(data, {2, 20}, Progress());
  const Eigen::VectorXd mean = data.poses.colwise().mean();
  EXPECT_LT((model.pose(Eigen::Vector2d(1e3, 1e3)) - mean).norm(), 1e-9);
}

TEST(EomMotionModel, LearningCanBeCancelled) {
  int reports = 0;
  const Progress progress(Progress::Callback(
      [&](std::size_t, std::size_t, std::string_view) { return ++reports < 4; }));
  EXPECT_THROW(MotionModel::learnt(made_data(30, 0.02), {3, 300}, progress), Cancelled);
  EXPECT_EQ(reports, 4);
}

}  // namespace
}  // namespace sparse_mocap::eom2014
