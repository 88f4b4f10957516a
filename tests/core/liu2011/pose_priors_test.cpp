// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/pose_priors.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "liu2011/bodies.hpp"
#include "sparse_mocap/liu2011/local_dynamic_model.hpp"

namespace sparse_mocap::liu2011 {
namespace {

using testing::distance_m;
using testing::swaying_motion;
using testing::template_skeleton;

class Priors : public ::testing::Test {
 protected:
  static std::vector<Motion> motions() {
    std::vector<Motion> made;
    for (unsigned seed = 0; seed < 4; ++seed)
      made.push_back(swaying_motion(template_skeleton(), seed, 100, 25.0));
    return made;
  }
  std::vector<BodyPose> recent(int frame) const {
    std::vector<BodyPose> poses;
    for (const auto& place : examples_.history(frame, 3))
      poses.push_back(place.heading.to_parent(examples_.pose(place.frame)));
    return poses;
  }
  // The pose of least prior energy.
  BodyPose mean_of(const PosePrior& prior) const {
    return map_estimate(examples_.body(), {}, weights_, prior, prior.reference, 100).pose;
  }

  const MotionExamples examples_{testing::database_of(motions()), template_skeleton()};
  const ControlWeights weights_;
  // Frames around one of them.
  const std::vector<retrieval::Neighbour> nearest_ = [] {
    std::vector<retrieval::Neighbour> found;
    for (int away = 0; away < 12; ++away)
      found.push_back({0.1F * static_cast<float>(away), 150 + (away % 2 == 0 ? 1 : -1) * away});
    return found;
  }();
  const LocalExamples local_ = local_examples(examples_, nearest_, 3);
};

TEST_F(Priors, LearnFromTheExamplesAboutTheirMean) {
  ASSERT_EQ(local_.x.rows(), 3 * 46);
  ASSERT_EQ(local_.y.cols(), 12);
  const Eigen::VectorXd mean = local_.y * local_.weights / local_.weights.sum();
  EXPECT_LT(mean.norm(), 0.02);
  EXPECT_LT((local_.y.col(0) - pose_vector(examples_.body(), local_.reference, examples_.next(150)))
                .norm(),
            1e-5);
  EXPECT_LT(
      (local_.x.col(0) - pose_vectors(examples_.body(), local_.reference, recent(150))).norm(),
      1e-5);
}

TEST_F(Priors, DynamicOnePredictsWhereTheMovementGoes) {
  Config config;
  config.joint_residuals = false;
  config.history_trust = 1.0;
  config.pca_variance = 0.99;
  const PosePrior prior = dynamic_prior(examples_.body(), local_, recent(150), config);
  EXPECT_LT(distance_m(examples_.body(), mean_of(prior), examples_.next(150)), 0.04);
  // Deviations never fall below the floor.
  const Eigen::VectorXd deviations = prior.whitening.diagonal().cwiseInverse();
  EXPECT_GE(deviations.tail(43).minCoeff(), 3.0 * kRadiansPerDegree - 1e-12);
  EXPECT_GE(deviations.head(3).minCoeff(), 0.01 - 1e-12);
}

TEST_F(Priors, DynamicOneKnowsHowErrorsOfAPredictionGoTogether) {
  Config config;
  config.history_trust = 1.0;
  const PosePrior prior = dynamic_prior(examples_.body(), local_, recent(150), config);
  const auto model = local_dynamic_model(local_.x, local_.y, local_.weights, config.pca_variance);
  // The weighted covariance of what the model leaves, example by example, and the floors.
  Eigen::MatrixXd wanted = Eigen::MatrixXd::Zero(46, 46);
  for (Eigen::Index k = 0; k < local_.y.cols(); ++k) {
    const Eigen::VectorXd left = local_.y.col(k) - model.predicted(local_.x.col(k));
    wanted += local_.weights[k] / local_.weights.sum() * left * left.transpose();
  }
  wanted.diagonal().head(3).array() += 0.01 * 0.01;
  wanted.diagonal().tail(43).array() += std::pow(3.0 * kRadiansPerDegree, 2);
  const Eigen::MatrixXd found = (prior.whitening.transpose() * prior.whitening).inverse();
  EXPECT_LT((found - wanted).norm(), 1e-6 * wanted.norm());
  const Eigen::VectorXd mean = prior.whitening.partialPivLu().solve(prior.target);
  EXPECT_LT((mean - model.predicted(pose_vectors(examples_.body(), local_.reference, recent(150))))
                .norm(),
            1e-9);
}

TEST_F(Priors, LocalPcaKeepsToTheExamplesSubspace) {
  const PosePrior prior = local_pca_prior(examples_.body(), local_, recent(150), {});
  // Along the examples a step costs little, across them much.
  const Eigen::VectorXd along = (local_.y.col(2) - local_.y.col(0)).normalized();
  Eigen::VectorXd across = Eigen::VectorXd::LinSpaced(46, -1.0, 1.0);
  for (int pass = 0; pass < 3; ++pass)
    for (Eigen::Index k = 0; k < 12; ++k) {
      const Eigen::VectorXd direction = local_.y.col(k).normalized();
      across -= direction * direction.dot(across);
    }
  across.normalize();
  const auto rows = prior.whitening.topRows(46);
  EXPECT_GT((rows * across).norm(), 5.0 * (rows * along).norm());
  EXPECT_LT(distance_m(examples_.body(), mean_of(prior), examples_.next(150)), 0.05);
}

TEST_F(Priors, InverseKinematicsStaysAtThePoseBefore) {
  const auto before = recent(150);
  const PosePrior prior = previous_pose_prior(examples_.body(), before, {});
  EXPECT_LT(distance_m(examples_.body(), mean_of(prior), before.front()), 1e-9);
}

TEST_F(Priors, AreChosenByTheOption) {
  Config config;
  const auto before = recent(150);
  const auto chosen = [&](PriorModel model) {
    config.prior = model;
    return pose_prior(examples_.body(), local_, before, config);
  };
  EXPECT_EQ(chosen(PriorModel::dynamic).whitening.rows(), 46);
  EXPECT_EQ(chosen(PriorModel::local_pca).whitening.rows(), 92);
  EXPECT_EQ(chosen(PriorModel::inverse_kinematics).target.norm(), 0.0);
}

}  // namespace
}  // namespace sparse_mocap::liu2011
