// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/database_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/motion/contacts.hpp"
#include "sparse_mocap/motion/extremities.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/motion/standard_angles.hpp"
#include "sparse_mocap/sensors/filter.hpp"
#include "sparse_mocap/sensors/virtual_sensor.hpp"

namespace sparse_mocap {
namespace {

// rows x frames at the motion's rate to frames x rows at the database's.
DatabaseRows::Rows sampled(const Eigen::MatrixXd& values, const std::vector<double>& times_s,
                           const std::vector<double>& wanted_s) {
  return filtered_at(times_s, values, wanted_s, kReadingFilter).transpose().cast<float>();
}

void fill_readings(const Motion& motion, const std::vector<double>& wanted_s, DatabaseRows& rows) {
  std::vector<double> times_s;
  for (int t = 0; t < motion.num_frames(); ++t) times_s.push_back(t * motion.frame_time_s);
  const auto n = static_cast<Eigen::Index>(wanted_s.size());
  const auto columns = static_cast<Eigen::Index>(3 * all_sites().size());
  for (auto* target : {&rows.specific_force_pivot, &rows.specific_force_end, &rows.angular_velocity,
                       &rows.gravity_direction})
    target->resize(n, columns);
  const auto readings = virtual_readings(motion, all_sites());
  for (std::size_t s = 0; s < readings.size(); ++s) {
    const auto at = static_cast<Eigen::Index>(3 * s);
    const VirtualReadings& r = readings[s];
    rows.specific_force_pivot.middleCols(at, 3) =
        sampled(r.specific_force_pivot, times_s, wanted_s);
    rows.specific_force_end.middleCols(at, 3) = sampled(r.specific_force_end, times_s, wanted_s);
    rows.angular_velocity.middleCols(at, 3) = sampled(r.angular_velocity, times_s, wanted_s);
    rows.gravity_direction.middleCols(at, 3) =
        sampled(r.gravity_direction, times_s, wanted_s).rowwise().normalized();
  }
}

// The height of the floor: zero, as recordings have it, unless the ankles never come near it.
double floor_height(const std::vector<JointTransforms>& poses) {
  constexpr double kStandingAnkle_m = 0.08, kHighestStandingAnkle_m = 0.25;
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& pose : poses)
    for (const auto ankle : {standard_joint::ltibia, standard_joint::rtibia})
      lowest = std::min(lowest, pose.end[ankle].y());
  const bool is_on_the_floor = lowest >= 0.0 && lowest <= kHighestStandingAnkle_m;
  return is_on_the_floor ? 0.0 : lowest - kStandingAnkle_m;
}

// Root motion as rates in the heading frame (method: integrated by root_motion of tautges2011).
DatabaseRows::Rows root_motion_rows(const Motion& motion, const std::vector<double>& yaw) {
  using namespace root_motion_column;
  const int n = motion.num_frames();
  std::vector<JointTransforms> poses;
  for (int t = 0; t < n; ++t) poses.push_back(motion.transforms(t));
  const double floor = floor_height(poses);
  DatabaseRows::Rows rows(n, count);
  for (int t = 0; t < n; ++t) {
    const auto now = static_cast<std::size_t>(std::max(t, 1));
    const std::size_t before = now - 1;
    const Vec3 step = yaw_rotation(yaw[before]).transpose() *
                      (motion.root_positions[now] - motion.root_positions[before]) /
                      motion.frame_time_s;
    rows(t, velocity_left) = static_cast<float>(step.x());
    rows(t, velocity_forward) = static_cast<float>(step.z());
    rows(t, yaw_rate) = static_cast<float>((yaw[now] - yaw[before]) / motion.frame_time_s);
    rows(t, height) = static_cast<float>(poses[static_cast<std::size_t>(t)].end[0].y() - floor);
  }
  return rows;
}

// Rotation vectors of feet, toes and hands.
DatabaseRows::Rows extremity_rows(const Motion& motion) {
  DatabaseRows::Rows rows =
      DatabaseRows::Rows::Zero(motion.num_frames(), Eigen::Index{3 * kNumExtremities});
  if (!has_extremities(motion.skeleton)) return rows;
  for (int t = 0; t < motion.num_frames(); ++t)
    for (int e = 0; e < kNumExtremities; ++e)
      rows.row(t).segment<3>(3 * e) =
          rotation_vector(motion.rotation(t, extremity_joint(e))).transpose().cast<float>();
  return rows;
}

}  // namespace

DatabaseRows database_rows(const Motion& standard_motion, double rate_hz) {
  return database_rows(standard_motion, rate_hz, standard_motion);
}

DatabaseRows database_rows(const Motion& standard_motion, double rate_hz,
                           const Motion& worn_motion) {
  Motion motion = resampled(standard_motion, rate_hz);
  const auto yaw = headings(motion);
  DatabaseRows rows;
  rows.positions = joint_positions(motion, PositionFrame::heading)
                       .topRows(3 * kNumStandardJoints)
                       .transpose()
                       .cast<float>();
  rows.contacts = foot_contacts(motion).transpose().cast<float>();
  rows.root_motion = root_motion_rows(motion, yaw);
  std::vector<double> wanted_s;
  for (int t = 0; t < motion.num_frames(); ++t) {
    wanted_s.push_back(t / rate_hz);
    motion.rotation(t, 0) =
        Quat(yaw_rotation(yaw[static_cast<std::size_t>(t)])).conjugate() * motion.rotation(t, 0);
  }
  rows.angles = standard_angles(motion).transpose().cast<float>();
  rows.extremities = extremity_rows(motion);
  fill_readings(worn_motion, wanted_s, rows);
  return rows;
}

}  // namespace sparse_mocap
