// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sparse_mocap/liu2011/pose_calibration.hpp"
#include "sparse_mocap/motion/joint_rotations.hpp"

namespace sparse_mocap::liu2011 {

// The unknowns of equation (1), as they are solved for.
struct PoseUnknowns {
  BoneLengths lengths_m = BoneLengths::Zero();  // s
  double yaw_rad = 0.0;
  std::vector<Vec3> offset_m;           // a sensor: p_j, in the axes of the joint that it follows
  std::vector<Mat3> R_joint_sensor;     // a sensor: o_j
  std::vector<Vec3> place_m;            // a pose: the root's position
  std::vector<Eigen::VectorXd> missed;  // a pose: rad, a turn of each joint about each of its axes
};

// Where sensors are worn, and what is asked for and measured in each pose.
struct PoseProblem {
  const BoneLengthModel& lengths;
  const std::vector<Sensor>& sensors;
  std::span<const HeldPose> held;
  const PoseCalibrationSettings& settings;
};

// A start: mounting and heading that fit the shown poses best, in closed form.
PoseUnknowns first_unknowns(const PoseProblem& problem);

// Moves the unknowns to the nearest minimum, angles missing the shown poses by imitation_rad, and
// gives their covariance in the order of PoseUnknowns; rotations as turns about the sensor's axes.
Eigen::MatrixXd solve_poses(const PoseProblem& problem, double imitation_rad,
                            PoseUnknowns& unknowns);

// The joints' rotations in a pose as the performer held it.
JointRotations held_rotations(const JointRotations& shown, const Eigen::VectorXd& missed);

}  // namespace sparse_mocap::liu2011
