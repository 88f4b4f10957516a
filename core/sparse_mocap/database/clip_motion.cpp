// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/clip_motion.hpp"

#include <stdexcept>
#include <string>

#include "sparse_mocap/database/database_rows.hpp"
#include "sparse_mocap/motion/extremities.hpp"
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

namespace {

// R_parent_joint of a clip's foot, toes or hand in a row; relaxed where its file has none.
Quat extremity_rotation(const MotionDatabase& database, const Clip& clip, int row,
                        const Skeleton& skeleton, int e) {
  if (database.extremities().rows() == 0 || !clip.has_extremity[static_cast<std::size_t>(e)])
    return Quat(relaxed(skeleton, static_cast<extremity::Index>(e)));
  return rotation_of_vector(
      database.extremities().row(row).segment<3>(3 * e).transpose().cast<double>());
}

}  // namespace

Motion clip_motion_with_extremities(const MotionDatabase& database, int clip_index) {
  const Motion plain = clip_motion(database, clip_index);
  const Clip& clip = database.clips()[static_cast<std::size_t>(clip_index)];
  Motion motion;
  motion.skeleton = with_extremities(plain.skeleton);
  motion.frame_time_s = plain.frame_time_s;
  motion.root_positions = plain.root_positions;
  for (int t = 0; t < plain.num_frames(); ++t) {
    for (int j = 0; j < kNumStandardJoints; ++j) motion.rotations.push_back(plain.rotation(t, j));
    for (int e = 0; e < kNumExtremities; ++e)
      motion.rotations.push_back(
          extremity_rotation(database, clip, clip.begin + t, motion.skeleton, e));
  }
  return motion;
}

}  // namespace sparse_mocap
