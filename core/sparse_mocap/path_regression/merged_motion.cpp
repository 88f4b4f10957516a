// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/merged_motion.hpp"

#include <utility>

#include "sparse_mocap/motion/heading.hpp"

namespace sparse_mocap::path_regression {

RootStep root_step(const FittedFrame& before, const FittedFrame& frame) {
  return {yaw_rotation(-before.yaw_rad) * (frame.root_position - before.root_position),
          frame.yaw_rad - before.yaw_rad};
}

FittedFrame after(const FittedFrame& before, const RootStep& root, FittedFrame frame) {
  const double height_m = frame.root_position.y();
  frame.yaw_rad = before.yaw_rad + root.turn_rad;
  frame.root_position = before.root_position + yaw_rotation(before.yaw_rad) * root.step_m;
  frame.root_position.y() = height_m;
  return frame;
}

JointRotations between(const JointRotations& a, const JointRotations& b, double share) {
  JointRotations out;
  for (std::size_t j = 0; j < a.size(); ++j)
    out.push_back(Quat(a[j]).slerp(share, Quat(b[j])).toRotationMatrix());
  return out;
}

std::vector<FittedFrame> merged(const std::vector<FittedFrame>& first,
                                const std::vector<OtherFrame>& others) {
  std::vector<FittedFrame> out;
  for (std::size_t t = 0; t < first.size(); ++t) {
    const OtherFrame& other = others[t];
    FittedFrame frame = first[t];
    RootStep root = t > 0 ? root_step(first[t - 1], first[t]) : RootStep();
    if (other.share > 0.0) {
      frame.rotations = between(frame.rotations, other.frame.rotations, other.share);
      frame.root_position.y() +=
          other.share * (other.frame.root_position.y() - frame.root_position.y());
      root.step_m += other.share * (other.root.step_m - root.step_m);
      root.turn_rad += other.share * (other.root.turn_rad - root.turn_rad);
    }
    out.push_back(t > 0 ? after(out.back(), root, std::move(frame)) : std::move(frame));
  }
  return out;
}

}  // namespace sparse_mocap::path_regression
