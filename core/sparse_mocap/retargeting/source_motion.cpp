// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/source_motion.hpp"

#include <algorithm>

namespace sparse_mocap {
namespace {

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

}  // namespace

Motion without_collapsed_offsets(const Motion& source, int* num_dropped) {
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
