// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/energy.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>

#include "tautges2011/neighbourhoods.hpp"

namespace sparse_mocap::tautges2011 {
namespace {

using namespace standard_joint;
using testing::Random;
using testing::template_skeleton;

const Skeleton kSkeleton = template_skeleton();  // energies refer to it

Eigen::VectorXd random_weights(Random& random, Eigen::Index count) {
  Eigen::VectorXd weights = random.column(count, 1.0).array().abs() + 0.01;
  return weights / weights.sum();
}

using Compared = TermSpace::Compared;

const TermSpace kAngles{Compared::angles, {}};
const TermSpace kTwoJoints{Compared::positions, {rwrist, lfemur}};

// Terms of each space, one of them without weight.
std::vector<KernelTerm> mixed_kernels(Random& random, Eigen::Index paths) {
  return {{kAngles, 3.0, random.matrix(43, paths, 1.0)},
          {{}, 1.0, random.matrix(63, paths, 0.8)},
          {{}, 0.5, random.matrix(63, paths, 0.8)},
          {kTwoJoints, 2.0, random.matrix(6, paths, 0.8)},
          {kAngles, 0.0, random.matrix(43, paths, 1.0)}};
}

std::vector<NormalTerm> mixed_normals(Random& random) {
  return {{kAngles, 1.5, random.column(43, 1.0), random.matrix(20, 43, 0.5)},
          {{}, 0.5, random.column(63, 0.8), random.matrix(63, 63, 0.5)},
          {kTwoJoints, 2.0, random.column(6, 0.8), random.matrix(6, 6, 1.0)},
          {kAngles, 0.0, random.column(43, 1.0), random.matrix(43, 43, 1.0)}};
}

EnergyTerms mixed_terms(Random& random, Eigen::Index paths) {
  return {mixed_kernels(random, paths), mixed_normals(random)};
}

TEST(Energy, IsTheSumOfItsSoftenedKernelsAndSquaredDistances) {
  Random random(1);
  const auto weights = random_weights(random, 7);
  const EnergyTerms terms = mixed_terms(random, 7);
  const Eigen::VectorXd q = random.column(43, 1.0);
  JointTransforms pose;
  forward_kinematics(kSkeleton, Vec3::Zero(), q, pose);
  Eigen::VectorXd x(63), x_two(6);
  for (Eigen::Index j = 0; j < 21; ++j) x.segment<3>(3 * j) = pose.end[static_cast<std::size_t>(j)];
  x_two << pose.end[rwrist], pose.end[lfemur];
  const auto in_space = [&](const TermSpace& space) -> const Eigen::VectorXd& {
    if (space.compared == Compared::angles) return q;
    return space.joints.empty() ? x : x_two;
  };
  double expected = 0.0;
  for (const auto& term : terms.kernels)
    for (Eigen::Index i = 0; i < 7; ++i)
      expected += term.weight * weights[i] *
                  std::pow((term.targets.col(i) - in_space(term.space)).squaredNorm() + 1e-6, 0.25);
  for (const auto& term : terms.normals) {
    const Eigen::VectorXd apart = in_space(term.space) - term.mean;
    expected += term.weight * apart.dot(term.whitening.transpose() * term.whitening * apart);
  }
  EXPECT_NEAR(Energy(kSkeleton, weights, terms).value(q), expected, 1e-9 * expected);
}

TEST(Energy, GradientEqualsCentralDifferences) {
  Random random(2);
  const Energy energy(kSkeleton, random_weights(random, 9), mixed_terms(random, 9));
  const Eigen::VectorXd q = random.column(43, 1.0);
  Eigen::VectorXd gradient;
  EXPECT_NEAR(energy.value_and_gradient(q, gradient), energy.value(q), 1e-12);
  for (Eigen::Index a = 0; a < 43; ++a) {
    Eigen::VectorXd more = q, less = q;
    more[a] += 1e-5;
    less[a] -= 1e-5;
    EXPECT_NEAR(gradient[a], (energy.value(more) - energy.value(less)) / 2e-5, 1e-7);
  }
}

// At a target the square root has infinite slope; softened, it is flat there.
TEST(Energy, IsSmoothWhereAPoseMeetsATarget) {
  Random random(3);
  const Eigen::MatrixXd target = random.matrix(43, 1, 1.0);
  const Energy energy(kSkeleton, Eigen::VectorXd::Ones(1), {{{kAngles, 1.0, target}}, {}});
  Eigen::VectorXd gradient;
  EXPECT_NEAR(energy.value_and_gradient(target, gradient), std::sqrt(Energy::kSoftening), 1e-12);
  EXPECT_LT(gradient.norm(), 1e-12);
}

TEST(Energy, OfNoTermsIsNothing) {
  const Energy energy(kSkeleton, Eigen::VectorXd::Ones(1), {});
  Eigen::VectorXd gradient;
  EXPECT_EQ(energy.value_and_gradient(Eigen::VectorXd::Zero(43), gradient), 0.0);
  EXPECT_EQ(gradient, Eigen::VectorXd::Zero(43));
}

Eigen::MatrixXd random_basis(Random& random, Eigen::Index columns) {
  return Eigen::HouseholderQR<Eigen::MatrixXd>(random.matrix(43, columns, 1.0)).householderQ() *
         Eigen::MatrixXd::Identity(43, columns);
}

TEST(Majoriser, TouchesTheEnergyAndItsSlopeInTheBasis) {
  Random random(4);
  const Energy energy(kSkeleton, random_weights(random, 9), mixed_terms(random, 9));
  const Eigen::VectorXd q = random.column(43, 1.0);
  const Eigen::MatrixXd basis = random_basis(random, 12);
  const auto model = energy.majorised(q, basis);
  Eigen::VectorXd gradient;
  EXPECT_NEAR(model.value, energy.value_and_gradient(q, gradient), 1e-12);
  EXPECT_LT((model.gradient - basis.transpose() * gradient).norm(), 1e-9);
  EXPECT_LT((model.hessian - model.hessian.transpose()).norm(), 1e-9);
}

TEST(Majoriser, LiesAboveTheEnergyOfAngles) {
  Random random(5);
  const Energy energy(kSkeleton, random_weights(random, 9),
                      {{mixed_kernels(random, 9).front()}, {}});
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::VectorXd q = random.column(43, 1.0);
    const Eigen::MatrixXd basis = random_basis(random, 10);
    const auto model = energy.majorised(q, basis);
    const Eigen::VectorXd d = random.column(10, std::pow(10.0, random.in(-3.0, 1.0)));
    const double above = model.value + model.gradient.dot(d) + 0.5 * d.dot(model.hessian * d);
    EXPECT_GE(above, energy.value(q + basis * d) - 1e-9);
  }
}

// The same of positions, had they followed the angles in a straight line.
TEST(Majoriser, LiesAboveTheEnergyOfLinearisedPositions) {
  Random random(6);
  const auto weights = random_weights(random, 9);
  const KernelTerm term = mixed_kernels(random, 9)[3];
  const Energy energy(kSkeleton, weights, {{term}, {}});
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::VectorXd q = random.column(43, 1.0);
    JointTransforms pose;
    forward_kinematics(kSkeleton, Vec3::Zero(), q, pose);
    const Eigen::MatrixXd all_rows = position_jacobian(kSkeleton, q, pose);
    Eigen::MatrixXd jacobian(6, 43);
    jacobian << all_rows.middleRows(3 * rwrist, 3), all_rows.middleRows(3 * lfemur, 3);
    Eigen::VectorXd y(6);
    y << pose.end[rwrist], pose.end[lfemur];
    const auto model = energy.majorised(q, Eigen::MatrixXd::Identity(43, 43));
    const Eigen::VectorXd d = random.column(43, std::pow(10.0, random.in(-3.0, 0.5)));
    y += jacobian * d;
    double linearised = 0.0;
    for (Eigen::Index i = 0; i < 9; ++i)
      linearised +=
          2.0 * weights[i] * std::pow((term.targets.col(i) - y).squaredNorm() + 1e-6, 0.25);
    const double above = model.value + model.gradient.dot(d) + 0.5 * d.dot(model.hessian * d);
    EXPECT_GE(above, linearised - 1e-5);
  }
}

TEST(Majoriser, IsTheEnergyItselfForSquaredDistancesOfAngles) {
  Random random(7);
  const Energy energy(kSkeleton, random_weights(random, 9), {{}, {mixed_normals(random).front()}});
  const Eigen::VectorXd q = random.column(43, 1.0), d = random.column(43, 2.0);
  const auto model = energy.majorised(q, Eigen::MatrixXd::Identity(43, 43));
  const double expected = energy.value(q + d);
  EXPECT_NEAR(model.value + model.gradient.dot(d) + 0.5 * d.dot(model.hessian * d), expected,
              1e-9 * expected);
}

}  // namespace
}  // namespace sparse_mocap::tautges2011
