// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/database_rows.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sparse_mocap/motion/extremities.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::resting_motion;
using testing::swaying_motion;
using testing::template_skeleton;

TEST(DatabaseRows, AnglesWithoutHeadingGiveThePositions) {
  const Motion motion = swaying_motion(template_skeleton(), 1, 240, 120.0);
  const DatabaseRows rows = database_rows(motion, 25.0);
  ASSERT_EQ(rows.num_frames(), 50);
  JointTransforms pose;
  // Smoothing leaves the few axes that some joints have, by a tenth of a millimetre here.
  for (int t = 0; t < rows.num_frames(); ++t) {
    forward_kinematics(motion.skeleton, Vec3::Zero(),
                       Eigen::VectorXd(rows.angles.row(t).transpose().cast<double>()), pose);
    EXPECT_NEAR(heading_of(pose, 0.0), 0.0, 1e-5);
    for (Eigen::Index j = 0; j < kNumStandardJoints; ++j)
      EXPECT_LT((pose.end[static_cast<std::size_t>(j)] -
                 rows.positions.row(t).segment<3>(3 * j).transpose().cast<double>())
                    .norm(),
                5e-4);
  }
}

TEST(DatabaseRows, LieWhereTheMotionIsAtTheirTime) {
  const Motion motion = swaying_motion(template_skeleton(), 2, 240, 120.0);
  const DatabaseRows rows = database_rows(motion, 25.0);
  const auto positions = joint_positions(motion, PositionFrame::heading);
  for (int t = 2; t < 48; ++t) {
    const auto frame = static_cast<Eigen::Index>(std::lround(t * 4.8));
    if (std::abs(t * 4.8 - static_cast<double>(frame)) > 0.01) continue;
    EXPECT_LT((rows.positions.row(t).transpose().cast<double>() - positions.col(frame))
                  .cwiseAbs()
                  .maxCoeff(),
              0.01);
  }
}

// Walking forward at 1.2 m/s and to the left at 0.3 m/s while turning at 0.5 rad/s.
TEST(DatabaseRows, RootMotionIsTheRateInTheHeadingFrame) {
  using namespace root_motion_column;
  Motion motion = resting_motion(template_skeleton(), 400, 100.0, 0.8);
  Vec3 position(0, 0.8, 0);
  for (int t = 0; t < 400; ++t) {
    const double yaw = 0.5 * t / 100.0;
    motion.rotation(t, 0) = Quat(yaw_rotation(yaw));
    motion.root_positions[static_cast<std::size_t>(t)] = position;
    position += yaw_rotation(yaw + 0.0025) * Vec3(0.3, 0, 1.2) / 100.0;
  }
  const DatabaseRows rows = database_rows(motion, 25.0);
  for (int t = 4; t < rows.num_frames() - 4; ++t) {
    EXPECT_NEAR(rows.root_motion(t, velocity_left), 0.3, 0.02);
    EXPECT_NEAR(rows.root_motion(t, velocity_forward), 1.2, 0.02);
    EXPECT_NEAR(rows.root_motion(t, yaw_rate), 0.5, 1e-3);
  }
}

// Recordings have the floor at zero and a standing ankle some 10 cm above it; where the ankles
// never come near zero, the lowest one is taken for 8 cm above the floor.
TEST(DatabaseRows, HeightIsAboveTheFloor) {
  const double leg = -testing::resting_motion(template_skeleton(), 1, 25.0, 0.0)
                          .transforms(0)
                          .end[standard_joint::ltibia]
                          .y();
  const auto height_of = [&](double ankle) {
    const Motion motion = resting_motion(template_skeleton(), 10, 25.0, leg + ankle);
    return double{database_rows(motion, 25.0).root_motion(5, root_motion_column::height)};
  };
  EXPECT_NEAR(height_of(0.05), leg + 0.05, 1e-5);
  EXPECT_NEAR(height_of(0.2), leg + 0.2, 1e-5);
  EXPECT_NEAR(height_of(0.5), leg + 0.08, 1e-5);
  EXPECT_NEAR(height_of(-1.0), leg + 0.08, 1e-5);
}

TEST(DatabaseRows, ReadingsAtRestAreGravityForEverySite) {
  const DatabaseRows rows = database_rows(resting_motion(template_skeleton(), 100, 120.0), 25.0);
  for (std::size_t s = 0; s < all_sites().size(); ++s) {
    const Vec3 expected = 9.81 * (all_sites()[s].R_joint_sensor.transpose() * kUp);
    const auto at = static_cast<Eigen::Index>(3 * s);
    for (int t = 0; t < rows.num_frames(); ++t) {
      for (const auto* force : {&rows.specific_force_pivot, &rows.specific_force_end})
        EXPECT_LT((force->row(t).segment<3>(at).transpose().cast<double>() - expected).norm(),
                  1e-4);
      EXPECT_LT((9.81F * rows.gravity_direction.row(t).segment<3>(at).transpose().cast<double>() -
                 expected)
                    .norm(),
                1e-4);
    }
  }
  EXPECT_EQ(rows.angular_velocity.cwiseAbs().maxCoeff(), 0.0F);
}

TEST(DatabaseRows, HoldFeetToesAndHandsWhereTheMotionHasThem) {
  const Skeleton full = with_extremities(template_skeleton());
  const Motion motion = swaying_motion(full, 6, 100, 25.0);
  const DatabaseRows rows = database_rows(motion, 25.0);
  ASSERT_EQ(rows.extremities.cols(), 18);
  EXPECT_EQ(rows.positions.cols(), 63);
  for (int t = 0; t < rows.num_frames(); ++t)
    for (int e = 0; e < kNumExtremities; ++e) {
      const Vec3 v = rows.extremities.row(t).segment<3>(3 * e).transpose().cast<double>();
      const Eigen::AngleAxisd turn(v.norm(), v.normalized());
      EXPECT_LT(Quat(turn).angularDistance(motion.rotation(t, 21 + e)), 1e-5);
    }
  const DatabaseRows without =
      database_rows(swaying_motion(template_skeleton(), 6, 100, 25.0), 25.0);
  EXPECT_EQ(without.extremities, DatabaseRows::Rows::Zero(without.num_frames(), 18));
}

TEST(DatabaseRows, KeepTheDirectionUpOfUnitLength) {
  const DatabaseRows rows = database_rows(swaying_motion(template_skeleton(), 3, 200, 120.0), 25.0);
  for (std::size_t s = 0; s < all_sites().size(); ++s)
    for (int t = 0; t < rows.num_frames(); ++t)
      EXPECT_NEAR(rows.gravity_direction.row(t).segment<3>(static_cast<Eigen::Index>(3 * s)).norm(),
                  1.0F, 1e-5F);
}

}  // namespace
}  // namespace sparse_mocap
