// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/body_joints_by_shape.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sparse_mocap {
namespace {

// Joints down the tree, and how far it is along their pivots.
struct Chain {
  std::vector<int> joints;
  double length = 0.0;
};

// Two limbs of one body: chains that leave one joint and are alike.
struct Pair {
  Chain a, b;
  int parent = -1;
  std::size_t first = 0;   // where the upper of the two long bones starts
  double two_bones = 0.0;  // their length together
};

class ShapeFinder {
 public:
  ShapeFinder(const Skeleton& rig, const JointTransforms& pose)
      : rig_(rig), pose_(pose), longest_(rig.joints().size()) {
    for (int j = rig.num_joints() - 1; j >= 0; --j) {
      auto& own = longest_[at(j)];
      own.joints.insert(own.joints.begin(), j);
      if (j == 0) continue;
      const int parent = rig.joint(j).parent;
      const double length = own.length + distance(parent, j);
      auto& best = longest_[at(parent)];
      if (length > best.length) best = {own.joints, length};
    }
  }

  // Limbs, those with the longest pair of bones (the legs) first.
  std::vector<Pair> pairs() const {
    std::vector<Pair> found;
    for (int a = 1; a < rig_.num_joints(); ++a)
      for (int b = a + 1; b < rig_.num_joints(); ++b)
        if (rig_.joint(a).parent == rig_.joint(b).parent && are_alike(a, b))
          found.push_back(pair(a, b));
    std::erase_if(found, [](const Pair& p) { return p.two_bones <= 0.0; });
    std::stable_sort(found.begin(), found.end(),
                     [](const Pair& p, const Pair& q) { return p.two_bones > q.two_bones; });
    return found;
  }

  Vec3 pivot(int j) const { return pose_.pivot[at(j)]; }
  const Chain& longest(int j) const { return longest_[at(j)]; }

 private:
  static std::size_t at(int j) { return static_cast<std::size_t>(j); }
  double distance(int a, int b) const { return (pivot(a) - pivot(b)).norm(); }

  bool are_alike(int a, int b) const {
    const Chain &p = longest_[at(a)], &q = longest_[at(b)];
    return p.joints.size() == q.joints.size() && p.joints.size() >= 3 &&
           std::abs(p.length - q.length) < 0.1 * (p.length + q.length);
  }

  Pair pair(int a, int b) const {
    Pair out{longest_[at(a)], longest_[at(b)], rig_.joint(a).parent, 0, 0.0};
    for (std::size_t i = 0; i + 2 < out.a.joints.size(); ++i) {
      const double upper = distance(out.a.joints[i], out.a.joints[i + 1]);
      const double lower = distance(out.a.joints[i + 1], out.a.joints[i + 2]);
      if (std::min(upper, lower) < 0.4 * std::max(upper, lower)) continue;
      if (upper + lower <= out.two_bones) continue;
      out.two_bones = upper + lower;
      out.first = i;
    }
    return out;
  }

  const Skeleton& rig_;
  const JointTransforms& pose_;
  std::vector<Chain> longest_;  // from each joint down
};

void set_limb(const Chain& chain, std::size_t first, Side side, std::array<BodyPart, 3> names,
              PartJoints& parts) {
  for (std::size_t i = 0; i < names.size() && first + i < chain.joints.size(); ++i)
    joint_of(parts, names[i], side) = chain.joints[first + i];
}

// The body's left: from where the toes point, else it faces +z.
Vec3 left_of(const ShapeFinder& finder, const Pair& legs, const Vec3& up) {
  Vec3 toes = Vec3::Zero();
  for (const Chain& leg : {legs.a, legs.b})
    if (legs.first + 3 < leg.joints.size())
      toes += finder.pivot(leg.joints.back()) - finder.pivot(leg.joints[legs.first + 2]);
  toes -= up * toes.dot(up);
  if (toes.norm() > 0.1 * legs.two_bones) return up.cross(toes).normalized();
  return up.cross(Vec3::UnitZ());
}

bool is_unknown(const PartJoints& parts, BodyPart part) {
  const auto& sides = parts[static_cast<std::size_t>(part)];
  return sides[0] < 0 || sides[1] < 0;
}

// The chain that leaves the chest (or a joint below it) upwards and is no arm.
void find_head(const Skeleton& rig, const ShapeFinder& finder, const Pair& arms, const Vec3& up,
               PartJoints& parts) {
  double highest = 0.0;
  for (int j = arms.parent + 1; j < rig.num_joints(); ++j) {
    if (rig.joint(j).parent != arms.parent) continue;
    if (j == arms.a.joints.front() || j == arms.b.joints.front()) continue;
    const int tip = finder.longest(j).joints.back();
    const double height = (finder.pivot(tip) - finder.pivot(arms.parent)).dot(up);
    if (height <= highest) continue;
    highest = height;
    joint_of(parts, BodyPart::head, Side::middle) = tip;
  }
}

}  // namespace

int& joint_of(PartJoints& parts, BodyPart part, Side side) {
  return parts[static_cast<std::size_t>(part)][static_cast<std::size_t>(side)];
}

void find_parts_by_shape(const Skeleton& rig, const JointTransforms& pose, PartJoints& parts) {
  const bool is_headless = joint_of(parts, BodyPart::head, Side::middle) < 0;
  if (!is_headless && !is_unknown(parts, BodyPart::thigh) && !is_unknown(parts, BodyPart::shank) &&
      !is_unknown(parts, BodyPart::upper_arm) && !is_unknown(parts, BodyPart::forearm))
    return;
  const ShapeFinder finder(rig, pose);
  const auto pairs = finder.pairs();
  if (pairs.empty()) return;
  const Pair& legs = pairs.front();
  const auto arms = std::find_if(pairs.begin() + 1, pairs.end(), [&](const Pair& p) {
    return p.parent != legs.parent && p.two_bones > 0.4 * legs.two_bones;
  });
  if (arms == pairs.end()) return;
  const Vec3 trunk = finder.pivot(arms->parent) - finder.pivot(legs.parent);
  const Vec3 up = trunk.normalized();
  const Vec3 left = left_of(finder, legs, up);
  const auto fill = [&](const Pair& pair, std::array<BodyPart, 3> names) {
    if (!is_unknown(parts, names[0]) && !is_unknown(parts, names[1])) return;
    const Vec3 a_from_b =
        finder.pivot(pair.a.joints[pair.first]) - finder.pivot(pair.b.joints[pair.first]);
    const bool is_a_left = a_from_b.dot(left) > 0.0;
    set_limb(is_a_left ? pair.a : pair.b, pair.first, Side::left, names, parts);
    set_limb(is_a_left ? pair.b : pair.a, pair.first, Side::right, names, parts);
  };
  fill(legs, {BodyPart::thigh, BodyPart::shank, BodyPart::foot});
  fill(*arms, {BodyPart::upper_arm, BodyPart::forearm, BodyPart::hand});
  if (is_headless) find_head(rig, finder, *arms, up, parts);
}

}  // namespace sparse_mocap
