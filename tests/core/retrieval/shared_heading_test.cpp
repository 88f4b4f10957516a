// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/shared_heading.hpp"

#include <gtest/gtest.h>

#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/sensors/common_yaw.hpp"
#include "sparse_mocap/sensors/sites.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::retrieval {
namespace {

using testing::Random;

const std::vector<int>& worn() {
  static const std::vector<int> sites{find_site("left_wrist"), find_site("right_ankle"),
                                      find_site("pelvis")};
  return sites;
}

Mat3 random_rotation(Random& random, double size_rad) {
  const Vec3 turn = random.vector(size_rad);
  return Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
}

Reading reading_of(const std::vector<Mat3>& rotations) {
  Reading reading(static_cast<Eigen::Index>(rotations.size()));
  for (std::size_t s = 0; s < rotations.size(); ++s) {
    const Quat q(rotations[s]);
    reading.orientation.col(static_cast<Eigen::Index>(s)) << q.w(), q.x(), q.y(), q.z();
  }
  return reading;
}

const std::vector<Eigen::Index> kColumns{0, 1, 2};

TEST(SharedHeading, IsTheSameWhereverThePerformerFaces) {
  Random random(1);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Mat3> rotations, turned;
    const Mat3 about_up = yaw_rotation(random.vector(3.0).x());
    for (const int site : worn()) {
      rotations.push_back(random_rotation(random, 0.4) *
                          all_sites()[static_cast<std::size_t>(site)].R_joint_sensor);
      turned.push_back(about_up * rotations.back());
    }
    const auto row = axes_row(reading_of(rotations), kColumns, worn());
    EXPECT_LT((axes_row(reading_of(turned), kColumns, worn()) - row).cwiseAbs().maxCoeff(), 1e-5F);
    for (Eigen::Index s = 0; s < 3; ++s) {
      const Mat3 R = rotation_of_axes(row.segment<kAxesColumns>(kAxesColumns * s));
      const Vec3 up = R.transpose() * kUp;
      EXPECT_LT((up - rotations[static_cast<std::size_t>(s)].transpose() * kUp).norm(), 1e-5);
    }
  }
}

TEST(SharedHeading, DoesWithoutASilentSensor) {
  Random random(2);
  std::vector<Mat3> rotations(3, random_rotation(random, 0.3));
  Reading reading = reading_of(rotations);
  reading.orientation.col(1).setConstant(std::numeric_limits<double>::quiet_NaN());
  const auto row = axes_row(reading, kColumns, worn());
  EXPECT_TRUE(row.head<6>().allFinite());
  EXPECT_TRUE(row.tail<6>().allFinite());
  EXPECT_TRUE(row.segment<6>(6).array().isNaN().all());
}

// The best of many turns, by their sum of squared differences.
TEST(CommonYaw, IsTheBestTurn) {
  Random random(3);
  std::vector<Mat3> measured, modelled;
  for (int s = 0; s < 4; ++s) {
    modelled.push_back(random_rotation(random, 1.0));
    measured.push_back(random_rotation(random, 0.3) * yaw_rotation(0.8) * modelled.back());
  }
  const auto misfit = [&](double yaw_rad) {
    double sum = 0.0;
    for (std::size_t s = 0; s < measured.size(); ++s)
      sum += (yaw_rotation(yaw_rad) * modelled[s] - measured[s]).squaredNorm();
    return sum;
  };
  const double found = misfit(common_yaw_rad(measured, modelled));
  for (int k = 0; k < 720; ++k) EXPECT_LE(found, misfit(2.0 * kPi * k / 720.0) + 1e-9);
}

TEST(DatabaseAxes, AreThoseThatRealSensorsTold) {
  auto content = testing::content_of(
      {testing::swaying_motion(testing::template_skeleton(), 1, 20, 25.0)}, 25.0);
  Random random(3);
  ClipTake take{"take.csv", "hash", 0.0, 0.9, 1.0, {}};
  std::vector<DatabaseRows::Rows> told;
  for (const int site : worn()) {
    DatabaseRows::Rows& rows = told.emplace_back(20, 4);
    for (int n = 0; n < 20; ++n) {
      const Quat q(random_rotation(random, 1.0));
      rows.row(n) << static_cast<float>(q.w()), static_cast<float>(q.x()),
          static_cast<float>(q.y()), static_cast<float>(q.z());
    }
    content.clip_rows[0].sites[static_cast<std::size_t>(site)].orientation = packed(rows);
    take.channels[std::string(all_sites()[static_cast<std::size_t>(site)].name)] =
        Channel::orientation;
  }
  content.clips[0].take = take;
  const auto database = testing::database_of(content);
  const FeatureRows axes = database_axes(*database, worn());
  const std::vector<Eigen::Index> sensors{0, 1, 2};
  for (int n = 0; n < 20; ++n) {
    Reading reading(3);
    for (std::size_t s = 0; s < told.size(); ++s)
      reading.orientation.col(static_cast<Eigen::Index>(s)) =
          told[s].row(n).transpose().cast<double>();
    EXPECT_LT((axes.row(n) - axes_row(reading, sensors, worn())).norm(), 1e-3F);
  }
}

}  // namespace
}  // namespace sparse_mocap::retrieval
