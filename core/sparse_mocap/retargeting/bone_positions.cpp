// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/bone_positions.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace sparse_mocap {
namespace {

using namespace standard_joint;

// Chains of the trunk, along which exporters have more or fewer joints.
constexpr std::array kSpine{lowerback, upperback, thorax};
constexpr std::array kNeck{lowerneck, upperneck, head};

class BoneFinder {
 public:
  BoneFinder(const Skeleton& rig, const BodyJoints& joints, const JointTransforms& pose)
      : rig_(rig), joints_(joints), pose_(pose) {}

  BonePositions find() {
    bones_.begin.fill(pivot(root));
    bones_.end.fill(pivot(root));
    for (int side = 0; side < 2; ++side) find_leg(side);
    const Vec3 neck = neck_base();
    find_chain(kSpine, pivot(root), neck);
    if (has(head) || has(lowerneck)) find_chain(kNeck, neck, head_top());
    for (int side = 0; side < 2; ++side) find_arm(side, neck);
    bones_.left_hips = pivot(lfemur) - pivot(rfemur);
    bones_.left_shoulders = pivot(lhumerus) - pivot(rhumerus);
    bones_.up = neck - pivot(root);
    return bones_;
  }

 private:
  static std::size_t at(int j) { return static_cast<std::size_t>(j); }
  bool has(Index j) const { return joints_.standard[j] >= 0; }
  Vec3 pivot(Index j) const { return pose_.pivot[at(joints_.standard[j])]; }

  void set(Index joint, const Vec3& begin, const Vec3& end) {
    bones_.begin[joint] = begin;
    bones_.end[joint] = end;
  }

  // Where the bone of a rig's joint ends when no mapped joint follows: its own end, else the first
  // child's pivot.
  Vec3 last_end(int joint) const {
    if (rig_.joint(joint).bone.norm() > 0.0) return pose_.end[at(joint)];
    for (int c = 0; c < rig_.num_joints(); ++c)
      if (rig_.joint(c).parent == joint) return pose_.pivot[at(c)];
    return pose_.end[at(joint)];
  }

  void find_leg(int side) {
    const auto [hip, femur, tibia] = std::array{std::array{lhipjoint, lfemur, ltibia},
                                                std::array{rhipjoint, rfemur, rtibia}}[at(side)];
    const int ankle = joints_.ankle[at(side)];
    set(hip, pivot(root), pivot(femur));
    set(femur, pivot(femur), pivot(tibia));
    set(tibia, pivot(tibia),
        ankle >= 0 ? pose_.pivot[at(ankle)] : last_end(joints_.standard[tibia]));
    bones_.foot[at(side)] =
        ankle >= 0 ? Vec3(last_end(ankle) - pose_.pivot[at(ankle)]) : Vec3::Zero();
  }

  void find_arm(int side, const Vec3& neck) {
    const auto [clavicle, humerus, radius, wrist] =
        std::array{std::array{lclavicle, lhumerus, lradius, lwrist},
                   std::array{rclavicle, rhumerus, rradius, rwrist}}[at(side)];
    set(clavicle, neck, pivot(humerus));
    set(humerus, pivot(humerus), pivot(radius));
    set(radius, pivot(radius), has(wrist) ? pivot(wrist) : last_end(joints_.standard[radius]));
    if (has(wrist) && joints_.has_hand_tip[at(side)])
      set(wrist, pivot(wrist), last_end(joints_.standard[wrist]));
  }

  // Where a body has no neck joint, or one below the shoulders: the height of the shoulders on the
  // way from chest to head.
  Vec3 neck_base() const {
    const Vec3 shoulders = 0.5 * (pivot(lhumerus) + pivot(rhumerus));
    if (has(lowerneck) && !is_below(pivot(lowerneck), shoulders)) return pivot(lowerneck);
    if (!has(head)) return shoulders;
    const Vec3 below = has(thorax) ? pivot(thorax) : pivot(root);
    const Vec3 way = pivot(head) - below;
    if (way.squaredNorm() <= 0.0) return shoulders;
    return below + way * std::clamp(way.dot(shoulders - below) / way.squaredNorm(), 0.3, 0.9);
  }

  // Far enough below the shoulders, by the trunk's length, to be a joint of the spine.
  bool is_below(const Vec3& neck, const Vec3& shoulders) const {
    constexpr double kBelow = 0.2;
    const Vec3 up = shoulders - pivot(root);
    return (shoulders - neck).dot(up) > kBelow * up.squaredNorm();
  }

  Vec3 head_top() const {
    if (!has(head)) return last_end(joints_.standard[lowerneck]);
    return joints_.has_head_tip ? last_end(joints_.standard[head]) : pivot(head);
  }

  // Shares the way from begin to end among three standard joints: a joint that the rig has
  // starts at its pivot, those it lacks take equal parts of the stretch they lie in.
  void find_chain(const std::array<Index, 3>& joints, const Vec3& begin, const Vec3& end) {
    std::array<Vec3, 4> knots{begin, begin, begin, end};
    std::array<bool, 4> known{true, has(joints[1]), has(joints[2]), true};
    for (std::size_t i = 1; i < 3; ++i)
      if (known[i]) knots[i] = pivot(joints[i]);
    for (std::size_t i = 1; i < 3; ++i) {
      if (known[i]) continue;
      const std::size_t next = known[i + 1] ? i + 1 : i + 2;
      knots[i] = knots[i - 1] + (knots[next] - knots[i - 1]) / static_cast<double>(next - i + 1);
      known[i] = true;
    }
    for (std::size_t i = 0; i < 3; ++i) set(joints[i], knots[i], knots[i + 1]);
  }

  const Skeleton& rig_;
  const BodyJoints& joints_;
  const JointTransforms& pose_;
  BonePositions bones_;
};

}  // namespace

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

BonePositions bone_positions(const Skeleton& rig, const BodyJoints& joints,
                             const JointTransforms& pose) {
  return BoneFinder(rig, joints, pose).find();
}

void drop_odd_tips(const BonePositions& rest, BodyJoints& joints) {
  constexpr double kHeadUp_rad = 45.0 * kRadiansPerDegree;
  constexpr double kHandAlong_rad = 60.0 * kRadiansPerDegree;
  const Vec3 top = rest.vector(head);
  joints.has_head_tip =
      !top.isZero() && angle_between(top, rest.up) < kHeadUp_rad && top.norm() < rest.up.norm();
  for (const auto& [side, radius, wrist] :
       {std::tuple{0, lradius, lwrist}, std::tuple{1, rradius, rwrist}}) {
    const Vec3 hand = rest.vector(wrist), forearm = rest.vector(radius);
    joints.has_hand_tip[static_cast<std::size_t>(side)] =
        angle_between(hand, forearm) < kHandAlong_rad && hand.norm() < forearm.norm();
  }
}

double standing_error_rad(const BonePositions& bones) {
  constexpr double kArmsOut_rad = 60.0 * kRadiansPerDegree;  // horizontal arms are no error
  const Vec3 down = -bones.up;
  double worst = std::max(std::abs(angle_between(bones.left_hips, bones.up) - 0.5 * kPi),
                          angle_between(bones.left_hips, bones.left_shoulders));
  for (const auto leg : {lfemur, rfemur, ltibia, rtibia})
    worst = std::max(worst, angle_between(bones.vector(leg), down));
  for (const auto arm : {lhumerus, rhumerus, lradius, rradius})
    worst = std::max(worst, angle_between(bones.vector(arm), down) - kArmsOut_rad);
  return worst;
}

}  // namespace sparse_mocap
