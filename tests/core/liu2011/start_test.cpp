// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/start.hpp"

#include <gtest/gtest.h>

#include "liu2011/bodies.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::liu2011 {
namespace {

using testing::distance_m;
using testing::Random;
using testing::random_pose;
using testing::swaying_motion;
using testing::template_skeleton;

constexpr auto kBoth = Channel::position | Channel::orientation;

std::vector<WornSensor> worn() {
  return worn_sensors(template_skeleton(), {{find_site("left_hand"), 1.0, kBoth},
                                            {find_site("right_ankle"), 1.0, kBoth},
                                            {find_site("torso"), 1.0, kBoth}});
}

// The error that a placement leaves, summed anew.
double error_of(const std::vector<Observation>& observed, const std::vector<SensorPose>& modelled,
                const HeadingFrame& frame, const ControlWeights& weights) {
  const Mat3 R = yaw_rotation(frame.yaw_rad);
  double sum = 0.0;
  for (std::size_t s = 0; s < observed.size(); ++s) {
    const Vec3 away = R * modelled[s].position + frame.origin - observed[s].measured.position;
    if (observed[s].has_position) sum += away.squaredNorm() / std::pow(weights.sigma_position_m, 2);
    const Mat3 turn = R * modelled[s].R_frame_sensor - observed[s].measured.R_frame_sensor;
    if (observed[s].has_orientation)
      sum += 0.5 * turn.squaredNorm() / std::pow(weights.sigma_orientation_rad, 2);
  }
  return sum;
}

TEST(Placed, IsTheBestTurnAndPlace) {
  const Skeleton body = template_skeleton();
  Random random(1);
  const ControlWeights weights;
  for (int trial = 0; trial < 20; ++trial) {
    auto observed = sensors_of(body, worn(), random_pose(body, random, 0.5));
    std::vector<SensorPose> modelled;
    for (const auto& one : sensors_of(body, worn(), random_pose(body, random, 0.5)))
      modelled.push_back(one.measured);
    if (trial % 3 == 1)
      for (auto& one : observed) one.has_orientation = false;
    const Placement best = placed(observed, modelled, weights);
    EXPECT_NEAR(best.squared_error, error_of(observed, modelled, best.frame, weights),
                1e-6 * best.squared_error);
    EXPECT_EQ(best.frame.origin.y(), 0.0);
    for (int other = 0; other < 200; ++other) {
      const Vec3 by = random.vector(0.3);
      const HeadingFrame frame{best.frame.yaw_rad + random.in(-kPi, kPi),
                               best.frame.origin + Vec3(by.x(), 0.0, by.z())};
      EXPECT_GE(error_of(observed, modelled, frame, weights), best.squared_error * (1.0 - 1e-9));
    }
  }
}

TEST(Placed, FacesForwardAtTheOriginWhenNothingIsMeasured) {
  const Placement nowhere = placed({}, {}, {});
  EXPECT_EQ(nowhere.frame.yaw_rad, 0.0);
  EXPECT_EQ(nowhere.frame.origin, Vec3::Zero());
}

TEST(Start, FindsTheFrameWhereverItStands) {
  std::vector<Motion> motions;
  for (unsigned seed = 0; seed < 5; ++seed)
    motions.push_back(swaying_motion(template_skeleton(), seed, 80, 25.0));
  const MotionExamples examples(testing::database_of(motions), template_skeleton());
  const Start start(examples, std::vector<bool>(400, true));
  const HeadingFrame somewhere{2.1, {3.0, 0.0, -4.0}};
  for (const int frame : {40, 200, 395}) {
    const auto observed =
        sensors_of(examples.body(), worn(), somewhere.to_parent(examples.pose(frame)));
    const auto history = start.history(observed, {}, 3);
    ASSERT_EQ(history.size(), 3U);
    // The pose that follows it is the frame where it stood.
    const HeadingFrame newest = heading_frame_of(examples.body(), history.front(), 2.0);
    EXPECT_LT(distance_m(examples.body(), newest.to_parent(examples.next(frame)),
                         somewhere.to_parent(examples.pose(frame))),
              1e-3);
    EXPECT_LT(
        distance_m(examples.body(), newest.from_parent(history.front()), examples.pose(frame - 1)),
        1e-3);
  }
}

TEST(Start, BeginsWithoutSensors) {
  const MotionExamples examples(
      testing::database_of({swaying_motion(template_skeleton(), 1, 30, 25.0)}),
      template_skeleton());
  EXPECT_EQ(Start(examples, std::vector<bool>(30, true)).history({}, {}, 3).size(), 3U);
}

}  // namespace
}  // namespace sparse_mocap::liu2011
