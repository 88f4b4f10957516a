// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/energy_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "tautges2011/neighbourhoods.hpp"

namespace sparse_mocap::tautges2011 {
namespace {

using testing::Random;

KernelTerm cluster(Random& random, Eigen::Index dimensions, Eigen::Index count) {
  const Eigen::MatrixXd mix = random.matrix(dimensions, dimensions, 1.0);
  return {{TermSpace::Compared::angles, {}}, 3.0, mix * random.matrix(dimensions, count, 1.0)};
}

// By the textbook: d^T C^-1 d over the number of dimensions.
TEST(NormalTerm, IsTheMahalanobisDistance) {
  Random random(1);
  const KernelTerm kernel = cluster(random, 5, 40);
  Eigen::VectorXd weights = random.column(40, 1.0).array().abs() + 0.01;
  weights /= weights.sum();
  const NormalTerm term = normal_term(kernel, weights);
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(5);
  for (Eigen::Index i = 0; i < 40; ++i) mean += weights[i] * kernel.targets.col(i);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(5, 5);
  for (Eigen::Index i = 0; i < 40; ++i)
    covariance +=
        weights[i] * (kernel.targets.col(i) - mean) * (kernel.targets.col(i) - mean).transpose();
  EXPECT_EQ(term.weight, 3.0);
  EXPECT_LT((term.mean - mean).norm(), 1e-12);
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::VectorXd apart = random.column(5, 2.0);
    const double expected = apart.dot(covariance.ldlt().solve(apart)) / 5.0;
    EXPECT_NEAR((term.whitening * apart).squaredNorm(), expected, 1e-9 * expected);
  }
}

// Fewer targets than dimensions, or all alike: no direction may become infinitely stiff.
TEST(NormalTerm, HasAFloorWhereTargetsDoNotDiffer) {
  Random random(2);
  const KernelTerm alike{{}, 1.0, random.column(63, 1.0).replicate(1, 4)};
  const NormalTerm term = normal_term(alike, Eigen::Vector4d::Constant(0.25));
  ASSERT_TRUE(term.whitening.allFinite());
  const Eigen::VectorXd apart = random.column(63, 0.1);
  const double expected = apart.squaredNorm() / (63.0 * Energy::kSoftening * Energy::kSoftening);
  EXPECT_NEAR((term.whitening * apart).squaredNorm(), expected, 1e-6 * expected);
}

class Models : public ::testing::Test {
 protected:
  EnergyTerms terms(PriorModel prior, const std::optional<Past>& past) const {
    Config config;
    config.prior = prior;
    EnergyTerms terms;
    make_energy_model(config)->put_terms({neighbours_, derivatives_, past, signals_, 0.04}, terms);
    return terms;
  }

  Random random_{3};
  const retrieval::Neighbourhood neighbours_ = testing::random_neighbourhood(random_, 24);
  const PathDerivatives derivatives_ = testing::random_derivatives(random_, 24);
  const std::vector<retrieval::Signal> signals_ = testing::paper_signals();
  const std::optional<Past> past_ = Past{random_.column(43, 1.0), random_.column(63, 1.0),
                                         random_.column(63, 1.0), random_.matrix(3, 4, 9.0)};
};

TEST_F(Models, KnowOnlyThePosePriorInTheFirstFrame) {
  for (const auto prior : {PriorModel::kernel, PriorModel::mahalanobis, PriorModel::normal}) {
    const EnergyTerms first = terms(prior, {});
    EXPECT_EQ(first.kernels.size() + first.normals.size(), 1U);
  }
}

TEST_F(Models, AreMadeOfKernelsOrOfNormalDistributions) {
  const EnergyTerms kernel = terms(PriorModel::kernel, past_);
  EXPECT_EQ(kernel.kernels.size(), 4U);
  EXPECT_TRUE(kernel.normals.empty());
  const EnergyTerms mahalanobis = terms(PriorModel::mahalanobis, past_);
  EXPECT_TRUE(mahalanobis.kernels.empty());
  ASSERT_EQ(mahalanobis.normals.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(mahalanobis.normals[k].weight, kernel.kernels[k].weight);
    EXPECT_LT(
        (mahalanobis.normals[k].mean - kernel.kernels[k].targets * neighbours_.weights).norm(),
        1e-9);
  }
  const EnergyTerms normal = terms(PriorModel::normal, past_);
  EXPECT_TRUE(normal.kernels.empty());
  EXPECT_EQ(normal.normals.size(), 3U);
}

// The ad-hoc smoothness: least where the joints go on as they went.
TEST_F(Models, OfChaiAndHodginsAskForJointsThatGoOnAsTheyWent) {
  const NormalTerm smoothness = terms(PriorModel::normal, past_).normals.back();
  EXPECT_LT((smoothness.mean - (2.0 * past_->positions - past_->positions_before)).norm(), 1e-12);
  EXPECT_NEAR(smoothness.whitening(0, 0), smoothness.whitening(62, 62), 1e-12);
  EXPECT_EQ(smoothness.whitening(0, 62), 0.0);
}

}  // namespace
}  // namespace sparse_mocap::tautges2011
