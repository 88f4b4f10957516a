// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/recent_points.hpp"

#include <gtest/gtest.h>

#include <set>

#include "sparse_mocap/path_regression/frame_target.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::path_regression {
namespace {

using testing::Random;
using testing::swaying_motion;
using testing::template_skeleton;

Eigen::VectorXd computed_points(const MotionDatabase& database, int frame, double lever_m) {
  JointTransforms pose;
  forward_kinematics(database.skeleton(), Vec3::Zero(),
                     database.angles().row(frame).transpose().cast<double>(), pose);
  return pose_points(pose, lever_m);
}

// Frames that go on from reading to reading, as those of paths do, and a few new ones.
TEST(RecentPoints, AreThoseOfTheFrameWhoeverAskedBefore) {
  constexpr int kFrames = 60;
  const std::vector databases{
      testing::database_of({swaying_motion(template_skeleton(), 1, kFrames, 25.0)}, 25.0),
      testing::database_of({swaying_motion(template_skeleton(), 2, kFrames, 25.0)}, 25.0)};
  Random random(1);
  RecentPoints recent;
  for (int reading = 0; reading < 50; ++reading) {
    const std::size_t user = reading % 5 == 3 ? 1 : 0;
    const double lever_m = user == 0 ? 0.2 : 0.1;
    std::set<int> frames;
    for (int i = 0; i < 8; ++i) frames.insert((10 * i + reading) % kFrames);
    for (int i = 0; i < 4; ++i) frames.insert(random.below(kFrames));
    recent.begin(user, *databases[user], lever_m, 12);
    for (const int frame : frames)
      EXPECT_EQ(recent.of(frame), computed_points(*databases[user], frame, lever_m))
          << "reading " << reading << ", frame " << frame;
  }
}

}  // namespace
}  // namespace sparse_mocap::path_regression
