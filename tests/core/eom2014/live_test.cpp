// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/live.hpp"

#include "eom2014/walk.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "support/refusals.hpp"

namespace sparse_mocap::eom2014 {
namespace {

class EomLive : public EomWalk {
 protected:
  static LiveReconstructor live(const OptionValues& options = {}) {
    return made<LiveReconstructor>(options);
  }
};

double error_m(const std::vector<PoseEstimate>& poses, const Skeleton& skeleton,
               const Motion& truth, int from = 0) {
  const Eigen::MatrixXd errors =
      joint_positions(to_motion(poses, skeleton, 30.0), PositionFrame::heading) -
      joint_positions(truth, PositionFrame::heading);
  const auto late = errors.rightCols(errors.cols() - from);
  return std::sqrt(late.squaredNorm() / static_cast<double>(late.size() / 3));
}

TEST_F(EomLive, GivesAPoseForEachReadingAfterItsLag) {
  auto method = live({{"lag_ms", "300"}});
  EXPECT_DOUBLE_EQ(method.latency_s(), 0.3);
  const auto take = take_of(walking_motion(360, 120.0));
  std::vector<PoseEstimate> poses;
  for (std::size_t t = 0; t < take.size(); ++t) {
    const auto pose = method.step(take[t]);
    ASSERT_EQ(pose.has_value(), t >= 9) << t;
    if (!pose) continue;
    EXPECT_EQ(pose->time_s, take[t - 9].time_s);
    poses.push_back(*pose);
  }
  const auto last = method.flush();
  EXPECT_EQ(last.size(), 9U);
  poses.insert(poses.end(), last.begin(), last.end());
  ASSERT_EQ(poses.size(), take.size());
  const Motion truth = resampled(walking_motion(360, 120.0), 30.0);
  EXPECT_LT(error_m(poses, method.skeleton(), truth), 0.04);
}

TEST_F(EomLive, WithALongLagItIsAsOnTheWholeTake) {
  const OptionValues options{{"lag_ms", "1000"}, {"estimates_mounting", "false"}};
  auto method = live(options);
  const auto take = take_of(walking_motion(360, 120.0));
  const auto poses = solve_live(method, take, Progress());
  const auto whole = made<Reconstructor>(options).solve(take, Progress());
  ASSERT_EQ(poses.size(), whole.size());
  for (std::size_t t = 0; t < poses.size(); ++t) {
    for (std::size_t j = 0; j < poses[t].rotations.size(); ++j)
      EXPECT_LT(poses[t].rotations[j].angularDistance(whole[t].rotations[j]), 0.03) << t;
    EXPECT_LT((poses[t].root_position - whole[t].root_position).norm(), 0.03) << t;
  }
}

TEST_F(EomLive, FindsHowTheSensorIsTurnedWithinSeconds) {
  auto take = take_of(walking_motion(720, 120.0));
  const Mat3 R_site_sensor =
      Eigen::AngleAxisd(30.0 * kRadiansPerDegree, Vec3::UnitX()).toRotationMatrix();
  for (auto& reading : take) {
    reading.specific_force = R_site_sensor.transpose() * reading.specific_force / kGravity_mps2;
    reading.angular_velocity = R_site_sensor.transpose() * reading.angular_velocity;
  }
  auto method = live();
  const auto poses = solve_live(method, take, Progress());
  std::string notes;
  for (const auto& note : method.notes()) notes += note;
  EXPECT_NE(notes.find("turned by "), std::string::npos) << notes;
  const Motion truth = resampled(walking_motion(720, 120.0), 30.0);
  EXPECT_LT(error_m(poses, method.skeleton(), truth, 90), 0.05);
}

TEST_F(EomLive, BeginsAnewAfterAReset) {
  auto method = live();
  const auto take = take_of(walking_motion(360, 120.0));
  const auto first = solve_live(method, take, Progress());
  for (int t = 0; t < 20; ++t) method.step(take[static_cast<std::size_t>(t)]);
  const auto again = solve_live(method, take, Progress());
  ASSERT_EQ(first.size(), again.size());
  for (std::size_t t = 0; t < first.size(); ++t)
    EXPECT_EQ(first[t].root_position, again[t].root_position);
}

TEST_F(EomLive, GoesOnThroughGapsAndRefusesReadingsWithoutGravity) {
  auto take = take_of(walking_motion(360, 120.0));
  for (std::size_t t = 0; t < 40; ++t) take[t + 20] = Reading(1);
  take.front() = Reading(1);
  auto method = live();
  for (const auto& pose : solve_live(method, take, Progress()))
    for (const auto& rotation : pose.rotations) EXPECT_NEAR(rotation.norm(), 1.0, 1e-6);
  for (auto& reading : take) reading.specific_force.setConstant(0.01);
  for (auto& reading : take) reading.angular_velocity.setConstant(0.01);
  EXPECT_REFUSED(ConfigError, "no gravity in them", solve_live(method, take, Progress()));
  EXPECT_REFUSED(ConfigError, "a reading of 1 sensors", live().step(Reading(2)));
}

}  // namespace
}  // namespace sparse_mocap::eom2014
