// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/position_along_bone.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "sparse_mocap/sensors/filter.hpp"

namespace sparse_mocap {
namespace {

constexpr GaussianFilter kSmooth{0.02};
constexpr double kStretch_s = 3.0;
constexpr double kOffBone_m = 0.04;  // how far from the bone's axis a sensor sits

Mat3 cross_matrix(const Vec3& v) {
  Mat3 out;
  out << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return out;
}

// Normal equations of one stretch: its gravity (3), which is eliminated, and the lever (3).
struct Stretch {
  Mat3 gravity = Mat3::Zero(), mixed = Mat3::Zero(), lever = Mat3::Zero();
  Vec3 gravity_side = Vec3::Zero(), lever_side = Vec3::Zero();
  double squares = 0.0;
  int count = 0;

  void add(const Mat3& R_start_now, const Mat3& turning, const Vec3& force) {
    gravity += Mat3::Identity();
    mixed += R_start_now * turning;
    lever += turning.transpose() * turning;
    gravity_side += R_start_now * force;
    lever_side += turning.transpose() * force;
    squares += force.squaredNorm();
    ++count;
  }
};

struct Reduced {
  Mat3 lever = Mat3::Zero();
  Vec3 side = Vec3::Zero();
  double squares = 0.0;
  int count = 0;

  void add(const Stretch& stretch) {
    if (stretch.count < 10) return;
    const Mat3 inverse = stretch.gravity.inverse();
    lever += stretch.lever - stretch.mixed.transpose() * inverse * stretch.mixed;
    side += stretch.lever_side - stretch.mixed.transpose() * inverse * stretch.gravity_side;
    squares += stretch.squares - stretch.gravity_side.dot(inverse * stretch.gravity_side);
    count += 3 * stretch.count;
  }
};

Vec3 slope(const Eigen::Matrix3Xd& values, const std::vector<double>& times_s, Eigen::Index i) {
  const auto at = [&](Eigen::Index k) { return times_s[static_cast<std::size_t>(k)]; };
  return (values.col(i + 1) - values.col(i - 1)) / (at(i + 1) - at(i - 1));
}

Reduced reduced(const SensorRecording& recording) {
  const auto& times = recording.times_s;
  const Eigen::Matrix3Xd force = filtered_at(times, recording.specific_force, times, kSmooth);
  const Eigen::Matrix3Xd turn = filtered_at(times, recording.angular_velocity, times, kSmooth);
  Reduced out;
  Stretch stretch;
  Quat q_start_now = Quat::Identity();
  double start_s = times.front();
  for (Eigen::Index i = 1; i + 1 < force.cols(); ++i) {
    const double now_s = times[static_cast<std::size_t>(i)];
    if (now_s - start_s > kStretch_s) {
      out.add(stretch);
      stretch = {};
      q_start_now = Quat::Identity();
      start_s = now_s;
    }
    const Vec3 omega = turn.col(i);
    const Mat3 turning =
        cross_matrix(slope(turn, times, i)) + cross_matrix(omega) * cross_matrix(omega);
    stretch.add(q_start_now.toRotationMatrix(), turning, force.col(i));
    const Vec3 step =
        0.5 * (omega + turn.col(i + 1)) * (times[static_cast<std::size_t>(i + 1)] - now_s);
    if (step.norm() > 0.0)
      q_start_now = q_start_now * Quat(Eigen::AngleAxisd(step.norm(), step.normalized()));
  }
  out.add(stretch);
  return out;
}

}  // namespace

Lever lever_from(const SensorRecording& recording) {
  if (!recording.has_gyroscope() || recording.num_samples() < 30) return {};
  const Reduced all = reduced(recording);
  if (all.count < 60) return {};
  const auto residual = [&](const Vec3& r) {
    return std::max(all.squares - 2.0 * r.dot(all.side) + r.dot(all.lever * r), 1e-12);
  };
  // What is known of the sensor's distance from the bone's axis stands in for what a hinge cannot
  // show; the variance that it is weighed against comes from the fit itself.
  double variance = residual(Vec3::Zero()) / all.count;
  Vec3 r = Vec3::Zero();
  Mat3 information = Mat3::Identity();
  for (int iteration = 0; iteration < 5; ++iteration) {
    const double prior = variance / (kOffBone_m * kOffBone_m);
    information = all.lever + Vec3(1e-9, prior, prior).asDiagonal().toDenseMatrix();
    r = information.ldlt().solve(all.side);
    variance = residual(r) / all.count;
  }
  // Smoothing leaves only some of the samples independent.
  const double alike =
      std::max(1.0, 2.0 * std::sqrt(kPi) * kSmooth.sigma_s / recording.sample_time_s());
  Lever out;
  out.along_m = r.x();
  out.deviation_m = std::sqrt(variance * alike * information.inverse()(0, 0));
  out.explained = 1.0 - residual(r) / residual(Vec3::Zero());
  return out;
}

}  // namespace sparse_mocap
