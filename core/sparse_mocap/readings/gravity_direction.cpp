// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/readings/gravity_direction.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sparse_mocap {
namespace {

const Vec3 kUnknown = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());

Quat turned(const Quat& R_held_sensor, const Vec3& rate, double dt_s) {
  const double angle = rate.norm() * dt_s;
  if (angle == 0.0) return R_held_sensor;
  const Quat step(Eigen::AngleAxisd(angle, rate.normalized()));
  return (R_held_sensor * step).normalized();
}

bool is_next(double step_s) {
  return step_s > 0.0 && step_s <= GravityDirectionFilter::kLongestGap_s;
}

// A sample of a stretch without gaps, turned into its held frame.
struct Held {
  Eigen::Index at = 0;
  Quat R_held_sensor = Quat::Identity();
  Vec3 force = Vec3::Zero();
  double decay = 0.0;  // from the sample before
};

// A sum of forces and of what each counts.
struct Sum {
  Vec3 force = Vec3::Zero();
  double weight = 0.0;
};

// Averages each sample's surroundings, which count by exp(-distance / time constant).
void finish(const std::vector<Held>& stretch, Eigen::Matrix3Xd& out) {
  std::vector<Sum> behind(stretch.size());
  Sum sum;
  for (std::size_t i = stretch.size(); i-- > 1;) {
    const auto& [at, R, force, decay] = stretch[i];
    sum = {decay * (sum.force + force), decay * (sum.weight + 1.0)};
    behind[i - 1] = sum;
  }
  sum = {};
  for (std::size_t i = 0; i < stretch.size(); ++i) {
    const auto& [at, R_held_sensor, force, decay] = stretch[i];
    sum = {decay * sum.force + force, decay * sum.weight + 1.0};
    const Vec3 mean = (sum.force + behind[i].force) / (sum.weight + behind[i].weight);
    out.col(at) = R_held_sensor.conjugate() * mean.normalized();
  }
}

Eigen::Matrix3Xd causal_directions(const SensorRecording& recording) {
  Eigen::Matrix3Xd out = kUnknown.replicate(1, recording.num_samples());
  GravityDirectionFilter filter;
  for (Eigen::Index t = 0; recording.has_gyroscope() && t < recording.num_samples(); ++t)
    out.col(t) = filter.update(recording.times_s[static_cast<std::size_t>(t)],
                               recording.specific_force.col(t), recording.angular_velocity.col(t));
  return out;
}

Eigen::Matrix3Xd whole_take_directions(const SensorRecording& recording) {
  const auto& times_s = recording.times_s;
  const auto& forces = recording.specific_force;
  const auto& rates = recording.angular_velocity;
  Eigen::Matrix3Xd out = kUnknown.replicate(1, recording.num_samples());
  if (!recording.has_gyroscope()) return out;
  std::vector<Held> stretch;
  bool has_turned = false;
  for (Eigen::Index t = 0; t < recording.num_samples(); ++t) {
    if (!forces.col(t).allFinite() || !rates.col(t).allFinite()) continue;
    has_turned = has_turned || rates.col(t) != Vec3::Zero();
    Held held{t, Quat::Identity(), Vec3::Zero(), 0.0};
    if (!stretch.empty()) {
      const Held& last = stretch.back();
      const double dt_s =
          times_s[static_cast<std::size_t>(t)] - times_s[static_cast<std::size_t>(last.at)];
      if (is_next(dt_s)) {
        const Vec3 rate = 0.5 * (rates.col(last.at) + rates.col(t));
        held.R_held_sensor = turned(last.R_held_sensor, rate, dt_s);
        held.decay = std::exp(-dt_s / GravityDirectionFilter::kTimeConstant_s);
      } else {
        finish(stretch, out);
        stretch.clear();
      }
    }
    held.force = held.R_held_sensor * forces.col(t);
    stretch.push_back(held);
  }
  finish(stretch, out);
  if (!has_turned) out.setConstant(std::numeric_limits<double>::quiet_NaN());
  return out;
}

}  // namespace

Vec3 GravityDirectionFilter::update(double time_s, const Vec3& specific_force,
                                    const Vec3& angular_velocity) {
  if (!std::isfinite(time_s) || !specific_force.allFinite() || !angular_velocity.allFinite())
    return kUnknown;
  const double dt_s = time_s - last_s_;
  if (is_next(dt_s)) {
    R_held_sensor_ = turned(R_held_sensor_, 0.5 * (last_rate_ + angular_velocity), dt_s);
    age_s_ += dt_s;
    // A plain mean at first, which forgets nothing yet.
    const double share = std::max(1.0 - std::exp(-dt_s / kTimeConstant_s), dt_s / age_s_);
    mean_ += share * (R_held_sensor_ * specific_force - mean_);
  } else {
    const bool has_turned = has_turned_;
    reset();
    has_turned_ = has_turned;
    mean_ = specific_force;
  }
  last_s_ = time_s;
  last_rate_ = angular_velocity;
  has_turned_ = has_turned_ || angular_velocity != Vec3::Zero();
  if (!has_turned_ || age_s_ < kUnsure_s) return kUnknown;
  return R_held_sensor_.conjugate() * mean_.normalized();
}

Eigen::Matrix3Xd gravity_directions(const SensorRecording& recording, GravityAverage average) {
  return average == GravityAverage::causal ? causal_directions(recording)
                                           : whole_take_directions(recording);
}

}  // namespace sparse_mocap
