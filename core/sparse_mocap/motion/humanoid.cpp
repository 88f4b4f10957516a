// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/humanoid.hpp"

#include <algorithm>
#include <cmath>

#include "sparse_mocap/motion/humanoid_names.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;

constexpr std::array kRequired{root,     lfemur,  ltibia,   rfemur, rtibia,
                               lhumerus, lradius, rhumerus, rradius};
// Limbs, whose rest direction differs between a T-pose and an A-pose.
constexpr std::array kLimbs{lfemur,  ltibia, rfemur,   rtibia,  lhumerus,
                            lradius, lwrist, rhumerus, rradius, rwrist};
// Chains of the trunk, along which exporters have more or fewer joints.
constexpr std::array kSpine{lowerback, upperback, thorax};
constexpr std::array kNeck{lowerneck, upperneck, head};

// Below this a limb's rest direction is how the actor was measured, above it how the pose is meant.
constexpr double kPoseConvention_rad = 10.0 * kRadiansPerDegree;
// Legs (thigh and shank) of people, m.
constexpr double kShortestLeg_m = 0.45, kLongestLeg_m = 1.25;
constexpr double kNoBone_m = 1e-3;

int find_by_names(const Skeleton& source, Index joint) {
  std::vector<std::string> normalised;
  for (const auto& j : source.joints()) normalised.push_back(normalised_joint_name(j.name));
  for (const auto name : known_names(joint)) {
    const auto at = std::find(normalised.begin(), normalised.end(), name);
    if (at != normalised.end()) return static_cast<int>(at - normalised.begin());
  }
  return -1;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::array<int, kNumStandardJoints> find_joints(const Skeleton& source) {
  std::array<int, kNumStandardJoints> found;
  for (int j = 0; j < kNumStandardJoints; ++j)
    found[static_cast<std::size_t>(j)] = find_by_names(source, static_cast<Index>(j));
  std::vector<std::string> missing;
  for (const auto j : kRequired)
    if (found[j] < 0) missing.emplace_back(standard_joint_names()[j]);
  if (!missing.empty()) {
    throw MappingError("not recognised as a human body: no joint found for " + listed(missing) +
                       " among the " + std::to_string(source.num_joints()) + " joints");
  }
  return found;
}

// Where a joint's bone ends when no mapped joint follows: its own bone, else its first child.
Vec3 last_end(const Skeleton& source, const JointTransforms& rest, int joint) {
  const auto at = static_cast<std::size_t>(joint);
  if (source.joint(joint).bone.norm() > 0.0) return rest.end[at];
  for (int c = 0; c < source.num_joints(); ++c)
    if (source.joint(c).parent == joint) return rest.pivot[static_cast<std::size_t>(c)];
  return rest.end[at];
}

class RestBones {
 public:
  RestBones(const Skeleton& source, const std::array<int, kNumStandardJoints>& found)
      : source_(source), found_(found), rest_(rest_pose(source)) {}

  StandardBones measure() {
    bones_.fill(Vec3::Zero());
    for (const auto& [hip, femur, tibia] :
         {std::array{lhipjoint, lfemur, ltibia}, std::array{rhipjoint, rfemur, rtibia}}) {
      bones_[hip] = pivot(femur) - pivot(root);
      bones_[femur] = pivot(tibia) - pivot(femur);
      bones_[tibia] = end(tibia) - pivot(tibia);
    }
    const Vec3 chest = chain(kSpine, pivot(root), neck_base());
    if (found_[head] >= 0 || found_[lowerneck] >= 0) chain(kNeck, chest, head_top());
    for (const auto& [clavicle, humerus, radius, wrist] :
         {std::array{lclavicle, lhumerus, lradius, lwrist},
          std::array{rclavicle, rhumerus, rradius, rwrist}}) {
      bones_[clavicle] = pivot(humerus) - chest;
      bones_[humerus] = pivot(radius) - pivot(humerus);
      bones_[radius] = (found_[wrist] >= 0 ? pivot(wrist) : end(radius)) - pivot(radius);
      if (found_[wrist] >= 0) bones_[wrist] = end(wrist) - pivot(wrist);
    }
    return bones_;
  }

 private:
  Vec3 pivot(Index j) const {
    return rest_.pivot[static_cast<std::size_t>(found_[static_cast<std::size_t>(j)])];
  }
  Vec3 end(Index j) const { return last_end(source_, rest_, found_[static_cast<std::size_t>(j)]); }
  Vec3 neck_base() const {
    if (found_[lowerneck] >= 0) return pivot(lowerneck);
    if (found_[head] >= 0) return pivot(head);
    return 0.5 * (pivot(lhumerus) + pivot(rhumerus));
  }
  Vec3 head_top() const { return found_[head] >= 0 ? end(head) : end(lowerneck); }

  // Shares the way from begin to end among three standard joints: a joint that the source has
  // starts at its pivot, those it lacks take equal parts of the stretch they lie in. Returns end.
  Vec3 chain(const std::array<Index, 3>& joints, const Vec3& begin, const Vec3& end_point) {
    std::array<Vec3, 4> knots;
    std::array<bool, 4> known{true, false, false, true};
    knots[0] = begin;
    knots[3] = end_point;
    for (std::size_t i = 1; i < 3; ++i) {
      known[i] = found_[joints[i]] >= 0;
      if (known[i]) knots[i] = pivot(joints[i]);
    }
    for (std::size_t i = 1; i < 3; ++i) {
      if (known[i]) continue;
      std::size_t next = i;
      while (!known[next]) ++next;
      knots[i] = knots[i - 1] + (knots[next] - knots[i - 1]) / static_cast<double>(next - i + 1);
      known[i] = true;
    }
    for (std::size_t i = 0; i < 3; ++i) bones_[joints[i]] = knots[i + 1] - knots[i];
    return end_point;
  }

  const Skeleton& source_;
  const std::array<int, kNumStandardJoints>& found_;
  JointTransforms rest_;
  StandardBones bones_{};
};

// The factor that gives the legs a human length, 1 when they have one already.
double guessed_unit_scale(double leg, std::vector<std::string>& warnings) {
  if (leg >= kShortestLeg_m && leg <= kLongestLeg_m) return 1.0;
  struct Unit {
    const char* name;
    double scale_from_cm;
  };
  for (const Unit unit : {Unit{"1/0.45 inch (Acclaim)", 2.54 / 0.45}, Unit{"m", 100.0},
                          Unit{"inch", 2.54}, Unit{"mm", 0.1}, Unit{"dm", 10.0}}) {
    for (const double scale : {unit.scale_from_cm, 0.01 * unit.scale_from_cm}) {
      const double scaled = leg * scale;
      if (scaled < kShortestLeg_m || scaled > kLongestLeg_m) continue;
      warnings.push_back("legs of " + std::to_string(leg) + " m: the file's unit is taken as " +
                         unit.name);
      return scale;
    }
  }
  throw MappingError("legs of " + std::to_string(leg) +
                     " m are not a human body's in any usual unit");
}

// The smallest rotation that turns one direction into another.
Mat3 smallest_rotation(const Vec3& from, const Vec3& to) {
  return Quat::FromTwoVectors(from, to).toRotationMatrix();
}

void align_limbs(HumanoidMapping& mapping) {
  mapping.R_source_standard.fill(Mat3::Identity());
  for (const auto j : kLimbs) {
    const Vec3& source = mapping.bones[j];
    const Vec3& standard = template_bones()[j];
    if (source.norm() < kNoBone_m) continue;
    const double cosine = source.normalized().dot(standard.normalized());
    if (std::acos(std::clamp(cosine, -1.0, 1.0)) < kPoseConvention_rad) continue;
    mapping.R_source_standard[j] = smallest_rotation(standard, source);
    mapping.bones[j] = mapping.R_source_standard[j].transpose() * source;
  }
}

// Exporters write some bones without a length; the template's is scaled to the body.
void fill_missing_bones(HumanoidMapping& mapping) {
  const double scale = leg_length_m(mapping.bones) / leg_length_m(template_bones());
  for (std::size_t j = 1; j < mapping.bones.size(); ++j)
    if (mapping.bones[j].norm() < kNoBone_m) mapping.bones[j] = scale * template_bones()[j];
}

// The largest turn of a joint from a frame to the next.
double turn_after(const Motion& motion, int frame) {
  double largest = 0.0;
  for (int j = 0; j < motion.skeleton.num_joints(); ++j)
    largest =
        std::max(largest, motion.rotation(frame, j).angularDistance(motion.rotation(frame + 1, j)));
  return largest;
}

bool is_at_rest(const Motion& motion, int frame) {
  constexpr double kAtRest_rad = 1e-3;
  for (int j = 0; j < motion.skeleton.num_joints(); ++j)
    if (Eigen::AngleAxisd(motion.rotation(frame, j)).angle() > kAtRest_rad) return false;
  return true;
}

// How many frames stand before the movement: exporters put a rest pose or a T-pose there. From a
// T-pose the arms fall by a right angle within one frame, and the next frames move far less.
int num_leading_rest_frames(const Motion& motion) {
  constexpr int kLongestLead = 3;
  constexpr double kMoved_rad = 0.2, kFallen_rad = 1.0, kCalmer = 2.5;
  int leading = 0;
  for (int t = 0; t < kLongestLead && t + 2 < motion.num_frames(); ++t) {
    const double turn = turn_after(motion, t);
    const bool is_rest = t == 0 && turn > kMoved_rad && is_at_rest(motion, 0);
    if (is_rest || (turn > kFallen_rad && turn > kCalmer * turn_after(motion, t + 1)))
      leading = t + 1;
  }
  return leading;
}

// One frame's local rotations on the standard skeleton.
void carry_over(const JointTransforms& source, const HumanoidMapping& mapping,
                const Skeleton& standard, std::vector<double>& angles, std::vector<Quat>& out) {
  std::array<Mat3, kNumStandardJoints> R_world;
  for (int j = 0; j < kNumStandardJoints; ++j) {
    const auto at = static_cast<std::size_t>(j);
    const Joint& joint = standard.joint(j);
    const Mat3 R_world_parent =
        j == 0 ? Mat3::Identity() : R_world[static_cast<std::size_t>(joint.parent)];
    Mat3 R_joint = Mat3::Identity();
    if (const int s = mapping.source_joint[at]; s >= 0) {
      const Mat3 wanted =
          source.R_world_joint[static_cast<std::size_t>(s)] * mapping.R_source_standard[at];
      double* joint_angle = angles.data() + standard.angle_begin(j);
      joint_angles(joint, R_world_parent.transpose() * wanted, joint_angle, joint_angle);
      R_joint = joint_rotation(joint, joint_angle);
    }
    R_world[at] = R_world_parent * R_joint;
    out.emplace_back(R_joint);
  }
}

}  // namespace

