// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/virtual_sensor.hpp"

#include <algorithm>
#include <stdexcept>

#include "sparse_mocap/motion/extremities.hpp"
#include "sparse_mocap/sensors/filter.hpp"

namespace sparse_mocap {
namespace {

Eigen::Matrix3Xd low_passed(const Eigen::Matrix3Xd& positions, const std::vector<double>& times_s) {
  // Extending both ends in a straight line keeps the kernel from pulling them inwards, which would
  // read as an acceleration.
  const auto n = positions.cols();
  if (n < 3) return positions;
  const double frame_time_s = times_s[1] - times_s[0];
  const auto pad = static_cast<Eigen::Index>(kMarkerFilter.reach_s() / frame_time_s) + 1;
  Eigen::MatrixXd padded(3, n + 2 * pad);
  std::vector<double> padded_times;
  for (Eigen::Index i = -pad; i < n + pad; ++i) {
    padded_times.push_back(times_s[0] + static_cast<double>(i) * frame_time_s);
    const Eigen::Index inside = std::clamp<Eigen::Index>(i, 0, n - 1);
    Vec3 p = positions.col(inside);
    if (i < 0) p += static_cast<double>(-i) * (positions.col(0) - positions.col(1));
    if (i >= n) p += static_cast<double>(i - n + 1) * (positions.col(n - 1) - positions.col(n - 2));
    padded.col(i + pad) = p;
  }
  return filtered_at(padded_times, padded, times_s, kMarkerFilter);
}

struct CarriedPath {
  Eigen::Matrix3Xd pivot, end;
  std::vector<Mat3> R_world_sensor;
};

std::vector<CarriedPath> carried_paths(const Motion& motion, std::span<const Site> sites) {
  const auto n = motion.num_frames();
  std::vector<CarriedPath> paths(sites.size());
  for (auto& path : paths) {
    path.pivot.resize(3, n);
    path.end.resize(3, n);
  }
  for (int t = 0; t < n; ++t) {
    const JointTransforms at = motion.transforms(t);
    for (std::size_t s = 0; s < sites.size(); ++s) {
      const auto carrier = static_cast<std::size_t>(sites[s].carrier);
      paths[s].pivot.col(t) = at.pivot[carrier];
      paths[s].end.col(t) = at.end[carrier];
      paths[s].R_world_sensor.push_back(
          at.R_world_joint[static_cast<std::size_t>(sites[s].orientation)] *
          sites[s].R_joint_sensor);
    }
  }
  return paths;
}

}  // namespace

Eigen::Matrix3Xd specific_force_along(const Eigen::Matrix3Xd& position,
                                      const std::vector<Mat3>& R_world_sensor,
                                      double frame_time_s) {
  const auto n = position.cols();
  Eigen::Matrix3Xd out(3, n);
  for (Eigen::Index t = 0; t < n; ++t) {
    Vec3 acceleration = Vec3::Zero();
    if (n >= 3) {
      const auto c = std::clamp<Eigen::Index>(t, 1, n - 2);
      acceleration = (position.col(c + 1) - 2.0 * position.col(c) + position.col(c - 1)) /
                     (frame_time_s * frame_time_s);
    }
    out.col(t) = R_world_sensor[static_cast<std::size_t>(t)].transpose() *
                 (acceleration + kGravity_mps2 * kUp);
  }
  return out;
}

Eigen::Matrix3Xd angular_velocity_along(const std::vector<Mat3>& R_world_sensor,
                                        double frame_time_s) {
  const auto n = static_cast<Eigen::Index>(R_world_sensor.size());
  Eigen::Matrix3Xd out = Eigen::Matrix3Xd::Zero(3, n);
  for (Eigen::Index t = 0; t < n; ++t) {
    const auto before = std::max<Eigen::Index>(t - 1, 0);
    const auto after = std::min<Eigen::Index>(t + 1, n - 1);
    if (before == after) continue;
    const Eigen::AngleAxisd turn(Mat3(R_world_sensor[static_cast<std::size_t>(before)].transpose() *
                                      R_world_sensor[static_cast<std::size_t>(after)]));
    out.col(t) =
        turn.axis() * (turn.angle() / (static_cast<double>(after - before) * frame_time_s));
  }
  return out;
}

std::vector<VirtualReadings> virtual_readings(const Motion& standard_motion,
                                              std::span<const Site> sites) {
  if (!is_standard(without_extremities(standard_motion.skeleton)))
    throw std::invalid_argument("virtual_readings: the motion is not on a standard skeleton");
  const double dt = standard_motion.frame_time_s;
  std::vector<double> times_s;
  for (int t = 0; t < standard_motion.num_frames(); ++t) times_s.push_back(t * dt);
  std::vector<VirtualReadings> out;
  for (auto& path : carried_paths(standard_motion, sites)) {
    VirtualReadings readings;
    readings.specific_force_pivot =
        specific_force_along(low_passed(path.pivot, times_s), path.R_world_sensor, dt);
    readings.specific_force_end =
        specific_force_along(low_passed(path.end, times_s), path.R_world_sensor, dt);
    readings.angular_velocity = angular_velocity_along(path.R_world_sensor, dt);
    readings.gravity_direction.resize(3, standard_motion.num_frames());
    for (int t = 0; t < standard_motion.num_frames(); ++t)
      readings.gravity_direction.col(t) =
          path.R_world_sensor[static_cast<std::size_t>(t)].transpose() * kUp;
    readings.position_pivot = std::move(path.pivot);
    readings.position_end = std::move(path.end);
    readings.R_world_sensor = std::move(path.R_world_sensor);
    out.push_back(std::move(readings));
  }
  return out;
}

}  // namespace sparse_mocap
