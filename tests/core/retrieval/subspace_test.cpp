// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/subspace.hpp"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>

#include "support/synthetic.hpp"

namespace sparse_mocap::retrieval {
namespace {

using testing::Random;

struct Data {
  Eigen::MatrixXd poses;
  Eigen::VectorXd weights;

  Eigen::MatrixXd rooted() const {  // its singular values squared are the variances
    const Eigen::VectorXd mean = poses * weights;
    return (poses.colwise() - mean) * weights.cwiseSqrt().asDiagonal();
  }
};

// Poses whose variance falls from direction to direction.
Data random_data(Random& random, Eigen::Index dimensions, Eigen::Index count) {
  Data data{random.matrix(dimensions, count, 1.0), random.column(count, 1.0).array().abs() + 0.01};
  for (Eigen::Index d = 0; d < dimensions; ++d)
    data.poses.row(d) *= std::pow(0.8, static_cast<double>(d));
  data.poses = (random.matrix(dimensions, dimensions, 1.0) * data.poses).eval();
  data.weights /= data.weights.sum();
  return data;
}

TEST(WeightedPca, SpansTheLeadingSingularVectorsOfTheWeightedData) {
  Random random(1);
  for (const Eigen::Index count : {20, 60, 200}) {
    const Data data = random_data(random, 43, count);
    const PoseSubspace subspace = weighted_pca(data.poses, data.weights, 0.95);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(data.rooted(), Eigen::ComputeThinU);
    const auto k = subspace.basis.cols();
    EXPECT_LT((subspace.mean - data.poses * data.weights).norm(), 1e-12);
    EXPECT_LT(
        (subspace.basis.transpose() * subspace.basis - Eigen::MatrixXd::Identity(k, k)).norm(),
        1e-9);
    for (Eigen::Index c = 0; c < k; ++c)  // up to sign, one by one
      EXPECT_NEAR(std::abs(subspace.basis.col(c).dot(svd.matrixU().col(c))), 1.0, 1e-6);
  }
}

TEST(WeightedPca, KeepsJustAsManyComponentsAsTheVarianceAsksFor) {
  Random random(2);
  const Data data = random_data(random, 43, 80);
  const Eigen::VectorXd variances =
      Eigen::JacobiSVD<Eigen::MatrixXd>(data.rooted()).singularValues().cwiseAbs2();
  for (const double variance : {0.01, 0.5, 0.9, 0.99, 0.999}) {
    const auto k = weighted_pca(data.poses, data.weights, variance).basis.cols();
    EXPECT_GE(variances.head(k).sum(), variance * variances.sum() * (1.0 - 1e-12));
    EXPECT_LT(k == 1 ? 0.0 : variances.head(k - 1).sum(), variance * variances.sum());
  }
}

TEST(WeightedPca, GivesPosesInItsSpanBack) {
  Random random(3);
  const Data data = random_data(random, 12, 40);
  const PoseSubspace all = weighted_pca(data.poses, data.weights, 1.0);
  for (Eigen::Index i = 0; i < 40; ++i)
    EXPECT_LT((all.pose(all.coordinates(data.poses.col(i))) - data.poses.col(i)).norm(), 1e-6);
}

TEST(WeightedPca, NeedsOneComponentEvenWhenAllPosesAreAlike) {
  const Eigen::MatrixXd poses = Eigen::MatrixXd::Constant(43, 5, 0.3);
  const PoseSubspace subspace = weighted_pca(poses, Eigen::VectorXd::Constant(5, 0.2), 0.99);
  EXPECT_GE(subspace.basis.cols(), 1);
  EXPECT_LT((subspace.mean - poses.col(0)).norm(), 1e-12);
  const PoseSubspace single = weighted_pca(poses.leftCols(1), Eigen::VectorXd::Ones(1), 0.99);
  EXPECT_TRUE(single.basis.allFinite());
}

TEST(WeightedPca, IgnoresPosesWithoutWeight) {
  Random random(4);
  Data data = random_data(random, 10, 30);
  data.weights[7] = 0.0;
  data.weights /= data.weights.sum();
  const auto before = weighted_pca(data.poses, data.weights, 0.9);
  data.poses.col(7).setConstant(100.0);
  const auto after = weighted_pca(data.poses, data.weights, 0.9);
  EXPECT_LT((before.mean - after.mean).norm(), 1e-12);
  EXPECT_EQ(before.basis.cols(), after.basis.cols());
}

}  // namespace
}  // namespace sparse_mocap::retrieval
