// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/body_joints.hpp"

#include <algorithm>
#include <limits>

#include "sparse_mocap/base/nearest_name.hpp"
#include "sparse_mocap/retargeting/body_joints_by_shape.hpp"
#include "sparse_mocap/retargeting/mapping_error.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;

constexpr std::array kSides{Side::left, Side::right};

struct Limb {
  BodyPart part;
  std::array<Index, 2> joint;  // left, right
};
constexpr std::array<Limb, 5> kLimbs{{{BodyPart::thigh, {lfemur, rfemur}},
                                      {BodyPart::shank, {ltibia, rtibia}},
                                      {BodyPart::upper_arm, {lhumerus, rhumerus}},
                                      {BodyPart::forearm, {lradius, rradius}},
                                      {BodyPart::hand, {lwrist, rwrist}}}};

PartJoints no_parts() {
  PartJoints parts;
  for (auto& sides : parts) sides.fill(-1);
  return parts;
}

bool is_below(const Skeleton& rig, int joint, int ancestor) {
  while (joint > ancestor) joint = rig.joint(joint).parent;
  return joint == ancestor;
}

bool is_named(const std::string& name, BodyPart part, Side side) {
  const auto parts = parts_named(name);
  return std::any_of(parts.begin(), parts.end(), [&](const NamedPart& named) {
    return named.part == part && named.side == side;
  });
}

// Rigs that have an ankle and a foot (SMPL, Kinect) call both by names of the foot: the shank ends
// at the upper one.
void raise_to_ankle(const Skeleton& rig, Side side, PartJoints& parts) {
  int& foot = joint_of(parts, BodyPart::foot, side);
  const int shank = joint_of(parts, BodyPart::shank, side);
  if (foot < 0 || shank < 0) return;
  for (const int joint : path_down(rig, shank, foot)) {
    if (!is_named(rig.joint(joint).name, BodyPart::foot, side)) continue;
    foot = joint;
    return;
  }
}

// The best named joint of each part; where a limb's upper part is known, its next part is one that
// hangs below ("LeftLeg" is a thigh's shank, never the thigh itself).
void find_parts_by_name(const Skeleton& rig, PartJoints& parts) {
  constexpr std::array kParents{
      -1, static_cast<int>(BodyPart::thigh),     static_cast<int>(BodyPart::shank),
      -1, static_cast<int>(BodyPart::upper_arm), static_cast<int>(BodyPart::forearm),
      -1};
  for (int p = 0; p < kNumBodyParts; ++p) {
    std::array<int, 3> best;
    best.fill(std::numeric_limits<int>::max());
    for (int j = 0; j < rig.num_joints(); ++j) {
      for (const auto& named : parts_named(rig.joint(j).name)) {
        const auto side = static_cast<std::size_t>(named.side);
        if (static_cast<int>(named.part) != p || named.rank >= best[side]) continue;
        const int parent_part = kParents[static_cast<std::size_t>(p)];
        const int parent =
            parent_part < 0 ? -1 : parts[static_cast<std::size_t>(parent_part)][side];
        if (parent >= 0 && (j == parent || !is_below(rig, j, parent))) continue;
        best[side] = named.rank;
        parts[static_cast<std::size_t>(p)][side] = j;
      }
    }
  }
  for (const Side side : kSides) raise_to_ankle(rig, side, parts);
}

BodyJoints joints_by_hand(const Skeleton& rig, const JointNames& by_hand) {
  BodyJoints found;
  found.standard.fill(-1);
  std::vector<std::string_view> rig_names;
  for (const auto& joint : rig.joints()) rig_names.push_back(joint.name);
  const auto& names = standard_joint_names();
  for (const auto& [standard, name] : by_hand) {
    if (!is_mapped_name(standard))
      throw MappingError("mapping by hand: '" + standard +
                         "' is not a standard joint, the nearest is '" +
                         nearest_standard_joint(standard) + "'");
    const int joint = rig.find(name);
    if (joint < 0)
      throw MappingError("mapping by hand: the skeleton has no joint '" + name +
                         "', the nearest is '" + std::string(nearest_name(name, rig_names)) + "'");
    const auto at = std::find(names.begin(), names.end(), standard);
    (at == names.end() ? found.ankle[standard == kAnkleNames[0] ? 0 : 1]
                       : found.standard[static_cast<std::size_t>(at - names.begin())]) = joint;
  }
  return found;
}

