// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/reconstruction/method.hpp"

#include <gtest/gtest.h>

#include "sparse_mocap/motion/heading.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::Random;
using testing::template_skeleton;

// Answers each reading two readings late, with the reading's first number as its yaw.
class Echo : public Method {
 public:
  std::optional<PoseEstimate> step(const Reading& reading) override {
    waiting_.push_back(reading(0, 0));
    if (waiting_.size() <= 2) return std::nullopt;
    return next();
  }
  std::vector<PoseEstimate> flush() override {
    std::vector<PoseEstimate> owed;
    while (!waiting_.empty()) owed.push_back(next());
    return owed;
  }
  int latency_frames() const override { return 2; }
  void reset() override { waiting_.clear(); }
  std::vector<PoseEstimate> solve(const std::vector<Reading>&, const Progress&) override {
    return {};
  }

 private:
  PoseEstimate next() {
    PoseEstimate estimate;
    estimate.yaw_rad = waiting_.front();
    waiting_.erase(waiting_.begin());
    return estimate;
  }
  std::vector<double> waiting_;
};

TEST(SolveOnline, GivesTheEstimatesInOrderAndStartsAnew) {
  Echo echo;
  echo.step(Reading::Constant(3, 1, -1.0));
  for (const int length : {0, 1, 2, 5}) {
    std::vector<Reading> take;
    for (int t = 0; t < length; ++t) take.push_back(Reading::Constant(3, 1, t));
    const auto estimates = solve_online(echo, take, Progress());
    ASSERT_EQ(static_cast<int>(estimates.size()), length);
    for (int t = 0; t < length; ++t) EXPECT_EQ(estimates[static_cast<std::size_t>(t)].yaw_rad, t);
  }
}

TEST(SolveOnline, ReportsEveryReadingAndCanBeCancelled) {
  Echo echo;
  const std::vector<Reading> take(6, Reading::Zero(3, 1));
  std::vector<std::size_t> seen;
  solve_online(echo, take, Progress([&](std::size_t done, std::size_t total, std::string_view) {
                 EXPECT_EQ(total, 6U);
                 seen.push_back(done);
                 return true;
               }));
  EXPECT_EQ(seen, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_THROW(
      solve_online(echo, take, Progress([](std::size_t done, std::size_t, std::string_view) {
                     return done < 3;
                   })),
      Cancelled);
}

TEST(ToMotion, PutsTheHeadingBackAndStandsWhereTheRootIs) {
  Random random(1);
  const Skeleton skeleton = template_skeleton();
  std::vector<PoseEstimate> estimates(5);
  for (auto& estimate : estimates) {
    estimate.angles = random.column(43, 0.6);
    estimate.root_position = random.vector(2.0);
    estimate.yaw_rad = random.in(-3.0, 3.0);
  }
  const Motion motion = to_motion(estimates, skeleton, 25.0);
  ASSERT_EQ(motion.num_frames(), 5);
  EXPECT_DOUBLE_EQ(motion.frame_time_s, 0.04);
  JointTransforms pose;
  for (std::size_t t = 0; t < 5; ++t) {
    forward_kinematics(skeleton, Vec3::Zero(), estimates[t].angles, pose);
    const auto at = motion.transforms(static_cast<int>(t));
    for (std::size_t j = 0; j < pose.end.size(); ++j)
      EXPECT_LT((at.end[j] - estimates[t].root_position -
                 yaw_rotation(estimates[t].yaw_rad) * pose.end[j])
                    .norm(),
                1e-12);
  }
  EXPECT_EQ(to_motion({}, skeleton, 25.0).num_frames(), 0);
}

}  // namespace
}  // namespace sparse_mocap
