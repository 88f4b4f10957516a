// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/clip_motion.hpp"

#include <stdexcept>
#include <string>

#include "sparse_mocap/database/database_rows.hpp"
#include "sparse_mocap/motion/heading.hpp"

namespace sparse_mocap {

Motion clip_motion(const MotionDatabase& database, int clip_index) {
  const auto& clips = database.clips();
  if (clip_index < 0 || clip_index >= static_cast<int>(clips.size()))
    throw std::out_of_range("the database has " + std::to_string(clips.size()) + " clips");
  const Clip& clip = clips[static_cast<std::size_t>(clip_index)];
  Motion motion;
  motion.skeleton = database.skeleton();
  motion.frame_time_s = database.frame_time_s();
  Vec3 position = Vec3::Zero();
  double yaw_rad = 0.0;
  for (int frame = clip.begin; frame < clip.end; ++frame) {
    using namespace root_motion_column;
    const Eigen::RowVectorXd rates = database.root_motion().row(frame).cast<double>();
    if (frame > clip.begin) {
      position += yaw_rotation(yaw_rad) * Vec3(rates[velocity_left], 0.0, rates[velocity_forward]) *
                  motion.frame_time_s;
      yaw_rad += rates[yaw_rate] * motion.frame_time_s;
    }
    position.y() = rates[height];
    const Eigen::VectorXd angles = database.angles().row(frame).transpose().cast<double>();
    const auto rotations = pose_rotations(motion.skeleton, angles, yaw_rad);
    motion.root_positions.push_back(position);
    motion.rotations.insert(motion.rotations.end(), rotations.begin(), rotations.end());
  }
  return motion;
}

}  // namespace sparse_mocap
