// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/units_and_axes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "sparse_mocap/retargeting/rest_alignment.hpp"
#include "sparse_mocap/retargeting/source_motion.hpp"

namespace sparse_mocap {
namespace {

// Legs (thigh and shank) of people, m.
constexpr double kShortestLeg_m = 0.45, kLongestLeg_m = 1.25;

// The main axis of a direction as +-1..3, 0 when it lies between.
int main_axis(const Vec3& direction) {
  constexpr double kDecided = 0.7;
  Eigen::Index axis = 0;
  if (direction.cwiseAbs().maxCoeff(&axis) < kDecided) return 0;
  return static_cast<int>(axis + 1) * (direction[axis] > 0.0 ? 1 : -1);
}

// From the feet and from the pelvis to the neck: someone who sits has the feet in front.
Vec3 upward(const BonePositions& bones) {
  using namespace standard_joint;
  const Vec3 feet = 0.5 * (bones.end[ltibia] + bones.end[rtibia]);
  return (bones.up.normalized() + (bones.end[thorax] - feet).normalized()).normalized();
}

// Frames throughout a motion, without a pose that exporters put before it.
std::vector<int> some_frames(const Motion& source) {
  constexpr int kMostFrames = 100;
  const int step = std::max(1, source.num_frames() / kMostFrames);
  std::vector<int> frames;
  for (int t = num_leading_rest_frames(source); t < source.num_frames(); t += step)
    frames.push_back(t);
  return frames;
}

// How a motion's body lies along an axis (file's units), each frame's median.
struct AlongAxis {
  double lowest = 0.0;  // of all joints
  double pelvis = 0.0;
};

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

AlongAxis along_axis(const Motion& source, const BodyJoints& joints, const Vec3& axis) {
  std::vector<double> lowest, pelvis;
  for (const int t : some_frames(source)) {
    const JointTransforms pose = source.transforms(t);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& point : pose.pivot) least = std::min(least, point.dot(axis));
    lowest.push_back(least);
    pelvis.push_back(
        pose.pivot[static_cast<std::size_t>(joints.standard[standard_joint::root])].dot(axis));
  }
  return {median(lowest), median(pelvis)};
}

// Whether a figure that is upright along another axis than y stands in a file whose root carries
// the turn of the axes, rather than lies or hangs on its head: its feet are on that axis's floor,
// and it does not lie on that of y.
bool is_turned_by_root(const Motion& source, const BodyJoints& joints, const RestPose& rest,
                       const Vec3& up) {
  const BonePositions bones = bone_positions(source.skeleton, joints, rest.transforms);
  const double leg =
      bones.vector(standard_joint::lfemur).norm() + bones.vector(standard_joint::ltibia).norm();
  const AlongAxis standing = along_axis(source, joints, up);
  const AlongAxis lying = along_axis(source, joints, kUp);
  const bool is_on_its_floor =
      std::abs(standing.lowest) < 0.3 * leg && standing.pelvis - standing.lowest > 0.75 * leg;
  const bool lies_on_the_ground =
      std::abs(lying.lowest) < 0.15 * leg && lying.pelvis > 0.05 * leg && lying.pelvis < 0.6 * leg;
  return is_on_its_floor && !lies_on_the_ground;
}

Vec3 mean_upward(const Motion& source, const BodyJoints& joints) {
  const auto frames = some_frames(source);
  Vec3 sum = Vec3::Zero();
  for (const int t : frames)
    sum += upward(bone_positions(source.skeleton, joints, source.transforms(t)));
  return frames.empty() ? sum : Vec3(sum / static_cast<double>(frames.size()));
}

}  // namespace

double guessed_unit_scale(double leg_m, std::vector<std::string>& warnings) {
  if (leg_m >= kShortestLeg_m && leg_m <= kLongestLeg_m) return 1.0;
  constexpr double kUsualLeg_m = 0.85;
  struct Unit {
    const char* name;
    double scale_from_cm;
  };
  const Unit* best = nullptr;
  double best_scale = 1.0, nearest = std::numeric_limits<double>::infinity();
  static constexpr std::array kUnits{Unit{"1/0.45 inch (Acclaim)", 2.54 / 0.45},
                                     Unit{"m", 100.0},
                                     Unit{"inch", 2.54},
                                     Unit{"mm", 0.1},
                                     Unit{"dm", 10.0},
                                     Unit{"feet", 30.48},
                                     Unit{"cm where inches are usual", 1.0 / 2.54}};
  for (const Unit& unit : kUnits) {
    for (const double scale : {unit.scale_from_cm, 0.01 * unit.scale_from_cm}) {
      const double scaled = leg_m * scale;
      const double distance = std::abs(std::log(scaled / kUsualLeg_m));
      if (scaled < kShortestLeg_m || scaled > kLongestLeg_m || distance >= nearest) continue;
      nearest = distance;
      best = &unit;
      best_scale = scale;
    }
  }
  if (best == nullptr) {
    warnings.push_back("legs of " + std::to_string(leg_m) +
                       " m are no person's in any usual unit: the figure is scaled to legs of " +
                       std::to_string(kUsualLeg_m) + " m");
    return kUsualLeg_m / leg_m;
  }
  warnings.push_back("legs of " + std::to_string(leg_m) + " m: the file's unit is taken as " +
                     best->name);
  return best_scale;
}

// Lying down in a file with y up looks like standing in one with z up; the rest pose shows
// which it is, or else where the floor is. Where the rest is no pose the movement decides.
Mat3 guessed_world(const Motion& source, const BodyJoints& joints, const RestPose& rest,
                   std::vector<std::string>& warnings) {
  constexpr int kY = 2;
  const int moving = main_axis(mean_upward(source, joints));
  const int resting =
      rest.is_at_zero ? main_axis(upward(bone_positions(source.skeleton, joints, rest.transforms)))
                      : moving;
  const auto direction = [](int axis) {
    return Vec3(Vec3::Unit(std::abs(axis) - 1) * (axis > 0 ? 1.0 : -1.0));
  };
  int up = resting;
  if (moving == kY || resting == 0) return Mat3::Identity();
  if (moving != 0 && moving != resting) {
    if (!is_turned_by_root(source, joints, rest, direction(moving))) return Mat3::Identity();
    up = moving;
  }
  if (up == kY) return Mat3::Identity();
  warnings.push_back(std::string("the body stands along ") + (up > 0 ? "+" : "-") +
                     "xyz"[std::abs(up) - 1] + ", which is taken as up");
  return smallest_rotation(direction(up), kUp);
}

}  // namespace sparse_mocap
