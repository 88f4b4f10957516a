// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "sparse_mocap/motion/skeleton.hpp"

namespace sparse_mocap {

// A file may move a joint other than the root; this is its offset_parent (m) in every frame.
struct OffsetTrack {
  int joint = 0;
  std::vector<Vec3> offset_parent;
};

// What a skeleton does over time, sampled evenly.
//
// rotations holds R_joint of every joint, frame by frame; rotations instead of angles, so that a
// motion survives a change of skeleton, resampling and mirroring without Euler trouble.
struct Motion {
  Skeleton skeleton;
  double frame_time_s = 1.0 / 120.0;
  std::vector<Vec3> root_positions;        // pivot of the root, world, m; one a frame
  std::vector<Quat> rotations;             // [frame * num_joints + joint]
  std::vector<OffsetTrack> offset_tracks;  // empty for most files

  int num_frames() const { return static_cast<int>(root_positions.size()); }
  double duration_s() const { return frame_time_s * num_frames(); }
  const Quat& rotation(int frame, int joint) const;
  Quat& rotation(int frame, int joint);
  // The frame's joint transforms in the world.
  JointTransforms transforms(int frame) const;
};

// Frames [begin, end).
Motion trimmed(const Motion& motion, int begin, int end);

// The same movement played backwards.
Motion reversed(const Motion& motion);

// The movement seen in a mirror through the plane x = 0: left and right joints change places. The
// skeleton is mirrored too, so that mirrored(mirrored(m)) is m. left_right[j] is the joint on the
// other side of joint j (j itself in the middle); see left_right_pairs.
Motion mirrored(const Motion& motion, const std::vector<int>& left_right);

// For each joint the one whose name differs by left/right only ("lfemur" and "rfemur", "LeftArm"
// and "RightArm", "hand.L" and "hand.R"); itself where there is none.
std::vector<int> left_right_pairs(const Skeleton& skeleton);

// The motion sampled at a new rate: rotations by slerp, positions by interpolation, after a
// zero-phase Gaussian low-pass when the rate goes down, so that fast movements do not alias.
Motion resampled(const Motion& motion, double rate_hz);

}  // namespace sparse_mocap
