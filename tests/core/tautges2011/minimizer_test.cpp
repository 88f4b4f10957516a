// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <iostream>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/retrieval/pose_minimizer.hpp"
#include "support/refusals.hpp"
#include "tautges2011/ceres_minimizer.hpp"
#include "tautges2011/hdm05.hpp"
#include "tautges2011/neighbourhoods.hpp"

namespace sparse_mocap::tautges2011 {

using namespace retrieval;

namespace {

using testing::all_terms;
using testing::ceres_minimum;
using testing::Random;
using testing::retrieved_neighbourhood;
using testing::swaying_motion;
using testing::template_skeleton;

std::shared_ptr<const MotionDatabase> swaying_database() {
  std::vector<Motion> motions;
  for (unsigned seed = 0; seed < 8; ++seed)
    motions.push_back(swaying_motion(template_skeleton(), seed, 120, 50.0));
  return testing::database_of(motions);
}

// Minimises many neighbourhoods both ways from the same start and compares what is reached.
void expect_as_low_as_ceres(const MotionDatabase& database, const Config& config, int count,
                            const std::string& what) {
  Random random(1);
  double worst = 0.0, mean = 0.0, iterations = 0.0, components = 0.0;
  int lower = 0;
  for (int trial = 0; trial < count; ++trial) {
    const Neighbourhood found = retrieved_neighbourhood(database, random, 64);
    const Energy energy(database.skeleton(), found.weights, all_terms(database, found, config));
    const PoseSubspace subspace = weighted_pca(found.angles, found.weights, 0.99);
    // Every pose of the neighbourhood is a minimum of its own; the way between is open.
    const Eigen::VectorXd start = 0.5 * (found.angles.col(random.below(64)) + subspace.mean);
    const Minimum ours = minimize(energy, subspace, std::vector<PoseVector>{start}, 200);
    const double theirs = ceres_minimum(energy, subspace, start);
    EXPECT_TRUE(ours.is_converged);
    const double gap = (ours.value - theirs) / theirs;
    worst = std::max(worst, gap);
    // Where the other found a deeper valley, ours is at the bottom of one as well.
    if (gap > 1e-4) {
      EXPECT_GE(ceres_minimum(energy, subspace, ours.angles), ours.value * (1.0 - 1e-4));
    }
    mean += gap / count;
    iterations += static_cast<double>(ours.iterations) / count;
    components += static_cast<double>(subspace.basis.cols()) / count;
    lower += gap <= 1e-4 ? 1 : 0;
  }
  std::cout << what << ": of " << count << " neighbourhoods " << lower
            << " as low as Ceres; relative gap mean " << mean << ", worst " << worst << "; "
            << iterations << " iterations, " << components << " components on average\n";
  EXPECT_GE(lower, count * 95 / 100);
}

TEST(Minimize, NeedsAStart) {
  const auto database = swaying_database();
  Random random(2);
  const Neighbourhood found = retrieved_neighbourhood(*database, random, 16);
  const Energy energy(database->skeleton(), found.weights, all_terms(*database, found, Config()));
  const PoseSubspace subspace = weighted_pca(found.angles, found.weights, 0.99);
  EXPECT_REFUSED(std::invalid_argument, "at least one start",
                 minimize(energy, subspace, std::vector<PoseVector>(), 10));
}

TEST(Minimize, EndsAsLowAsCeresOnSyntheticNeighbourhoods) {
  expect_as_low_as_ceres(*swaying_database(), {}, 60, "synthetic, kernels");
  Config normal;
  normal.prior = PriorModel::mahalanobis;
  expect_as_low_as_ceres(*swaying_database(), normal, 20, "synthetic, Mahalanobis distances");
}

TEST(Minimize, EndsAsLowAsCeresOnHdm05) {
  SKIP_WITHOUT_REAL_DATA("hdm05/HDM_bd.asf");
  const auto database = testing::hdm05_database(6);
  expect_as_low_as_ceres(*database, {}, 100, "HDM05, kernels");
}

TEST(Minimize, NeverLetsTheEnergyRise) {
  const auto database = swaying_database();
  Random random(3);
  for (int trial = 0; trial < 20; ++trial) {
    const Neighbourhood found = retrieved_neighbourhood(*database, random, 32);
    const Energy energy(database->skeleton(), found.weights, all_terms(*database, found, Config()));
    const PoseSubspace subspace = weighted_pca(found.angles, found.weights, 0.99);
    const Eigen::VectorXd start = subspace.mean + random.column(43, 0.5);
    double last = energy.value(subspace.pose(subspace.coordinates(start)));
    for (int iterations = 1; iterations < 15; ++iterations) {
      const Minimum minimum =
          minimize(energy, subspace, std::vector<PoseVector>{start}, iterations);
      EXPECT_LE(minimum.value, last + 1e-12);
      EXPECT_LE(minimum.iterations, iterations);
      EXPECT_NEAR(minimum.value, energy.value(minimum.angles), 1e-9);
      EXPECT_LT((minimum.angles - subspace.pose(subspace.coordinates(minimum.angles))).norm(),
                1e-9);
      last = minimum.value;
    }
  }
}

// Far from the targets positions are anything but linear in the angles, and full steps overshoot.
TEST(Minimize, ShortensStepsThatOvershoot) {
  const Skeleton skeleton = template_skeleton();
  Random random(6);
  int at_the_bottom = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const Eigen::VectorXd wanted = random.column(43, 1.0);
    JointTransforms pose;
    forward_kinematics(skeleton, Vec3::Zero(), wanted, pose);
    const Eigen::VectorXd target = stacked_ends(pose);
    const Energy energy(skeleton, Eigen::VectorXd::Ones(1),
                        {{}, {{{}, 1.0, target, Eigen::MatrixXd::Identity(63, 63)}}});
    const PoseSubspace everything{Eigen::VectorXd::Zero(43), Eigen::MatrixXd::Identity(43, 43)};
    const Eigen::VectorXd start = wanted + random.column(43, 1.5);
    const Minimum minimum = minimize(energy, everything, std::vector<PoseVector>{start}, 500);
    Eigen::VectorXd slope;
    energy.value_and_gradient(minimum.angles, slope);
    at_the_bottom += slope.norm() < 1e-2 ? 1 : 0;
    // What says that it has converged stands where the ground is level.
    if (minimum.is_converged) {
      EXPECT_LT(slope.norm(), 0.1);
    }
  }
  EXPECT_GE(at_the_bottom, 34);
}

TEST(Minimize, DescendsFromTheBestStart) {
  const auto database = swaying_database();
  Random random(4);
  const Neighbourhood found = retrieved_neighbourhood(*database, random, 32);
  const Energy energy(database->skeleton(), found.weights, all_terms(*database, found, Config()));
  const PoseSubspace subspace = weighted_pca(found.angles, found.weights, 0.99);
  const Eigen::VectorXd far = subspace.mean + random.column(43, 3.0);
  const Eigen::VectorXd near = found.angles.col(0);
  EXPECT_LE(minimize(energy, subspace, std::vector<PoseVector>{far, near}, 1).value,
            energy.value(subspace.pose(subspace.coordinates(near))));
  EXPECT_EQ(minimize(energy, subspace, std::vector<PoseVector>{near, far}, 5).value,
            minimize(energy, subspace, std::vector<PoseVector>{far, near}, 5).value);
}

TEST(Minimize, FindsTheMeanOfANormalDistribution) {
  Random random(5);
  const Eigen::MatrixXd targets = random.matrix(43, 20, 1.0);
  const Eigen::VectorXd weights = Eigen::VectorXd::Constant(20, 0.05);
  const Skeleton skeleton = template_skeleton();
  const KernelTerm kernel{{TermSpace::Compared::angles, {}}, 1.0, targets};
  const Energy energy(skeleton, weights, {{}, {normal_term(kernel, weights)}});
  const PoseSubspace subspace = weighted_pca(targets, weights, 0.9);
  const Minimum minimum = minimize(energy, subspace, std::vector<PoseVector>{targets.col(3)}, 20);
  EXPECT_LT((minimum.angles - targets.rowwise().mean()).norm(), 1e-6);
  EXPECT_TRUE(minimum.is_converged);
}

}  // namespace
}  // namespace sparse_mocap::tautges2011
