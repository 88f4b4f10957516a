// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/reconstruction/method.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "sparse_mocap/motion/heading.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::Random;
using testing::template_skeleton;

// Answers each reading two readings late, with the reading's time.
class Echo : public LiveMethod {
 public:
  const Skeleton& skeleton() const override { return skeleton_; }
  double rate_hz() const override { return 25.0; }
  double latency_s() const override { return 0.08; }
  double history_s() const override { return 0.0; }

  std::optional<PoseEstimate> step(const Reading& reading) override {
    waiting_.push_back(reading.time_s);
    if (waiting_.size() <= 2) return std::nullopt;
    return next();
  }
  std::vector<PoseEstimate> flush() override {
    std::vector<PoseEstimate> last;
    while (!waiting_.empty()) last.push_back(next());
    return last;
  }
  void reset() override { waiting_.clear(); }

 private:
  PoseEstimate next() {
    PoseEstimate estimate;
    estimate.time_s = waiting_.front();
    waiting_.erase(waiting_.begin());
    return estimate;
  }
  Skeleton skeleton_ = template_skeleton();
  std::vector<double> waiting_;
};

std::vector<Reading> readings_at(const std::vector<double>& times_s) {
  std::vector<Reading> readings;
  for (const double time_s : times_s) {
    readings.emplace_back(1);
    readings.back().time_s = time_s;
  }
  return readings;
}

TEST(SolveLive, GivesTheEstimatesInOrderAndStartsAnew) {
  Echo echo;
  echo.step(readings_at({-1.0}).front());
  for (const std::size_t length : {0U, 1U, 2U, 5U}) {
    std::vector<double> times_s;
    for (std::size_t t = 0; t < length; ++t) times_s.push_back(static_cast<double>(t));
    const auto estimates = solve_live(echo, readings_at(times_s), Progress());
    ASSERT_EQ(estimates.size(), length);
    for (std::size_t t = 0; t < length; ++t) EXPECT_EQ(estimates[t].time_s, times_s[t]);
  }
}

TEST(SolveLive, ReportsEveryReadingAndCanBeCancelled) {
  Echo echo;
  const auto take = readings_at({0, 1, 2, 3, 4, 5});
  std::vector<std::size_t> seen;
  solve_live(echo, take, Progress([&](std::size_t done, std::size_t total, std::string_view) {
               EXPECT_EQ(total, 6U);
               seen.push_back(done);
               return true;
             }));
  EXPECT_EQ(seen, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_THROW(solve_live(echo, take, Progress([](std::size_t done, std::size_t, std::string_view) {
                            return done < 3;
                          })),
               Cancelled);
}

TEST(RequireSensors, RefusesAReadingOfOtherSensors) {
  EXPECT_NO_THROW(require_sensors(Reading(4), 4));
  try {
    require_sensors(Reading(3), 4);
    FAIL() << "nothing was thrown";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "a reading of 4 sensors is expected, got 3");
  }
}

TEST(ToMotion, HoldsEveryPoseInTheWorld) {
  Random random(1);
  const Skeleton skeleton = template_skeleton();
  std::vector<PoseEstimate> estimates;
  std::vector<Eigen::VectorXd> angles;
  const std::vector<double> yaws{0.0, 0.5, -3.0};
  for (const double yaw_rad : yaws) {
    angles.push_back(random.column(43, 0.6));
    PoseEstimate estimate;
    estimate.rotations = pose_rotations(skeleton, angles.back(), yaw_rad);
    estimate.root_position = random.vector(2.0);
    estimates.push_back(estimate);
  }
  const Motion motion = to_motion(estimates, skeleton, 25.0);
  ASSERT_EQ(motion.num_frames(), 3);
  EXPECT_DOUBLE_EQ(motion.frame_time_s, 0.04);
  JointTransforms pose;
  for (std::size_t t = 0; t < 3; ++t) {
    forward_kinematics(skeleton, Vec3::Zero(), angles[t], pose);
    const auto at = motion.transforms(static_cast<int>(t));
    for (std::size_t j = 0; j < pose.end.size(); ++j)
      EXPECT_LT(
          (at.end[j] - estimates[t].root_position - yaw_rotation(yaws[t]) * pose.end[j]).norm(),
          1e-12);
  }
  EXPECT_EQ(to_motion({}, skeleton, 25.0).num_frames(), 0);
}

}  // namespace
}  // namespace sparse_mocap
