// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/synthetic.hpp"

#include <cmath>

#include "sparse_mocap/base/quaternions.hpp"
#include "sparse_mocap/database/database_rows.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/motion/joint_rotations.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::testing {

Skeleton template_skeleton() { return make_standard_skeleton(template_bones()); }

Motion resting_motion(const Skeleton& skeleton, int frames, double rate_hz, double height_m) {
  Motion motion;
  motion.skeleton = skeleton;
  motion.frame_time_s = 1.0 / rate_hz;
  motion.root_positions.assign(static_cast<std::size_t>(frames), Vec3(0.0, height_m, 0.0));
  motion.rotations.assign(static_cast<std::size_t>(frames * skeleton.num_joints()),
                          Quat::Identity());
  return motion;
}

Motion swaying_motion(const Skeleton& skeleton, unsigned seed, int frames, double rate_hz) {
  Random random(seed);
  const auto n = skeleton.num_angles();
  const Eigen::VectorXd offset = random.column(n, 0.3);
  const Eigen::VectorXd amplitude = random.column(n, 0.4);
  const Eigen::VectorXd phase = random.column(n, kPi);
  const double pace_hz = random.in(0.5, 1.2), speed_mps = random.in(0.3, 1.2);
  const double turning_radps = random.in(-0.5, 0.5);
  Motion motion = resting_motion(skeleton, frames, rate_hz);
  for (int t = 0; t < frames; ++t) {
    const double time_s = t / rate_hz;
    const double turn = 2.0 * kPi * pace_hz * time_s;
    const Eigen::VectorXd angles =
        offset.array() + amplitude.array() * (phase.array() + turn).sin();
    for (int j = 0; j < skeleton.num_joints(); ++j)
      motion.rotation(t, j) =
          Quat(joint_rotation(skeleton.joint(j), angles.data() + skeleton.angle_begin(j)));
    const double yaw = turning_radps * time_s;
    motion.rotation(t, 0) = Quat(Eigen::AngleAxisd(yaw, kUp)) * motion.rotation(t, 0);
    motion.root_positions[static_cast<std::size_t>(t)] = {
        0.05 * std::sin(turn), 0.9 + 0.03 * std::sin(2.0 * turn), speed_mps * time_s};
  }
  return motion;
}

DatabaseContent content_of(const std::vector<Motion>& motions, double rate_hz) {
  DatabaseContent content;
  content.skeleton = motions.front().skeleton;
  content.rate_hz = rate_hz;
  content.build_info = "{}";
  for (std::size_t c = 0; c < motions.size(); ++c) {
    const std::string name = "clip" + std::to_string(c);
    Clip clip;
    clip.name = name;
    clip.actor = "actor";
    clip.motion_class = "class";
    clip.source = name + ".bvh";
    clip.source_hash = "0123456789abcdef";
    content.clips.push_back(clip);
    content.clip_rows.push_back(packed(database_rows(motions[c], rate_hz)));
  }
  return content;
}

std::shared_ptr<const MotionDatabase> database_of(const DatabaseContent& content) {
  return MotionDatabase::from_bytes(own_bytes(encode_database(content)), "memory.smdb");
}

std::shared_ptr<const MotionDatabase> database_of(const std::vector<Motion>& motions,
                                                  double rate_hz) {
  return database_of(content_of(motions, rate_hz));
}

std::vector<Sensor> paper_sensors() {
  std::vector<Sensor> sensors;
  for (const int site : paper_sites()) sensors.push_back({site, 1.0});
  return sensors;
}

namespace {

// Moves the heading frame, on the ground, on into a frame of the database.
void advance(const MotionDatabase& database, int frame, double& yaw_rad, Vec3& origin) {
  const auto rates = database.root_motion().row(frame).cast<double>();
  const double dt_s = database.frame_time_s();
  origin += yaw_rotation(yaw_rad) * (dt_s * Vec3(rates[root_motion_column::velocity_left], 0.0,
                                                 rates[root_motion_column::velocity_forward]));
  yaw_rad += dt_s * rates[root_motion_column::yaw_rate];
}

JointTransforms transforms_at(const MotionDatabase& database, int frame, double yaw_rad,
                              const Vec3& origin) {
  JointRotations rotations =
      joint_rotations(database.skeleton(), database.angles().row(frame).transpose().cast<double>());
  rotations[0] = yaw_rotation(yaw_rad) * rotations[0];
  JointTransforms out;
  const double height_m = database.root_motion()(frame, root_motion_column::height);
  forward_kinematics(database.skeleton(), origin + height_m * kUp, rotations, out);
  return out;
}

void put_place(const JointTransforms& pose, const Sensor& sensor, Eigen::Index at,
               Reading& reading) {
  const Site& site = all_sites()[static_cast<std::size_t>(sensor.site)];
  const auto carrier = static_cast<std::size_t>(site.carrier);
  const Mat3& R = pose.R_world_joint[static_cast<std::size_t>(site.orientation)];
  if (sensor.channels.has(Channel::position))
    reading.position.col(at) = (1.0 - sensor.position_along_bone) * pose.pivot[carrier] +
                               sensor.position_along_bone * pose.end[carrier];
  if (sensor.channels.has(Channel::orientation))
    reading.orientation.col(at) = wxyz_of(Quat(Mat3(R * site.R_joint_sensor)));
}

}  // namespace

std::vector<Reading> readings_of(const MotionDatabase& database, int clip,
                                 const std::vector<Sensor>& sensors) {
  const Clip& wanted = database.clips()[static_cast<std::size_t>(clip)];
  std::vector<Reading> readings;
  double yaw_rad = 0.0;
  Vec3 origin = Vec3::Zero();
  for (int frame = wanted.begin; frame < wanted.end; ++frame) {
    if (frame > wanted.begin) advance(database, frame, yaw_rad, origin);
    const JointTransforms pose = transforms_at(database, frame, yaw_rad, origin);
    Reading reading(static_cast<Eigen::Index>(sensors.size()));
    reading.time_s = (frame - wanted.begin) * database.frame_time_s();
    for (std::size_t s = 0; s < sensors.size(); ++s) {
      const auto at = static_cast<Eigen::Index>(s);
      const SiteRows& site = database.site(static_cast<std::size_t>(sensors[s].site));
      const auto row = [&](const ScaledRows& rows) -> Vec3 {
        return rows.row(frame).transpose().cast<double>();
      };
      const Vec3 pivot = row(site.specific_force_pivot);
      const Vec3 end = row(site.specific_force_end);
      const Channels channels = sensors[s].channels;
      if (channels.has(Channel::specific_force))
        reading.specific_force.col(at) = pivot + sensors[s].position_along_bone * (end - pivot);
      if (channels.has(Channel::angular_velocity))
        reading.angular_velocity.col(at) = row(site.angular_velocity);
      if (channels.has(Channel::gravity_direction))
        reading.gravity_direction.col(at) = row(site.gravity_direction);
      put_place(pose, sensors[s], at, reading);
    }
    readings.push_back(reading);
  }
  return readings;
}

}  // namespace sparse_mocap::testing