HumanoidMapping map_humanoid(const Skeleton& source) {
  HumanoidMapping mapping;
  mapping.source_joint = find_joints(source);
  mapping.bones = RestBones(source, mapping.source_joint).measure();
  mapping.unit_scale = guessed_unit_scale(leg_length_m(mapping.bones), mapping.warnings);
  for (auto& bone : mapping.bones) bone *= mapping.unit_scale;
  align_limbs(mapping);
  fill_missing_bones(mapping);
  return mapping;
}

Motion to_standard(const Motion& source, const HumanoidMapping& mapping, const Skeleton& standard,
                   std::vector<std::string>* warnings) {
  const double leg_ratio = leg_length_m(bones_of(standard)) / leg_length_m(mapping.bones);
  const auto root_joint = static_cast<std::size_t>(mapping.source_joint[root]);
  Motion out;
  out.skeleton = standard;
  out.frame_time_s = source.frame_time_s;
  const int begin = num_leading_rest_frames(source);
  if (begin > 0 && warnings != nullptr)
    warnings->push_back("a leading rest pose was dropped, frames: " + std::to_string(begin));
  std::vector<double> angles(kNumStandardAngles, 0.0);
  for (int t = begin; t < source.num_frames(); ++t) {
    const JointTransforms transforms = source.transforms(t);
    out.root_positions.push_back(mapping.unit_scale * leg_ratio * transforms.pivot[root_joint]);
    carry_over(transforms, mapping, standard, angles, out.rotations);
  }
  return out;
}

Eigen::MatrixXd standard_angles(const Motion& motion) {
  Eigen::MatrixXd angles = Eigen::MatrixXd::Zero(kNumStandardAngles, motion.num_frames());
  for (int t = 0; t < motion.num_frames(); ++t) {
    for (int j = 0; j < kNumStandardJoints; ++j) {
      const int begin = motion.skeleton.angle_begin(j);
      const double* reference = t > 0 ? &angles(begin, t - 1) : nullptr;
      joint_angles(motion.skeleton.joint(j), motion.rotation(t, j).toRotationMatrix(), reference,
                   &angles(begin, t));
    }
  }
  return angles;
}

}  // namespace sparse_mocap
