// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/units_and_axes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sparse_mocap/retargeting/mapping_error.hpp"
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

Vec3 mean_upward(const Motion& source, const BodyJoints& joints) {
  constexpr int kMostFrames = 100;
  const int step = std::max(1, source.num_frames() / kMostFrames);
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (int t = num_leading_rest_frames(source); t < source.num_frames(); t += step, ++count)
    sum += upward(bone_positions(source.skeleton, joints, source.transforms(t)));
  return count > 0 ? Vec3(sum / count) : sum;
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
  if (best == nullptr)
    throw MappingError("legs of " + std::to_string(leg_m) +
                       " m are not a human body's in any usual unit");
  warnings.push_back("legs of " + std::to_string(leg_m) + " m: the file's unit is taken as " +
                     best->name);
  return best_scale;
}

// Lying down in a file with y up looks like standing in one with z up; the rest pose shows
// which it is. Where that is no pose the movement decides.
Mat3 guessed_world(const Motion& source, const BodyJoints& joints, const RestPose& rest,
                   std::vector<std::string>& warnings) {
  constexpr int kY = 2;
  const int moving = main_axis(mean_upward(source, joints));
  const int resting =
      rest.is_at_zero ? main_axis(upward(bone_positions(source.skeleton, joints, rest.transforms)))
                      : moving;
  if (moving == kY || resting == kY || resting == 0) return Mat3::Identity();
  if (moving != 0 && moving != resting) return Mat3::Identity();
  const Vec3 up = Vec3::Unit(std::abs(resting) - 1) * (resting > 0 ? 1.0 : -1.0);
  warnings.push_back(std::string("the body stands along ") + (resting > 0 ? "+" : "-") +
                     "xyz"[std::abs(resting) - 1] + ", which is taken as up");
  return smallest_rotation(up, kUp);
}

}  // namespace sparse_mocap
