// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sparse_mocap/motion/motion.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap {

// What a sensor at one site would read; 3 x frames each, in the sensor's axes
// unless said otherwise.
//
// A rigid bone makes the specific force linear in the position along it, so the two ends determine
// every position between them.
struct VirtualReadings {
  Eigen::Matrix3Xd specific_force_pivot;          // m/s^2, at the carrier's pivot (elbow, knee)
  Eigen::Matrix3Xd specific_force_end;            // m/s^2, at the carrier's end (wrist, ankle)
  Eigen::Matrix3Xd angular_velocity;              // rad/s
  Eigen::Matrix3Xd gravity_direction;             // unit, against gravity (up)
  Eigen::Matrix3Xd position_pivot, position_end;  // m, world
  std::vector<Mat3> R_world_sensor;

  // m/s^2 at a position along the carrier, 0 at its pivot, 1 at its end.
  Eigen::Matrix3Xd specific_force(double position_along_bone) const {
    return (1.0 - position_along_bone) * specific_force_pivot +
           position_along_bone * specific_force_end;
  }
  // m, world.
  Eigen::Matrix3Xd position(double position_along_bone) const {
    return (1.0 - position_along_bone) * position_pivot + position_along_bone * position_end;
  }
};

// Tautges et al. 2011, section 3: second time derivatives of the sensor's world positions, plus
// gravity, in the sensor's axes. Positions are low-passed by kMarkerFilter before they are
// differentiated. Computed at the motion's own rate; one entry for each site.
std::vector<VirtualReadings> virtual_readings(const Motion& standard_motion,
                                              std::span<const Site> sites);

// Specific force (m/s^2, sensor axes) of a sensor carried along a path: the one formula that
// virtual_readings applies. position is 3 x frames, m, world.
Eigen::Matrix3Xd specific_force_along(const Eigen::Matrix3Xd& position,
                                      const std::vector<Mat3>& R_world_sensor, double frame_time_s);

// Angular velocity (rad/s, sensor axes) by central differences.
Eigen::Matrix3Xd angular_velocity_along(const std::vector<Mat3>& R_world_sensor,
                                        double frame_time_s);

}  // namespace sparse_mocap