void require(const PartJoints& parts, int num_joints) {
  constexpr std::array kRequired{
      std::pair{BodyPart::thigh, "thigh"}, std::pair{BodyPart::shank, "shank"},
      std::pair{BodyPart::upper_arm, "upper arm"}, std::pair{BodyPart::forearm, "forearm"}};
  std::string missing;
  for (const auto& [part, name] : kRequired)
    for (const Side side : kSides)
      if (parts[static_cast<std::size_t>(part)][static_cast<std::size_t>(side)] < 0)
        missing += (missing.empty() ? "" : ", ") +
                   std::string(side == Side::left ? "left " : "right ") + name;
  if (!missing.empty())
    throw MappingError("not recognised as a human body: no joint found for " + missing +
                       " among the " + std::to_string(num_joints) + " joints");
}

// Spreads a chain of the rig's joints over three standard ones: first, middle and last.
void assign_chain(const std::vector<int>& chain, const std::array<Index, 3>& joints,
                  bool is_single_last, BodyJoints& found) {
  if (chain.empty()) return;
  const auto set = [&](Index joint, std::size_t at) {
    auto& slot = found.standard[joint];
    if (slot < 0) slot = chain[at];
  };
  if (chain.size() == 1) return set(joints[is_single_last ? 2 : 0], 0);
  set(joints[0], 0);
  if (chain.size() > 2) set(joints[1], chain.size() / 2);
  set(joints[2], chain.size() - 1);
}

// Pelvis, spine, neck and clavicles: what lies between the limbs.
void find_trunk(const Skeleton& rig, PartJoints& parts, BodyJoints& found) {
  const int pelvis = common_ancestor(rig, found.standard[lfemur], found.standard[rfemur]);
  const int chest = common_ancestor(rig, found.standard[lhumerus], found.standard[rhumerus]);
  if (found.standard[root] < 0) found.standard[root] = pelvis;
  const int below = common_ancestor(rig, found.standard[root], chest);
  assign_chain(path_down(rig, below, chest), {lowerback, upperback, thorax}, false, found);
  if (const int top = joint_of(parts, BodyPart::head, Side::middle); top >= 0) {
    const int neck_root = common_ancestor(rig, chest, top);
    assign_chain(path_down(rig, neck_root, top), {lowerneck, upperneck, head}, true, found);
  }
  for (const auto& [clavicle, humerus] :
       {std::pair{lclavicle, lhumerus}, std::pair{rclavicle, rhumerus}}) {
    const auto path = path_down(rig, chest, found.standard[humerus]);
    if (path.size() > 1 && found.standard[clavicle] < 0)
      found.standard[clavicle] = path[path.size() - 2];
  }
}

}  // namespace

bool is_mapped_name(const std::string& name) { return nearest_standard_joint(name) == name; }

std::string nearest_standard_joint(const std::string& name) {
  std::vector<std::string_view> known(kAnkleNames.begin(), kAnkleNames.end());
  known.insert(known.begin(), standard_joint_names().begin(), standard_joint_names().end());
  return std::string(nearest_name(name, known));
}

std::vector<int> path_down(const Skeleton& rig, int ancestor, int joint) {
  std::vector<int> path;
  for (; joint > ancestor; joint = rig.joint(joint).parent) path.push_back(joint);
  if (joint != ancestor) return {};
  std::reverse(path.begin(), path.end());
  return path;
}

int common_ancestor(const Skeleton& rig, int a, int b) {
  while (a != b && a >= 0 && b >= 0) (a > b ? a : b) = rig.joint(std::max(a, b)).parent;
  return std::min(a, b);
}

BodyJoints find_body_joints(const Skeleton& rig, const JointTransforms& pose,
                            const JointNames& by_hand) {
  BodyJoints found = joints_by_hand(rig, by_hand);
  PartJoints parts = no_parts();
  find_parts_by_name(rig, parts);
  for (const auto& limb : kLimbs)
    for (const Side side : kSides)
      if (const int given = found.standard[limb.joint[static_cast<std::size_t>(side)]]; given >= 0)
        joint_of(parts, limb.part, side) = given;
  for (const Side side : kSides)
    if (const int given = found.ankle[static_cast<std::size_t>(side)]; given >= 0)
      joint_of(parts, BodyPart::foot, side) = given;
  if (const int given = found.standard[head]; given >= 0)
    joint_of(parts, BodyPart::head, Side::middle) = given;
  const PartJoints named = parts;
  find_parts_by_shape(rig, pose, parts);
  found.is_by_names = std::all_of(kLimbs.begin(), kLimbs.end(), [&](const Limb& limb) {
    const auto part = static_cast<std::size_t>(limb.part);
    return parts[part] == named[part];
  });
  require(parts, rig.num_joints());
  for (const auto& limb : kLimbs)
    for (const Side side : kSides)
      found.standard[limb.joint[static_cast<std::size_t>(side)]] = joint_of(parts, limb.part, side);
  for (const Side side : kSides)
    found.ankle[static_cast<std::size_t>(side)] = joint_of(parts, BodyPart::foot, side);
  find_trunk(rig, parts, found);
  return found;
}

}  // namespace sparse_mocap
