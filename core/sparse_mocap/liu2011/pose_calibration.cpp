// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/pose_calibration.hpp"

#include <algorithm>
#include <cmath>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/liu2011/body_pose.hpp"
#include "sparse_mocap/liu2011/calibration_poses.hpp"
#include "sparse_mocap/liu2011/pose_problem.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::liu2011 {
namespace {

// What counts as determined: the deviation of a length, and its share of that before any pose was
// seen; of a sensor's place, and of its mounting.
constexpr double kLength_m = 0.015, kShareOfPrior = 0.7;
constexpr double kOffset_m = 0.03, kMounting_deg = 8.0;
constexpr double kLeastImitation_rad = 0.2 * kRadiansPerDegree;
// Poses are alike when each sensor's orientation is within this of its first.
constexpr double kAlike_rad = 20.0 * kRadiansPerDegree;

void check(const std::vector<Sensor>& sensors, std::span<const HeldPose> held) {
  if (sensors.empty()) throw ConfigError("there is no sensor to calibrate");
  if (held.empty()) throw ConfigError("a calibration needs a held pose at least");
  for (const HeldPose& pose : held) {
    const std::string name(calibration_poses().at(static_cast<std::size_t>(pose.pose)).name);
    if (pose.sensors.size() != sensors.size())
      throw ConfigError("the pose " + name + " has another number of sensors");
    if (std::none_of(pose.sensors.begin(), pose.sensors.end(), [](const HeldSensor& sensor) {
          return sensor.has_position || sensor.has_orientation;
        }))
      throw ConfigError("no tracker says where it was during the pose " + name);
  }
}

// How far angles miss the shown poses: where they are now, and how unsure that is.
double imitation_of(const PoseUnknowns& x, const Eigen::MatrixXd& covariance) {
  double squares = 0.0;
  Eigen::Index count = 0;
  for (const auto& missed : x.missed) squares += missed.squaredNorm(), count += missed.size();
  squares += covariance.diagonal().tail(count).sum();
  return std::max(kLeastImitation_rad, std::sqrt(squares / static_cast<double>(count)));
}

double missed_deg(const PoseProblem& problem, std::size_t i, const Eigen::VectorXd& missed) {
  const auto& shown = calibration_poses()[static_cast<std::size_t>(problem.held[i].pose)].rotations;
  const Skeleton skeleton = make_standard_skeleton(template_bones());
  JointTransforms asked, held;
  forward_kinematics(skeleton, Vec3::Zero(), shown, asked);
  forward_kinematics(skeleton, Vec3::Zero(), held_rotations(shown, missed), held);
  double squares = 0.0;
  for (const Sensor& sensor : problem.sensors) {
    const auto joint =
        static_cast<std::size_t>(all_sites()[static_cast<std::size_t>(sensor.site)].orientation);
    const Mat3 between = asked.R_world_joint[joint].transpose() * held.R_world_joint[joint];
    squares += logarithm(between).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(problem.sensors.size())) / kRadiansPerDegree;
}

// Whether all rotations are within kAlike_rad of the first.
bool are_alike(const std::vector<Mat3>& rotations) {
  return std::all_of(rotations.begin(), rotations.end(), [&](const Mat3& R) {
    return logarithm(rotations.front().transpose() * R).norm() <= kAlike_rad;
  });
}

// Whether every limb with a sensor is asked to be, or is measured, about the same way up all the
// time.
bool are_poses_alike(const PoseProblem& problem) {
  const Skeleton skeleton = make_standard_skeleton(template_bones());
  std::vector<JointTransforms> shown(problem.held.size());
  for (std::size_t i = 0; i < shown.size(); ++i)
    forward_kinematics(
        skeleton, Vec3::Zero(),
        calibration_poses()[static_cast<std::size_t>(problem.held[i].pose)].rotations, shown[i]);
  bool is_asked_alike = true, is_held_alike = true;
  for (std::size_t j = 0; j < problem.sensors.size(); ++j) {
    const auto joint = static_cast<std::size_t>(
        all_sites()[static_cast<std::size_t>(problem.sensors[j].site)].orientation);
    std::vector<Mat3> asked, held;
    for (std::size_t i = 0; i < shown.size(); ++i) {
      asked.push_back(shown[i].R_world_joint[joint]);
      if (problem.held[i].sensors[j].has_orientation)
        held.push_back(problem.held[i].sensors[j].R_world_sensor);
    }
    is_asked_alike = is_asked_alike && are_alike(asked);
    is_held_alike = is_held_alike && are_alike(held);
  }
  return is_asked_alike || is_held_alike;
}

CalibratedSensor calibrated(const Sensor& sensor, const PoseUnknowns& x, std::size_t j,
                            const Eigen::MatrixXd& covariance) {
  const auto n = static_cast<Eigen::Index>(x.offset_m.size());
  const Eigen::Index offset = kNumBoneLengths + 1 + 3 * static_cast<Eigen::Index>(j);
  const Mat3 R_site_joint =
      all_sites()[static_cast<std::size_t>(sensor.site)].R_joint_sensor.transpose();
  CalibratedSensor out;
  out.R_site_sensor = R_site_joint * x.R_joint_sensor[j];
  out.offset_m = R_site_joint * x.offset_m[j];
  const Mat3 about_joint = covariance.block<3, 3>(offset, offset);
  out.offset_deviation_m =
      (R_site_joint * about_joint * R_site_joint.transpose()).diagonal().cwiseSqrt();
  out.mounting_deviation_deg =
      std::sqrt(covariance.diagonal().segment<3>(offset + 3 * n).maxCoeff()) / kRadiansPerDegree;
  out.is_mounting_determined = out.mounting_deviation_deg <= kMounting_deg;
  out.is_offset_determined = out.offset_deviation_m.maxCoeff() <= kOffset_m;
  return out;
}

}  // namespace

PoseCalibration calibrated_from_poses(const BoneLengthModel& lengths,
                                      const std::vector<Sensor>& sensors,
                                      std::span<const HeldPose> held,
                                      const PoseCalibrationSettings& settings) {
  check(sensors, held);
  const PoseProblem problem{lengths, sensors, held, settings};
  PoseUnknowns x = first_unknowns(problem);
  double imitation_rad = settings.imitation_deg * kRadiansPerDegree;
  Eigen::MatrixXd covariance = solve_poses(problem, imitation_rad, x);
  for (int round = 0; round < settings.rounds; ++round) {
    imitation_rad = imitation_of(x, covariance);
    covariance = solve_poses(problem, imitation_rad, x);
  }
  PoseCalibration out;
  out.bones = bones_of_lengths(x.lengths_m);
  out.deviation_m = covariance.diagonal().head<kNumBoneLengths>().cwiseSqrt();
  const Eigen::VectorXd before = lengths.covariance().diagonal().cwiseSqrt();
  for (Eigen::Index b = 0; b < kNumBoneLengths; ++b)
    out.is_determined[static_cast<std::size_t>(b)] =
        out.deviation_m[b] <= std::min(kLength_m, kShareOfPrior * before[b]);
  for (std::size_t j = 0; j < sensors.size(); ++j)
    out.sensors.push_back(calibrated(sensors[j], x, j, covariance));
  for (std::size_t i = 0; i < held.size(); ++i)
    out.missed_deg.push_back(missed_deg(problem, i, x.missed[i]));
  out.imitation_deg = imitation_rad / kRadiansPerDegree;
  out.yaw_rad = x.yaw_rad;
  out.are_poses_alike = are_poses_alike(problem);
  return out;
}

}  // namespace sparse_mocap::liu2011
