// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/reconstruction/extremity_track.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::template_skeleton;

constexpr double kRate_hz = 25.0;

// A pose whose ankles are so high, at rest but for its legs, which are tilted about x by lean_rad.
PoseEstimate pose_at(double ankle_m, double lean_rad, double stands) {
  const Skeleton skeleton = template_skeleton();
  PoseEstimate estimate;
  estimate.rotations.assign(kNumStandardJoints, Quat::Identity());
  for (const auto thigh : {standard_joint::lfemur, standard_joint::rfemur})
    estimate.rotations[thigh] = Quat(Eigen::AngleAxisd(lean_rad, Vec3::UnitX()));
  const double below =
      to_motion({estimate}, skeleton, kRate_hz).transforms(0).end[standard_joint::ltibia].y();
  estimate.root_position.y() = ankle_m - below;
  estimate.contacts.setConstant(stands);
  return estimate;
}

// Feet that are tilted down from their shanks, which are upright but for their lean.
void point_feet(PoseEstimate& estimate, double down_rad) {
  for (const auto foot : {extremity::lfoot, extremity::rfoot}) {
    const auto e = static_cast<std::size_t>(foot);
    estimate.extremities.R_parent_joint[e] = Quat(Eigen::AngleAxisd(down_rad, Vec3::UnitX()));
    estimate.extremities.certainty[e] = 1.0;
  }
}

JointTransforms completed(PoseEstimate estimate) {
  ExtremityTrack track(template_skeleton(), kRate_hz);
  track.complete(estimate);
  return to_motion({estimate}, track.skeleton(), kRate_hz).transforms(0);
}

std::size_t joint(int e) { return static_cast<std::size_t>(extremity_joint(e)); }

TEST(ExtremityTrack, LeavesOtherSkeletonsAlone) {
  const Skeleton two({{"a", -1, {}, {0, 1, 0}, Mat3::Identity(), {Axis::x}},
                      {"b", 0, {}, {0, 1, 0}, Mat3::Identity(), {Axis::x}}});
  ExtremityTrack track(two, kRate_hz);
  PoseEstimate estimate;
  estimate.rotations.assign(2, Quat::Identity());
  track.complete(estimate);
  EXPECT_EQ(estimate.rotations.size(), 2U);
  EXPECT_EQ(track.skeleton().num_joints(), 2);
}

// Whatever the shanks' lean, a standing foot that is nearly flat lies flat.
TEST(ExtremityTrack, AStandingFootIsLevel) {
  for (const double lean : {-0.6, 0.0, 0.5}) {
    PoseEstimate estimate = pose_at(0.09, lean, 1.0);
    point_feet(estimate, 0.2 - lean);
    const JointTransforms pose = completed(estimate);
    for (const auto e : {extremity::lfoot, extremity::rfoot}) {
      EXPECT_LT((pose.R_world_joint[joint(e)] * kUp - kUp).norm(), 1e-6) << lean;
      EXPECT_LT((pose.R_world_joint[joint(e + 1)] * kUp - kUp).norm(), 1e-6) << lean;
    }
  }
}

TEST(ExtremityTrack, ARaisedHeelStaysRaised) {
  PoseEstimate estimate = pose_at(0.16, 0.0, 1.0);
  point_feet(estimate, 0.7);
  const JointTransforms pose = completed(estimate);
  const double tilt = std::acos((pose.R_world_joint[joint(extremity::lfoot)] * kUp).y());
  EXPECT_GT(tilt, 0.6);
  EXPECT_GT(pose.end[joint(extremity::ltoes)].y(), -1e-6);
}

TEST(ExtremityTrack, AFreeFootIsAsRetrieved) {
  PoseEstimate estimate = pose_at(0.5, 0.4, 0.0);
  point_feet(estimate, 0.5);
  PoseEstimate out = estimate;
  ExtremityTrack track(template_skeleton(), kRate_hz);
  track.complete(out);
  ASSERT_EQ(out.rotations.size(), 27U);
  for (const auto e : {extremity::lfoot, extremity::rfoot})
    EXPECT_LT(out.rotations[joint(e)].angularDistance(
                  estimate.extremities.R_parent_joint[static_cast<std::size_t>(e)]),
              1e-9);
}

TEST(ExtremityTrack, NoToesAreUnderTheFloor) {
  for (const double ankle_m : {0.02, 0.06, 0.1, 0.15}) {
    for (const double down : {0.0, 0.4, 0.7, 1.0}) {
      PoseEstimate estimate = pose_at(ankle_m, 0.0, 0.0);
      point_feet(estimate, down);
      const JointTransforms pose = completed(estimate);
      for (int e = 0; e < kNumExtremities; ++e)
        EXPECT_GT(pose.end[joint(e)].y(), -1e-6) << ankle_m << " " << down << " " << e;
    }
  }
}

TEST(ExtremityTrack, IsRelaxedWhereNothingIsKnown) {
  const Skeleton full = with_extremities(template_skeleton());
  PoseEstimate estimate = pose_at(0.6, 0.3, 0.0);
  ExtremityTrack track(template_skeleton(), kRate_hz);
  track.complete(estimate);
  for (int e = 0; e < kNumExtremities; ++e) {
    const Quat expected(relaxed(full, static_cast<extremity::Index>(e)));
    EXPECT_LT(estimate.rotations[joint(e)].angularDistance(expected), 1e-9);
  }
}

// Retrieved feet that jump by a radian come out as a movement, live and from a whole take.
TEST(ExtremityTrack, IsSmoothInTime) {
  std::vector<PoseEstimate> take;
  for (int t = 0; t < 40; ++t) {
    take.push_back(pose_at(0.6, 0.0, 0.0));
    point_feet(take.back(), t < 20 ? 0.0 : 1.0);
  }
  std::vector<PoseEstimate> live = take, best = take;
  ExtremityTrack track(template_skeleton(), kRate_hz);
  for (auto& estimate : live) track.complete(estimate);
  track.complete(best);
  for (const auto* out : {&live, &best}) {
    double largest = 0.0;
    for (std::size_t t = 1; t < out->size(); ++t)
      largest = std::max(largest, (*out)[t].rotations[joint(0)].angularDistance(
                                      (*out)[t - 1].rotations[joint(0)]));
    EXPECT_LT(largest, 0.6);
    const auto& last = out->back();
    EXPECT_LT(last.rotations[joint(0)].angularDistance(last.extremities.R_parent_joint[0]), 0.01);
  }
  // A whole take begins to move before the jump, live after it.
  EXPECT_GT(best[19].rotations[joint(0)].angularDistance(take[0].extremities.R_parent_joint[0]),
            0.1);
  EXPECT_LT(live[19].rotations[joint(0)].angularDistance(take[0].extremities.R_parent_joint[0]),
            1e-9);
}

TEST(ExtremityTrack, ForgetsWhatWasWhenReset) {
  ExtremityTrack track(template_skeleton(), kRate_hz);
  PoseEstimate first = pose_at(0.6, 0.0, 0.0), second = pose_at(0.6, 0.0, 0.0);
  point_feet(first, 1.0);
  point_feet(second, 0.0);
  track.complete(first);
  track.reset();
  track.complete(second);
  EXPECT_LT(second.rotations[joint(0)].angularDistance(second.extremities.R_parent_joint[0]), 1e-9);
}

}  // namespace
}  // namespace sparse_mocap
