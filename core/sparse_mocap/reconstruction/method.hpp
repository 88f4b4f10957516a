// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "sparse_mocap/base/progress.hpp"
#include "sparse_mocap/motion/motion.hpp"

namespace sparse_mocap {

// What all sensors read at one instant: 3 x sensors, sensor axes; NaN where one is silent.
using Reading = Eigen::Matrix3Xd;

// What a sensor reads: its specific force (m/s^2), or the direction against gravity (unit vector;
// see InclinationFilter). A device that tells both is two sensors.
enum class Quantity { specific_force, up };

// Where a sensor is worn: an index in all_sites, and how far along the carrying bone (0 at its
// pivot, 1 at its end).
struct WornSensor {
  int site = 0;
  double place = 1.0;
  Quantity quantity = Quantity::specific_force;
};

// One reconstructed frame.
struct PoseEstimate {
  Eigen::VectorXd angles;                              // 43, rad; the root's without heading
  Eigen::VectorXd positions;                           // 3 x 21, m, heading frame
  Vec3 root_position = Vec3::Zero();                   // m, world
  double yaw_rad = 0.0;                                // heading in the world
  Eigen::Vector2d contacts = Eigen::Vector2d::Zero();  // probability that left, right foot stand
  Eigen::VectorXd spread_m;            // 21: weighted deviation of the retrieved positions
  Eigen::VectorXd sensor_misfit_mps2;  // per sensor of specific force: measured against retrieved;
                                       // NaN when silent
  int clip = -1;                       // the clip leaned on most, and the frame in the database
  int database_frame = -1;
};

// A way from readings to full-body motion. One object serves one performance on one thread.
class Method {
 public:
  virtual ~Method() = default;

  // Takes the next reading, at the database's rate; gives the estimate of latency_frames() readings
  // ago, nothing until there is one.
  virtual std::optional<PoseEstimate> step(const Reading& reading) = 0;
  // The estimates still owed when the performance ends; the next step() starts anew.
  virtual std::vector<PoseEstimate> flush() = 0;
  virtual int latency_frames() const = 0;
  virtual void reset() = 0;
  // The whole take at once; every frame may look at all of it. Throws Cancelled.
  virtual std::vector<PoseEstimate> solve(const std::vector<Reading>& take,
                                          const Progress& progress) = 0;
};

// The take frame by frame through step() and flush(). Throws Cancelled.
std::vector<PoseEstimate> solve_online(Method& method, const std::vector<Reading>& take,
                                       const Progress& progress);

// The estimates as a motion in the world on the database's skeleton.
Motion to_motion(const std::vector<PoseEstimate>& estimates, const Skeleton& skeleton,
                 double rate_hz);

// The root's rotation in the world and the joints' relative ones.
std::vector<Quat> joint_rotations(const PoseEstimate& estimate, const Skeleton& skeleton);

}  // namespace sparse_mocap
