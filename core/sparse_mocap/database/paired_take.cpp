// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/paired_take.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "sparse_mocap/base/quaternions.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/sensors/common_yaw.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap {
namespace {

using Rows = DatabaseRows::Rows;

constexpr double kContext_s = 15.0;  // around a clip, in which directions of gravity settle

// Instants at a constant distance.
struct Instants {
  double first_s, step_s;
  int count;
  double last_s() const { return first_s + step_s * (count - 1); }
};

// The samples from begin_s to end_s.
SensorRecording cut(const SensorRecording& recording, double begin_s, double end_s) {
  const auto& times_s = recording.times_s;
  const auto first = std::lower_bound(times_s.begin(), times_s.end(), begin_s);
  const auto last = std::upper_bound(first, times_s.end(), end_s);
  const Eigen::Index at = first - times_s.begin(), count = last - first;
  const auto columns = [&](const auto& values) {
    using Matrix = std::remove_cvref_t<decltype(values)>;
    return values.cols() > 0 ? Matrix(values.middleCols(at, count)) : Matrix();
  };
  return {{first, last},
          columns(recording.specific_force),
          columns(recording.angular_velocity),
          columns(recording.position),
          columns(recording.orientation)};
}

// What the sensors measured at these instants of the take's clock, one reading each.
std::vector<Reading> readings_at(const PairedTake& take, const Instants& instants, double tempo) {
  ReadingSettings settings;
  settings.rate_hz = 1.0 / instants.step_s;
  settings.gravity_average = GravityAverage::whole_take;
  settings.filter.sigma_s = kReadingFilter.sigma_s * tempo;
  ReadingStream stream(take.sensors, settings);
  std::vector<SensorRecording> recordings;
  double begin_s = instants.first_s;
  for (const auto& recording : take.recordings) {
    recordings.push_back(
        cut(recording, instants.first_s - kContext_s, instants.last_s() + kContext_s));
    if (!recordings.back().times_s.empty())
      begin_s = std::min(begin_s, recordings.back().times_s.front());
  }
  // Readings come from the first sample on, so one that tells nothing puts them on the instants.
  const double num_before = std::floor((instants.first_s - begin_s) / instants.step_s) + 1.0;
  stream.push(0, instants.first_s - num_before * instants.step_s, SensorSample());
  for (std::size_t s = 0; s < recordings.size(); ++s)
    for (Eigen::Index t = 0; t < static_cast<Eigen::Index>(recordings[s].times_s.size()); ++t)
      stream.push(static_cast<int>(s), recordings[s].times_s[static_cast<std::size_t>(t)],
                  sample_at(recordings[s], t));
  const auto all = stream.flush();
  std::vector<Reading> readings;
  for (int i = 0; i < instants.count; ++i) {
    const auto at = static_cast<std::size_t>(num_before) + static_cast<std::size_t>(i);
    readings.push_back(at < all.size() ? all[at]
                                       : Reading(static_cast<Eigen::Index>(take.sensors.size())));
  }
  return readings;
}

// The readings of a clip's rows, in their order. first_frame_s: when the motion begins; last, ends.
std::vector<Reading> readings_of_rows(const PairedTake& take, const Clip& clip, int num_rows,
                                      double rate_hz) {
  const double step_s = clip.tempo / rate_hz;
  Instants instants{take.begin_s, step_s, num_rows};
  if (clip.is_reversed)
    instants.first_s += (clip.source_frames - 1) / clip.source_rate_hz - step_s * (num_rows - 1);
  auto readings = readings_at(take, instants, clip.tempo);
  if (clip.is_reversed) {
    std::reverse(readings.begin(), readings.end());
    for (Reading& reading : readings) reading.angular_velocity *= -1.0;
  }
  return readings;
}

// The rotation that brings virtual specific forces nearest to measured ones (Kabsch: Acta Cryst. A
// 32, 1976): how the sensor is mounted.
Mat3 fitted_mounting(const std::vector<Reading>& readings, Eigen::Index sensor,
                     const Rows& virtual_force) {
  Mat3 sum = Mat3::Zero();
  for (std::size_t t = 0; t < readings.size(); ++t) {
    const Vec3 measured = readings[t].specific_force.col(sensor);
    if (measured.allFinite())
      sum += measured * virtual_force.row(static_cast<Eigen::Index>(t)).cast<double>();
  }
  const Eigen::JacobiSVD<Mat3> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 signs = Vec3::Ones();
  signs[2] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

// Fills in which way is up where the orientation alone tells it.
void add_directions(Reading& reading) {
  for (Eigen::Index s = 0; s < reading.num_sensors(); ++s) {
    const Eigen::Vector4d wxyz = reading.orientation.col(s);
    if (!reading.gravity_direction.col(s).allFinite() && wxyz.allFinite())
      reading.gravity_direction.col(s) = quaternion_of(wxyz).normalized().conjugate() * kUp;
  }
}

// The rows of one clip that are being changed.
class ClipChange {
 public:
  ClipChange(const PairedTake& take, const Skeleton& skeleton, double tempo, PackedRows& rows)
      : take_(take), skeleton_(skeleton), tempo_(tempo), rows_(rows) {}

  Rows virtual_force(std::size_t sensor) const {
    const auto along = static_cast<float>(take_.sensors[sensor].sensor.position_along_bone);
    const PackedSite& site = site_of(sensor);
    return (1.0F - along) * unpacked(site.specific_force_pivot) +
           along * unpacked(site.specific_force_end);
  }

  // Puts a sensor's readings in; gives the channels of which there are any.
  Channels put(std::size_t sensor, const std::vector<Reading>& readings, const Mat3& mounting) {
    PackedSite& site = site_of(sensor);
    const auto column = static_cast<Eigen::Index>(sensor);
    Rows pivot = unpacked(site.specific_force_pivot), end = unpacked(site.specific_force_end);
    Rows turn = unpacked(site.angular_velocity), up = unpacked(site.gravity_direction);
    Channels found;
    for (std::size_t t = 0; t < readings.size(); ++t) {
      const auto row = static_cast<Eigen::Index>(t);
      const Reading& reading = readings[t];
      const Vec3 force = reading.specific_force.col(column);
      const Vec3 rate = reading.angular_velocity.col(column);
      const Vec3 measured_up = reading.gravity_direction.col(column);
      if (force.allFinite()) {
        const Vec3 known_up = measured_up.allFinite()
                                  ? measured_up
                                  : mounting * up.row(row).transpose().cast<double>();
        pivot.row(row) = end.row(row) = at_tempo(force, known_up).transpose().cast<float>();
        found = found | Channel::specific_force;
      }
      if (rate.allFinite()) {
        turn.row(row) = (tempo_ * rate).transpose().cast<float>();
        found = found | Channel::angular_velocity;
      }
      if (measured_up.allFinite()) {
        up.row(row) = measured_up.normalized().transpose().cast<float>();
        found = found | Channel::gravity_direction;
      }
    }
    site.specific_force_pivot = packed(pivot);
    site.specific_force_end = packed(end);
    site.angular_velocity = packed(turn);
    site.gravity_direction = packed(up);
    return found;
  }

  // Puts orientations in, each row's in the heading that its pose has; gives whose there are any.
  std::vector<bool> put_orientations(const std::vector<Reading>& readings) {
    const Rows angles = unpacked(rows_.angles);
    std::vector<Rows> told(take_.sensors.size(), Rows::Zero(angles.rows(), 4));
    std::vector<bool> found(take_.sensors.size(), false);
    if (std::none_of(take_.sensors.begin(), take_.sensors.end(), [](const SensorInput& input) {
          return input.sensor.channels.has(Channel::orientation);
        }))
      return found;
    for (Eigen::Index row = 0; row < angles.rows(); ++row) {
      const Reading& reading = readings[static_cast<std::size_t>(row)];
      const Mat3 R_heading_world = heading_of(reading, angles.row(row).transpose().cast<double>());
      for (std::size_t s = 0; s < told.size(); ++s) {
        const Eigen::Vector4d wxyz = reading.orientation.col(static_cast<Eigen::Index>(s));
        if (!wxyz.allFinite() || !(wxyz.norm() > 0.0)) continue;
        const Quat R_heading_sensor = Quat(R_heading_world) * quaternion_of(wxyz).normalized();
        told[s].row(row) = wxyz_of(R_heading_sensor.normalized()).transpose().cast<float>();
        found[s] = true;
      }
    }
    for (std::size_t s = 0; s < told.size(); ++s)
      if (found[s]) site_of(s).orientation = packed(told[s]);
    return found;
  }

 private:
  PackedSite& site_of(std::size_t sensor) const {
    return rows_.sites.at(static_cast<std::size_t>(take_.sensors[sensor].sensor.site));
  }

  // What the sensor would have measured had all gone tempo_ times as fast.
  Vec3 at_tempo(const Vec3& force, const Vec3& up) const {
    return tempo_ * tempo_ * force + (1.0 - tempo_ * tempo_) * kGravity_mps2 * up;
  }

  Mat3 heading_of(const Reading& reading, const Eigen::VectorXd& angles) const {
    std::vector<Mat3> measured, modelled;
    JointTransforms pose;
    forward_kinematics(skeleton_, Vec3::Zero(), angles, pose);
    for (std::size_t s = 0; s < take_.sensors.size(); ++s) {
      const Site& site = all_sites()[static_cast<std::size_t>(take_.sensors[s].sensor.site)];
      measured.push_back(quaternion_of(reading.orientation.col(static_cast<Eigen::Index>(s)))
                             .normalized()
                             .toRotationMatrix());
      modelled.push_back(pose.R_world_joint[site.orientation] * site.R_joint_sensor);
    }
    return yaw_rotation(-common_yaw_rad(measured, modelled));
  }

  const PairedTake& take_;
  const Skeleton& skeleton_;
  double tempo_;
  PackedRows& rows_;
};

// How many rows have anything of a sensor.
int num_told(const std::vector<Reading>& readings) {
  return static_cast<int>(
      std::count_if(readings.begin(), readings.end(), [](const Reading& reading) {
        return reading.specific_force.array().isFinite().any() ||
               reading.angular_velocity.array().isFinite().any() ||
               reading.orientation.array().isFinite().any();
      }));
}

std::string site_name(const SensorInput& input) {
  return std::string(all_sites()[static_cast<std::size_t>(input.sensor.site)].name);
}

ClipTake described(const PairedTake& take, const std::vector<Reading>& readings) {
  const double share = static_cast<double>(num_told(readings)) /
                       static_cast<double>(std::max<std::size_t>(readings.size(), 1));
  return {take.name, take.hash, take.begin_s, take.correlation, share, {}};
}

}  // namespace

int put_real_readings(const PairedTake& take, const Skeleton& skeleton, double rate_hz,
                      ImportedFile& file) {
  std::vector<Mat3> mountings(take.sensors.size(), Mat3::Identity());
  int num_rows = 0;
  for (std::size_t c = 0; c < file.clips.size(); ++c) {
    Clip& clip = file.clips[c];
    if (clip.is_mirrored) continue;
    PackedRows& rows = file.clip_rows[c];
    auto readings = readings_of_rows(take, clip, rows.num_frames(), rate_hz);
    for (Reading& reading : readings) add_directions(reading);
    ClipChange change(take, skeleton, clip.tempo, rows);
    clip.take = described(take, readings);
    for (std::size_t s = 0; s < take.sensors.size(); ++s) {
      if (!clip.is_copy())
        mountings[s] =
            fitted_mounting(readings, static_cast<Eigen::Index>(s), change.virtual_force(s));
      clip.take->channels[site_name(take.sensors[s])] = change.put(s, readings, mountings[s]);
    }
    const auto is_turned = change.put_orientations(readings);
    for (std::size_t s = 0; s < take.sensors.size(); ++s) {
      Channels& channels = clip.take->channels[site_name(take.sensors[s])];
      if (is_turned[s]) channels = channels | Channel::orientation;
    }
    if (!clip.is_copy()) num_rows = num_told(readings);
  }
  return num_rows;
}

void keep_real_readings(const ClipTake& take, const PackedRows& from, PackedRows& to) {
  for (const auto& [name, channels] : take.channels) {
    const auto at = static_cast<std::size_t>(find_site(name));
    const PackedSite& old = from.sites.at(at);
    PackedSite& site = to.sites.at(at);
    if (channels.has(Channel::specific_force)) {
      site.specific_force_pivot = old.specific_force_pivot;
      site.specific_force_end = old.specific_force_end;
    }
    if (channels.has(Channel::angular_velocity)) site.angular_velocity = old.angular_velocity;
    if (channels.has(Channel::gravity_direction)) site.gravity_direction = old.gravity_direction;
    if (channels.has(Channel::orientation)) site.orientation = old.orientation;
  }
}

}  // namespace sparse_mocap
