// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/humanoid_units.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace sparse_mocap {
namespace {

// Legs (thigh and shank) of people, m.
constexpr double kShortestLeg_m = 0.45, kLongestLeg_m = 1.25;

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

// The main axis of a direction as +-1..3, 0 when it lies between.
int main_axis(const Vec3& direction) {
  constexpr double kDecided = 0.7;
  Eigen::Index axis = 0;
  if (direction.cwiseAbs().maxCoeff(&axis) < kDecided) return 0;
  return static_cast<int>(axis + 1) * (direction[axis] > 0.0 ? 1 : -1);
}

// From the feet and from the pelvis to the neck: someone who sits has the feet in front.
Vec3 upward(const StandardPoints& points) {
  using namespace standard_joint;
  const Vec3 feet = 0.5 * (points.end[ltibia] + points.end[rtibia]);
  return (points.up.normalized() + (points.end[thorax] - feet).normalized()).normalized();
}

Vec3 mean_upward(const Motion& source, const SourceJoints& joints) {
  constexpr int kMostFrames = 100;
  const int step = std::max(1, source.num_frames() / kMostFrames);
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (int t = num_leading_rest_frames(source); t < source.num_frames(); t += step, ++count)
    sum += upward(standard_points(source.skeleton, joints, source.transforms(t)));
  return count > 0 ? Vec3(sum / count) : sum;
}

}  // namespace

// The factor that gives the legs a human length, 1 when they have one already.
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

// Lying down in a file with y up looks like standing in one with z up; the rest pose tells them
// apart. Where that is no pose the movement decides.
Mat3 guessed_world(const Motion& source, const SourceJoints& joints, const RestPosture& rest,
                   std::vector<std::string>& warnings) {
  constexpr int kY = 2;
  const int moving = main_axis(mean_upward(source, joints));
  const int resting =
      rest.is_at_zero ? main_axis(upward(standard_points(source.skeleton, joints, rest.transforms)))
                      : moving;
  if (moving == kY || resting == kY || resting == 0) return Mat3::Identity();
  if (moving != 0 && moving != resting) return Mat3::Identity();
  const Vec3 up = Vec3::Unit(std::abs(resting) - 1) * (resting > 0 ? 1.0 : -1.0);
  warnings.push_back(std::string("the body stands along ") + (resting > 0 ? "+" : "-") +
                     "xyz"[std::abs(resting) - 1] + ", which is taken as up");
  return smallest_rotation(up, kUp);
}

Motion with_sound_offsets(const Motion& source, int* num_dropped) {
  constexpr double kCollapsed = 0.02;
  Motion out = source;
  const auto is_collapsed = [&](const OffsetTrack& track) {
    const double rest = source.skeleton.joint(track.joint).offset_parent.norm();
    return std::all_of(track.offset_parent.begin(), track.offset_parent.end(),
                       [&](const Vec3& offset) { return offset.norm() < kCollapsed * rest; });
  };
  const auto dropped = std::erase_if(out.offset_tracks, is_collapsed);
  if (num_dropped != nullptr) *num_dropped = static_cast<int>(dropped);
  return out;
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

}  // namespace sparse_mocap
