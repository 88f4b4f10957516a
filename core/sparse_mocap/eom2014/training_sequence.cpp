// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/training_sequence.hpp"

#include <array>
#include <cmath>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/motion/contacts.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/motion/standard_angles.hpp"
#include "sparse_mocap/sensors/filter.hpp"
#include "sparse_mocap/sensors/virtual_sensor.hpp"

namespace sparse_mocap::eom2014 {
namespace {

constexpr int kFewestFrames = 8;
constexpr double kStandingAnkle_m = 0.08;  // above the floor

[[noreturn]] void refuse(const TrainingClip& clip, const std::string& problem) {
  throw ConfigError("the clip '" + clip.name + "' " + problem);
}

std::vector<double> frame_times(int num_frames, double rate_hz) {
  std::vector<double> times_s;
  for (int t = 0; t < num_frames; ++t) times_s.push_back(t / rate_hz);
  return times_s;
}

Eigen::MatrixXd pose_rows(Motion motion, const std::vector<double>& yaw_rad) {
  for (int t = 0; t < motion.num_frames(); ++t)
    motion.rotation(t, 0) =
        Quat(Eigen::AngleAxisd(-yaw_rad[static_cast<std::size_t>(t)], kUp)) * motion.rotation(t, 0);
  Eigen::MatrixXd poses(motion.num_frames(), kNumPoseChannels);
  poses.leftCols(kNumStandardAngles) = standard_angles(motion).transpose();
  for (int t = 0; t < motion.num_frames(); ++t)
    poses(t, kHeightChannel) = motion.root_positions[static_cast<std::size_t>(t)].y();
  return poses;
}

// The floor is under the lowest ankle, wherever the file has it.
void put_on_floor(const Motion& motion, Eigen::MatrixXd& poses) {
  double lowest = motion.transforms(0).end[standard_joint::ltibia].y();
  for (int t = 0; t < motion.num_frames(); ++t) {
    const JointTransforms at = motion.transforms(t);
    for (const auto ankle : {standard_joint::ltibia, standard_joint::rtibia})
      lowest = std::min(lowest, at.end[ankle].y());
  }
  poses.col(kHeightChannel).array() += kStandingAnkle_m - lowest;
}

Eigen::MatrixXd velocity_rows(const Motion& motion, const std::vector<double>& yaw_rad,
                              const Eigen::MatrixXd& poses) {
  const Eigen::Index num_steps = poses.rows() - 1;
  const double rate_hz = 1.0 / motion.frame_time_s;
  Eigen::MatrixXd velocities(num_steps, kNumVelocityChannels);
  velocities.leftCols(kNumPoseChannels) =
      rate_hz * (poses.bottomRows(num_steps) - poses.topRows(num_steps));
  for (Eigen::Index step = 0; step < num_steps; ++step) {
    const auto t = static_cast<std::size_t>(step);
    const Vec3 moved = yaw_rotation(yaw_rad[t]).transpose() *
                       (motion.root_positions[t + 1] - motion.root_positions[t]);
    velocities.row(step).tail<3>() =
        rate_hz * Eigen::RowVector3d(moved.x(), moved.z(), yaw_rad[t + 1] - yaw_rad[t]);
  }
  return velocities;
}

Eigen::MatrixXd simulated(const TrainingClip& clip, const SequenceSettings& settings) {
  const std::array sites{all_sites().at(static_cast<std::size_t>(settings.site))};
  const VirtualReadings readings = virtual_readings(clip.motion, sites).front();
  Eigen::MatrixXd values(6, clip.motion.num_frames());
  values << readings.specific_force(settings.position_along_bone), readings.angular_velocity;
  return values;
}

Eigen::MatrixXd recorded(const TrainingClip& clip, const SequenceSettings& settings) {
  Eigen::Index column = 0;
  const auto num_sensors = static_cast<Eigen::Index>(clip.sensors.size());
  while (column < num_sensors &&
         clip.sensors[static_cast<std::size_t>(column)].site != settings.site)
    ++column;
  if (column == num_sensors)
    refuse(clip, "was recorded without a sensor at " +
                     std::string(all_sites().at(static_cast<std::size_t>(settings.site)).name));
  const auto num_frames = std::min<Eigen::Index>(clip.motion.num_frames(),
                                                 static_cast<Eigen::Index>(clip.readings.size()));
  Eigen::MatrixXd values(6, num_frames);
  for (Eigen::Index t = 0; t < num_frames; ++t) {
    const Reading& reading = clip.readings[static_cast<std::size_t>(t)];
    values.col(t) << reading.specific_force.col(column), reading.angular_velocity.col(column);
  }
  if (!values.allFinite())
    refuse(clip, "was recorded with gaps, or without a gyroscope; leave its take out");
  return values;
}

ReadingRows reading_rows(const TrainingClip& clip, const SequenceSettings& settings,
                         int num_frames) {
  const Eigen::MatrixXd values =
      clip.readings.empty() ? simulated(clip, settings) : recorded(clip, settings);
  const auto times_s = frame_times(static_cast<int>(values.cols()), 1.0 / clip.motion.frame_time_s);
  const auto wanted_s = frame_times(num_frames, settings.rate_hz);
  return filtered_at(times_s, values, wanted_s, kReadingFilter).transpose();
}

// The same poses, by the angles that lie nearest to the first frame of the reference.
void unwind(const Skeleton& skeleton, const Eigen::MatrixXd& reference, Eigen::MatrixXd& poses) {
  Eigen::VectorXd last = reference.row(0).head(kNumStandardAngles);
  for (Eigen::Index t = 0; t < poses.rows(); ++t) {
    Eigen::VectorXd angles = poses.row(t).head(kNumStandardAngles);
    unwind_pose(skeleton, last, angles);
    poses.row(t).head(kNumStandardAngles) = angles;
    last = angles;
  }
}

// first: the sequence whose angles others lie near; null: it is this one.
TrainingSequence sequence_of(const TrainingClip& clip, const SequenceSettings& settings,
                             const TrainingSequence* first) {
  const Motion full = resampled(clip.motion, settings.rate_hz);
  const Motion motion = without_extremities(full);
  if (motion.num_frames() < kFewestFrames) refuse(clip, "is too short to learn from");
  const auto yaw_rad = headings(motion);
  TrainingSequence out;
  out.name = clip.name;
  out.poses = pose_rows(motion, yaw_rad);
  put_on_floor(motion, out.poses);
  if (first != nullptr) unwind(motion.skeleton, first->poses, out.poses);
  out.velocities = velocity_rows(motion, yaw_rad, out.poses);
  out.contacts = foot_contacts(motion);
  out.extremities = extremity_rows(full);
  out.readings = reading_rows(clip, settings, motion.num_frames());
  return out;
}

}  // namespace

std::vector<TrainingSequence> training_sequences(const std::vector<TrainingClip>& clips,
                                                 const SequenceSettings& settings) {
  std::vector<TrainingSequence> out;
  for (const auto& clip : clips)
    out.push_back(sequence_of(clip, settings, out.empty() ? nullptr : &out.front()));
  return out;
}

MotionData joined(const std::vector<TrainingSequence>& sequences) {
  Eigen::Index frames = 0;
  for (const auto& sequence : sequences) frames += sequence.poses.rows();
  MotionData data;
  data.poses.resize(frames, kNumPoseChannels);
  data.velocities.resize(frames - static_cast<Eigen::Index>(sequences.size()),
                         kNumVelocityChannels);
  Eigen::Index at = 0;
  for (const auto& sequence : sequences) {
    const Eigen::Index num_steps = sequence.velocities.rows();
    data.poses.middleRows(at, sequence.poses.rows()) = sequence.poses;
    data.velocities.middleRows(static_cast<Eigen::Index>(data.steps.size()), num_steps) =
        sequence.velocities;
    for (Eigen::Index t = 1; t < sequence.poses.rows(); ++t)
      data.steps.push_back(static_cast<int>(at + t));
    at += sequence.poses.rows();
  }
  return data;
}

}  // namespace sparse_mocap::eom2014
