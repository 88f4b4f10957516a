// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/whole_take.hpp"

#include <gtest/gtest.h>

#include "liu2011/bodies.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::liu2011 {
namespace {

using testing::distance_m;
using testing::pose_of;
using testing::Random;
using testing::random_pose;
using testing::readings_of;
using testing::swaying_motion;
using testing::template_skeleton;

// The terms of refine(), summed anew from joints alone.
double unevenness(const std::vector<BodyPose>& poses) {
  const Skeleton body = template_skeleton();
  double sum = 0.0;
  for (std::size_t t = 1; t + 1 < poses.size(); ++t)
    sum += (pose_vector(body, poses[t], poses[t - 1]) + pose_vector(body, poses[t], poses[t + 1]))
               .tail(body.num_angles())
               .squaredNorm();
  return sum;
}

TEST(Middle, IsAsFarFromBoth) {
  const Skeleton body = template_skeleton();
  Random random(1);
  const BodyPose a = random_pose(body, random, 0.3), b = random_pose(body, random, 0.3);
  const BodyPose half = middle(body, a, b);
  const Eigen::VectorXd to_a = pose_vector(body, half, a), to_b = pose_vector(body, half, b);
  EXPECT_LT((to_a + to_b).norm(), 0.05 * to_a.norm());
  EXPECT_LT(distance_m(body, middle(body, a, a), a), 1e-9);
}

TEST(Refine, EvensJitterOutAndKeepsToTheSensors) {
  const Skeleton body = template_skeleton();
  const Motion motion = swaying_motion(body, 1, 60, 25.0);
  const auto worn = worn_sensors(body, {{find_site("left_hand"), 1.0, Channel::position},
                                        {find_site("torso"), 1.0, Channel::orientation}});
  Random random(2);
  std::vector<BodyPose> poses, truth;
  std::vector<std::vector<Observation>> observed;
  for (int t = 0; t < motion.num_frames(); ++t) {
    truth.push_back(pose_of(motion, t));
    observed.push_back(sensors_of(body, worn, truth.back()));
    poses.push_back(moved(body, truth.back(), random.column(num_freedoms(body), 0.05)));
  }
  const auto before = poses;
  refine(body, observed, Config(), poses);
  EXPECT_LT(unevenness(poses), 0.1 * unevenness(before));
  double off = 0.0, off_before = 0.0;
  for (std::size_t t = 0; t < poses.size(); ++t) {
    off += pose_vector(body, truth[t], poses[t]).norm();
    off_before += pose_vector(body, truth[t], before[t]).norm();
    const auto hand = sensors_of(body, worn, poses[t]).front();
    EXPECT_LT((hand.measured.position - observed[t][0].measured.position).norm(), 0.03);
  }
  EXPECT_LT(off, 0.8 * off_before);
}

// Playing clips backward, a frame's history is what comes after it, placed as it was performed.
TEST(MotionExamples, PlaysClipsBackward) {
  const auto database = testing::database_of({swaying_motion(template_skeleton(), 1, 50, 25.0),
                                              swaying_motion(template_skeleton(), 2, 50, 25.0)});
  const MotionExamples forward(database, database->skeleton());
  const MotionExamples backward(database, database->skeleton(), Direction::backward);
  const auto before = forward.history(20, 3);
  const auto after = backward.history(16, 3);  // frames 17, 18, 19
  ASSERT_EQ(after[0].frame, 17);
  ASSERT_EQ(after[2].frame, 19);
  // From 17 to 19 backward is as far as from 19 to 17 forward.
  const HeadingFrame& there = after[2].heading;
  const HeadingFrame back = before[2].heading;
  EXPECT_EQ(before[2].frame, 17);
  EXPECT_NEAR(there.yaw_rad, -back.yaw_rad, 1e-9);
  EXPECT_LT((there.origin - back.inverse().origin).norm(), 1e-9);
  EXPECT_EQ(backward.history(49, 1)[0].frame, 49);  // the clip's end stands in for what follows
}

TEST(WholeTakeReconstructor, IsNearerThanLiveAndTheSameOnOneThread) {
  std::vector<Motion> motions;
  for (const double pace : {1.0, 0.9, 1.1})
    for (unsigned seed = 0; seed < 3; ++seed) {
      motions.push_back(swaying_motion(template_skeleton(), seed, 80, 25.0 * pace));
      motions.back().frame_time_s = 1.0 / 25.0;
    }
  const auto database = testing::database_of(motions);
  std::vector<Sensor> sensors;
  for (const char* site : {"left_hand", "right_ankle", "torso"})
    sensors.push_back({find_site(site), 1.0, Channel::position | Channel::orientation});
  const auto take = readings_of(*database, 0, sensors);
  MethodContext context{database, nullptr, {}, sensors, {0}};
  const auto error = [&](const std::vector<PoseEstimate>& estimates) {
    double sum = 0.0;
    for (std::size_t t = 0; t < estimates.size(); ++t) {
      BodyPose pose{estimates[t].root_position, {}};
      for (const Quat& q : estimates[t].rotations) pose.rotations.push_back(q.toRotationMatrix());
      for (const auto& one :
           sensors_of(template_skeleton(), worn_sensors(template_skeleton(), sensors), pose))
        sum += (one.measured.position - take[t].position.col(one.worn.sensor)).norm();
    }
    return sum / static_cast<double>(estimates.size());
  };
  WholeTakeReconstructor best({}, context);
  const auto found = best.solve(take, Progress());
  ASSERT_EQ(found.size(), take.size());
  EXPECT_LT(error(found), 0.06);
  context.num_threads = 1;
  const auto alone = WholeTakeReconstructor({}, context).solve(take, Progress());
  for (std::size_t t = 0; t < found.size(); ++t)
    EXPECT_EQ(found[t].root_position, alone[t].root_position);
}

}  // namespace
}  // namespace sparse_mocap::liu2011
