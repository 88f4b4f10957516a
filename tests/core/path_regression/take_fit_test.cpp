// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/take_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"
#include "sparse_mocap/path_regression/fit_equations.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::path_regression {
namespace {

using namespace standard_joint;
using testing::Random;

const Skeleton kSkeleton = testing::template_skeleton();
constexpr double kDt = 0.04;

JointTransforms posed(const JointRotations& rotations) {
  JointTransforms pose;
  forward_kinematics(kSkeleton, Vec3::Zero(), rotations, pose);
  return pose;
}

FitWeights all_weights() {
  return {.lever_m = 0.15,
          .pose = 1.0,
          .step = 0.7,
          .smoothness = 0.4,
          .calm_mps = 0.6,
          .inclination = 3.0,
          .contact = 20.0,
          .stands_from = 0.0,
          .stands_at = 1.0,
          .foot_height = 8.0,
          .turning = 1.5,
          .root_step = 2.0,
          .root_turn = 0.9,
          .root_height = 4.0,
          .root_smoothness = 0.6,
          .hinge = 2.0};
}

struct Take {
  std::vector<FittedFrame> frames;
  std::vector<FrameTarget> targets;
};

// Frames and targets about each other, but nowhere alike.
Take random_take(Random& random, std::size_t length, double apart) {
  Take take;
  const Eigen::VectorXd middle = random.column(kNumStandardAngles, 0.7);
  for (std::size_t t = 0; t < length; ++t) {
    const auto pose = joint_rotations(kSkeleton, middle + random.column(kNumStandardAngles, apart));
    take.frames.push_back({turned(kSkeleton, pose, random.column(kNumStandardAngles, apart)),
                           random.vector(0.3), random.in(-0.5, 0.5)});
    FrameTarget target;
    target.points = pose_points(posed(pose), 0.15);
    target.step = random.column(target.points.size(), 0.02);
    target.agreement = random.in(0.3, 1.0);
    target.inclination = {{lradius, rtibia}, {random.in(-0.2, 0.2), random.in(-0.2, 0.2)}};
    target.root.velocity_mps = {random.in(-1.0, 1.0), random.in(-1.0, 1.0)};
    target.root.yaw_rate_radps = random.in(-1.0, 1.0);
    target.root.height_m = 0.9;
    target.turning = {{lwrist, random.in(-1.0, 1.0)}, {rtibia, random.in(-1.0, 1.0)}};
    target.feet = {{random.in(0.0, 1.0), random.in(0.0, 1.0)},
                   {random.vector(0.03), random.vector(0.03)},
                   {0.1, -0.1}};
    take.targets.push_back(std::move(target));
  }
  return take;
}

// How much of a foot's certainty counts.
double shown(double certainty) { return certainty * certainty * (3.0 - 2.0 * certainty); }

// By how much knees and elbows bend too far or the wrong way, squared.
double beyond_squared(const JointRotations& rotations) {
  double sum = 0.0;
  for (const auto& [joint, most_deg] : {std::pair{ltibia, 160.0}, std::pair{rtibia, 160.0},
                                        std::pair{lradius, 150.0}, std::pair{rradius, 150.0}}) {
    const Eigen::AngleAxisd turn(rotations[static_cast<std::size_t>(joint)]);
    const Vec3 hinge = kSkeleton.joint(joint).R_joint_axes * Vec3::UnitX();
    const double angle = turn.angle() * turn.axis().dot(hinge);
    sum += std::pow(angle - std::clamp(angle, 0.0, most_deg * kRadiansPerDegree), 2);
  }
  return sum;
}

// The terms written out one by one.
double expected_value(const Take& take, const FitWeights& w, std::size_t first_free) {
  std::vector<Eigen::VectorXd> x;
  std::vector<Vec3> p;
  std::vector<std::array<Vec3, 2>> feet;
  for (const auto& frame : take.frames) {
    const JointTransforms pose = posed(frame.rotations);
    x.push_back(pose_points(pose, w.lever_m));
    p.push_back(frame.root_position);
    feet.push_back({frame.root_position + yaw_rotation(frame.yaw_rad) * pose.end[ltibia],
                    frame.root_position + yaw_rotation(frame.yaw_rad) * pose.end[rtibia]});
  }
  double sum = 0.0;
  for (std::size_t t = first_free; t < take.frames.size(); ++t) {
    const FrameTarget& target = take.targets[t];
    const auto& yaw = [&](std::size_t at) { return take.frames[at].yaw_rad; };
    sum += w.pose * target.agreement * (x[t] - target.points).squaredNorm();
    const JointTransforms pose = posed(take.frames[t].rotations);
    sum +=
        w.inclination *
        std::pow(pose.end[lradius].y() - pose.end[lhumerus].y() - target.inclination.rises_m[0], 2);
    sum += w.inclination *
           std::pow(pose.end[rtibia].y() - pose.end[rfemur].y() - target.inclination.rises_m[1], 2);
    sum += w.hinge * beyond_squared(take.frames[t].rotations);
    sum += w.root_height * std::pow(p[t].y() - target.root.height_m, 2);
    for (std::size_t side = 0; side < 2; ++side) {
      const auto row = static_cast<Eigen::Index>(side);
      const double above = feet[t][side].y() - target.feet.height_m[row];
      sum +=
          w.foot_height * (above < 0.0 ? 1.0 : shown(target.feet.certainty[row])) * above * above;
    }
    if (t < 1) continue;
    sum += w.step * (x[t] - x[t - 1] - target.step).squaredNorm();
    const Eigen::Vector2d v = target.root.velocity_mps * kDt;
    const Vec3 step = yaw_rotation(yaw(t - 1)) * Vec3(v.x(), 0.0, v.y());
    const Vec3 moved = p[t] - p[t - 1] - step;
    sum += w.root_step * (moved.x() * moved.x() + moved.z() * moved.z());
    sum += 0.07 * w.root_turn * std::pow(yaw(t) - yaw(t - 1) - target.root.yaw_rate_radps * kDt, 2);
    for (std::size_t side = 0; side < 2; ++side) {
      const Vec3 rolls = yaw_rotation(yaw(t - 1)) * target.feet.step_m[side];
      sum += w.contact * shown(target.feet.certainty[static_cast<Eigen::Index>(side)]) *
             (feet[t][side] - feet[t - 1][side] - rolls).squaredNorm();
    }
    for (std::size_t k = 0; k < 2; ++k) {
      const auto joint = static_cast<std::size_t>(target.turning[k].joint);
      const auto world = [&](std::size_t at) {
        return Mat3(yaw_rotation(yaw(at)) * posed(take.frames[at].rotations).R_world_joint[joint]);
      };
      // The yaws are about the vertical, the rest of the turn is seen from the body.
      const Eigen::AngleAxisd turn(Mat3(yaw_rotation(-yaw(t)) * world(t) *
                                        world(t - 1).transpose() * yaw_rotation(yaw(t - 1))));
      const double rate =
          0.5 * (target.turning[k].rate_radps + take.targets[t - 1].turning[k].rate_radps);
      sum += w.turning *
             std::pow(yaw(t) - yaw(t - 1) + turn.angle() * turn.axis().y() - rate * kDt, 2);
    }
    if (t < 2) continue;
    const double speed_mps =
        std::sqrt(target.step.head<3 * kNumStandardJoints>().squaredNorm() / kNumStandardJoints) /
        kDt;
    sum += w.smoothness * (1.0 - target.agreement) / (1.0 + std::pow(speed_mps / w.calm_mps, 2)) *
           (x[t] - 2.0 * x[t - 1] + x[t - 2]).squaredNorm();
    sum += w.root_smoothness * (p[t] - 2.0 * p[t - 1] + p[t - 2]).squaredNorm();
    sum += w.root_smoothness * std::pow(yaw(t) - 2.0 * yaw(t - 1) + yaw(t - 2), 2);
  }
  return sum;
}

// All steps as one column.
std::vector<FittedFrame> stepped(std::vector<FittedFrame> frames, std::size_t first_free,
                                 const Eigen::VectorXd& steps) {
  constexpr Eigen::Index kSize = kNumStandardAngles + 4;
  for (std::size_t t = first_free; t < frames.size(); ++t) {
    const auto step = steps.segment<kSize>(static_cast<Eigen::Index>(t - first_free) * kSize);
    frames[t].rotations = turned(kSkeleton, frames[t].rotations, step.head<kNumStandardAngles>());
    frames[t].root_position += step.segment<3>(kNumStandardAngles);
    frames[t].yaw_rad += step[kNumStandardAngles + 3];
  }
  return frames;
}

TEST(TakeFit, ValueIsTheSumOfItsTerms) {
  Random random(1);
  const FitWeights weights = all_weights();
  for (const std::size_t first_free : {0U, 2U}) {
    const Take take = random_take(random, 5, 0.3);
    EXPECT_NEAR(TakeFit(kSkeleton, kDt, weights).value(take.frames, take.targets, first_free),
                expected_value(take, weights, first_free), 1e-9);
  }
}

// The equations are half the gradient and Gauss-Newton's half of the second derivatives, which are
// dense here by central differences of the value.
TEST(FitEquations, GradientEqualsCentralDifferences) {
  Random random(2);
  const FitWeights weights = all_weights();
  for (const std::size_t first_free : {0U, 2U}) {
    const Take take = random_take(random, 4, 0.3);
    FitEquations equations(kSkeleton, kDt, weights);
    equations.form(take.frames, take.targets, static_cast<int>(first_free));
    const int size = equations.system().block_size();
    for (int i = 0; i < equations.system().num_blocks(); ++i) {
      for (int k = 0; k < size; ++k) {
        Eigen::VectorXd step = Eigen::VectorXd::Zero(equations.system().num_blocks() * size);
        step[i * size + k] = 1e-5;
        Take more = take, less = take;
        more.frames = stepped(take.frames, first_free, step);
        less.frames = stepped(take.frames, first_free, -step);
        const double slope = (expected_value(more, weights, first_free) -
                              expected_value(less, weights, first_free)) /
                             2e-5;
        EXPECT_NEAR(-2.0 * equations.system().right(i)[k], slope, 1e-5) << i << " " << k;
      }
    }
  }
}

TEST(TakeFit, EndsWhereNoSmallStepGoesDown) {
  Random random(3);
  const FitWeights weights = all_weights();
  Take take = random_take(random, 6, 0.2);
  const double before = expected_value(take, weights, 0);
  const double reached = TakeFit(kSkeleton, kDt, weights).fit(take.frames, take.targets, 0, 100);
  EXPECT_NEAR(reached, expected_value(take, weights, 0), 1e-9);
  EXPECT_LT(reached, before);
  for (int trial = 0; trial < 20; ++trial) {
    Take other = take;
    other.frames = stepped(take.frames, 0, random.column(6 * (kNumStandardAngles + 4), 0.003));
    EXPECT_GT(expected_value(other, weights, 0), reached - 1e-5);
  }
}

// A long take is fitted for minutes: how far that is must be seen, and it must end when asked to.
TEST(TakeFit, SaysHowFarItIsAndEndsWhenAsked) {
  Random random(5);
  const Take start = random_take(random, 70, 0.2);
  Take take = start, same = start, cancelled = start;
  std::vector<std::size_t> done;
  const Progress progress(
      Progress::Callback([&](std::size_t reached, std::size_t total, std::string_view) {
        EXPECT_LT(reached, total);
        done.push_back(reached);
        return true;
      }));
  const double value =
      TakeFit(kSkeleton, kDt, all_weights()).fit(take.frames, take.targets, 0, 4, progress);
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  EXPECT_GE(done.size(), 8U);  // more than once in each step
  EXPECT_EQ(TakeFit(kSkeleton, kDt, all_weights()).fit(same.frames, same.targets, 0, 4), value);
  std::size_t asked = 0;
  const Progress twice(
      Progress::Callback([&](std::size_t, std::size_t, std::string_view) { return ++asked < 2; }));
  EXPECT_THROW(
      TakeFit(kSkeleton, kDt, all_weights()).fit(cancelled.frames, cancelled.targets, 0, 4, twice),
      Cancelled);
  EXPECT_EQ(asked, 2U);
}

TEST(TakeFit, LeavesTheGivenFramesAlone) {
  Random random(4);
  Take take = random_take(random, 4, 0.2);
  const Take before = take;
  TakeFit(kSkeleton, kDt, all_weights()).fit(take.frames, take.targets, 3, 10);
  for (std::size_t t = 0; t < 3; ++t) {
    EXPECT_EQ(take.frames[t].root_position, before.frames[t].root_position);
    EXPECT_EQ(take.frames[t].rotations, before.frames[t].rotations);
  }
  EXPECT_NE(take.frames[3].root_position, before.frames[3].root_position);
}

// Positions alone leave the forearm's turn about itself free; the tips of its axes do not.
TEST(TakeFit, FindsAPoseWithItsTwists) {
  Random random(5);
  const auto pose = joint_rotations(kSkeleton, random.column(kNumStandardAngles, 0.7));
  Take take;
  FrameTarget target;
  target.points = pose_points(posed(pose), FitWeights().lever_m);
  target.root.height_m = 0.9;
  target.feet.height_m.setConstant(-1.0);  // far below
  take.targets = {target};
  take.frames = {
      {turned(kSkeleton, pose, random.column(kNumStandardAngles, 0.4)), Vec3::Zero(), 0.0}};
  FitWeights weights;
  weights.hinge = 0.0;  // the pose bends knees either way
  TakeFit(kSkeleton, kDt, weights).fit(take.frames, take.targets, 0, 50);
  for (std::size_t j = 0; j < pose.size(); ++j)
    EXPECT_LT((take.frames[0].rotations[j] - pose[j]).norm(), 1e-4) << j;
  const FittedFrame start = start_of(kSkeleton, kDt, target, nullptr);
  for (std::size_t j = 0; j < pose.size(); ++j)
    EXPECT_LT((start.rotations[j] - pose[j]).norm(), 1e-6) << j;
}

// The retrieved root says that it moves, a foot says that it stands: the foot wins.
TEST(TakeFit, DrawsAKneeBackThatBendsForwards) {
  Eigen::VectorXd angles = Eigen::VectorXd::Zero(kNumStandardAngles);
  angles[kSkeleton.angle_begin(ltibia)] = -40.0 * kRadiansPerDegree;
  std::vector<FittedFrame> frames{{joint_rotations(kSkeleton, angles), Vec3::Zero(), 0.0}};
  std::vector<FrameTarget> targets(1);
  targets[0].points = pose_points(posed(frames[0].rotations), 0.2);
  const auto bent_rad = [&](double hinge) {
    FitWeights weights{.lever_m = 0.2, .inclination = 0.0, .foot_height = 0.0};
    weights.hinge = hinge;
    auto fitted = frames;
    TakeFit(kSkeleton, kDt, weights).fit(fitted, targets, 0, 50);
    return std::sqrt(beyond_squared(fitted[0].rotations));
  };
  EXPECT_NEAR(bent_rad(0.0), 40.0 * kRadiansPerDegree, 1e-3);
  EXPECT_LT(bent_rad(5.0), 5.0 * kRadiansPerDegree);
}

TEST(TakeFit, KeepsAStandingFootInPlace) {
  const auto pose = joint_rotations(kSkeleton, Eigen::VectorXd::Zero(kNumStandardAngles));
  Take take;
  for (int t = 0; t < 25; ++t) {
    FrameTarget target;
    target.points = pose_points(posed(pose), FitWeights().lever_m);
    target.root = {{0.0, 0.5}, 0.0, 0.9, {1.0, 0.0}};
    target.feet.certainty = {1.0, 0.0};
    target.feet.height_m.setConstant(-1.0);  // far below
    take.targets.push_back(target);
    take.frames.push_back(
        start_of(kSkeleton, kDt, target, take.frames.empty() ? nullptr : &take.frames.back()));
  }
  EXPECT_NEAR(take.frames.back().root_position.z(), 24 * kDt * 0.5, 1e-9);
  TakeFit(kSkeleton, kDt, {.contact = 100.0, .root_step = 5.0})
      .fit(take.frames, take.targets, 0, 50);
  const auto foot = [&](const FittedFrame& frame, int ankle) -> Vec3 {
    return frame.root_position + yaw_rotation(frame.yaw_rad) *
                                     posed(frame.rotations).end[static_cast<std::size_t>(ankle)];
  };
  const FittedFrame &first = take.frames.front(), &last = take.frames.back();
  EXPECT_LT((foot(last, ltibia) - foot(first, ltibia)).norm(), 0.03);
  EXPECT_LT(last.root_position.z() - first.root_position.z(), 0.3);
}

// Everything is retrieved 10 cm too low, and the right foot stands.
TEST(TakeFit, PutsFeetOnTheFloorAndNoneBelow) {
  const auto pose = joint_rotations(kSkeleton, Eigen::VectorXd::Zero(kNumStandardAngles));
  const double ankle_m = posed(pose).end[rtibia].y();
  Take take;
  FrameTarget target;
  target.points = pose_points(posed(pose), FitWeights().lever_m);
  target.root.height_m = -ankle_m;
  target.feet = {{0.0, 1.0}, {Vec3::Zero(), Vec3::Zero()}, {0.1, 0.1}};
  take.targets = {target};
  take.frames = {start_of(kSkeleton, kDt, target, nullptr)};
  TakeFit(kSkeleton, kDt, {}).fit(take.frames, take.targets, 0, 50);
  const JointTransforms there = posed(take.frames[0].rotations);
  for (const auto ankle : {ltibia, rtibia})
    EXPECT_NEAR(take.frames[0].root_position.y() + there.end[static_cast<std::size_t>(ankle)].y(),
                0.1, 0.02);
}

// Retrieved motions do not turn, gyroscopes at trunk and limbs say that all does.
TEST(TakeFit, TurnsAsGyroscopesSay) {
  const auto pose = joint_rotations(kSkeleton, Eigen::VectorXd::Zero(kNumStandardAngles));
  Take take;
  for (int t = 0; t < 25; ++t) {
    FrameTarget target;
    target.points = pose_points(posed(pose), FitWeights().lever_m);
    target.root.height_m = 0.9;
    target.feet.height_m.setConstant(-1.0);
    for (const int joint : {lwrist, rwrist, ltibia, rtibia}) target.turning.push_back({joint, 0.8});
    take.targets.push_back(target);
    take.frames.push_back(
        start_of(kSkeleton, kDt, target, take.frames.empty() ? nullptr : &take.frames.back()));
  }
  TakeFit(kSkeleton, kDt, {}).fit(take.frames, take.targets, 0, 50);
  const double turned_rad = take.frames.back().yaw_rad - take.frames.front().yaw_rad;
  EXPECT_NEAR(turned_rad, 24 * kDt * 0.8, 0.2 * 24 * kDt * 0.8);
}

TEST(ToEstimate, TurnsThePoseToItsHeading) {
  Random random(6);
  const FittedFrame frame{joint_rotations(kSkeleton, random.column(kNumStandardAngles, 0.6)),
                          random.vector(2.0), 0.7};
  const PoseEstimate estimate = to_estimate(frame, 1.5, {0.25, 1.0}, {});
  EXPECT_EQ(estimate.time_s, 1.5);
  EXPECT_EQ(estimate.contacts, Eigen::Vector2d(0.25, 1.0));
  const JointTransforms pose = posed(frame.rotations);
  const auto world = to_motion({estimate}, kSkeleton, 25.0).transforms(0);
  for (std::size_t j = 0; j < pose.end.size(); ++j)
    EXPECT_LT((world.end[j] - frame.root_position - yaw_rotation(0.7) * pose.end[j]).norm(), 1e-12);
}

}  // namespace
}  // namespace sparse_mocap::path_regression
