// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sparse_mocap/liu2011/bone_lengths.hpp"
#include "sparse_mocap/readings/reading.hpp"

namespace sparse_mocap::liu2011 {

// What a tracker said while the performer held a pose, in the tracker's world.
struct HeldSensor {
  bool has_position = false, has_orientation = false;
  Vec3 position = Vec3::Zero();            // m, t_i^j of equation (1)
  Mat3 R_world_sensor = Mat3::Identity();  // r_i^j
};
struct HeldPose {
  int pose = 0;                     // index in calibration_poses()
  std::vector<HeldSensor> sensors;  // in the order of the calibration's
};

struct PoseCalibrationSettings {
  double position_m = 0.005;     // deviation of a held position: of the tracker, and of breathing
  double orientation_deg = 1.0;  // and of a held orientation
  double imitation_deg = 5.0;    // how far each angle misses the shown pose, to begin with
  double offset_m = 0.08;        // how far from its site's place a sensor may be strapped
  int rounds = 4;                // of estimating how well the poses are imitated
};

// Where a sensor sits: z of section 6.1, as what differs from an ideal sensor at its site.
struct CalibratedSensor {
  Mat3 R_site_sensor = Mat3::Identity();  // o_j
  Vec3 offset_m = Vec3::Zero();           // p_j: from the site's place, in the site's axes
  double mounting_deviation_deg = 0.0;    // standard deviation about the worst axis
  Vec3 offset_deviation_m = Vec3::Zero();
  bool is_mounting_determined = false, is_offset_determined = false;
};

struct PoseCalibration {
  StandardBones bones{};
  BoneLengths deviation_m = BoneLengths::Zero();  // standard deviation of each length
  std::array<bool, kNumBoneLengths> is_determined{};
  std::vector<CalibratedSensor> sensors;
  std::vector<double> missed_deg;  // how far limbs with sensors were from each shown pose, RMS
  double imitation_deg = 0.0;      // deviation of each angle from the shown poses
  double yaw_rad = 0.0;            // of the performer's front in the trackers' world
  bool are_poses_alike = false;    // too much to tell lengths and sensors apart
};

// Calibrates bones and sensors of Liu et al. 2011, section 4: equation (1), by Levenberg-Marquardt,
// with two more unknowns a pose: where the performer stands, and how far each angle misses the
// shown pose. How far it typically does is estimated as well. What the poses do not determine is
// left where the bone lengths' subspace and the sensors' sites have it. sensors say where each is
// worn. Throws ConfigError without sensors or poses, for a pose that has another number of sensors,
// and when no sensor of a pose says anything.
PoseCalibration calibrated_from_poses(const BoneLengthModel& lengths,
                                      const std::vector<Sensor>& sensors,
                                      std::span<const HeldPose> held,
                                      const PoseCalibrationSettings& settings);

}  // namespace sparse_mocap::liu2011
