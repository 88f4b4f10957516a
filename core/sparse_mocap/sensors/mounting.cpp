// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/mounting.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "sparse_mocap/sensors/filter.hpp"

namespace sparse_mocap {
namespace {

constexpr GaussianFilter kSmooth{0.05};  // slower than impacts, faster than limbs
constexpr double kSmallestSine = 0.3;    // between an axis and gravity

Eigen::Matrix3Xd smoothed(const SensorRecording& movement, const Eigen::Matrix3Xd& values) {
  return filtered_at(movement.times_s, values, movement.times_s, kSmooth);
}

// Spreads (root mean square) along the principal directions, ascending.
Eigen::SelfAdjointEigenSolver<Mat3> principal(const Eigen::Matrix3Xd& values) {
  return Eigen::SelfAdjointEigenSolver<Mat3>(values * values.transpose() /
                                             static_cast<double>(values.cols()));
}

TurningAxis axis_from_gyroscope(const SensorRecording& movement, const Vec3& bias) {
  const Eigen::Matrix3Xd turning =
      smoothed(movement, Eigen::Matrix3Xd(movement.angular_velocity.colwise() - bias));
  const auto spread = principal(turning);
  TurningAxis out;
  out.is_from_gyroscope = true;
  out.axis = spread.eigenvectors().col(2);
  out.ratio = std::sqrt(spread.eigenvalues()[2] / std::max(spread.eigenvalues()[1], 1e-12));
  const Eigen::RowVectorXd rate = out.axis.transpose() * turning;
  double angle = 0.0, sum = 0.0, squares = 0.0;
  const auto n = static_cast<std::size_t>(rate.size());
  for (std::size_t i = 1; i < n; ++i) {
    angle += rate[static_cast<Eigen::Index>(i)] * (movement.times_s[i] - movement.times_s[i - 1]);
    sum += angle;
    squares += angle * angle;
  }
  const double count = static_cast<double>(n);
  out.sweep_rad = std::sqrt(std::max(squares / count - (sum / count) * (sum / count), 0.0));
  return out;
}

TurningAxis axis_from_forces(const SensorRecording& movement) {
  const Eigen::Matrix3Xd force = smoothed(movement, movement.specific_force) / kGravity_mps2;
  const auto spread = principal(force);
  TurningAxis out;
  out.axis = spread.eigenvectors().col(0);
  const double across = std::sqrt(std::max(spread.eigenvalues()[1], 0.0));
  out.ratio = across / std::sqrt(std::max(spread.eigenvalues()[0], 1e-10));
  out.sweep_rad = std::asin(std::min(across, 1.0));
  return out;
}

bool stands_out(const TurningAxis& axis) {
  return axis.ratio >= kSmallestAxisRatio && axis.sweep_rad >= kSmallestSweep_rad;
}

// The rotation that takes the pair exactly onto each other, and the second directions as near as
// that allows.
Mat3 rotation_between(const Vec3& to, const Vec3& towards, const Vec3& from, const Vec3& along) {
  const auto basis = [](const Vec3& first, const Vec3& second) {
    Mat3 R;
    R.col(0) = first.normalized();
    R.col(1) = (second - second.dot(R.col(0)) * R.col(0)).normalized();
    R.col(2) = R.col(0).cross(R.col(1));
    return R;
  };
  return basis(to, towards) * basis(from, along).transpose();
}

// Of the two rotations that the axis' unknown sign leaves, the one in which the movement goes the
// way that it was asked for: on the way gravity is met where half a turn of it leads.
Mat3 mounted(const ObservedTurn& observed, const Vec3& axis, const Vec3& up_site,
             const Vec3& up_sensor) {
  const GuidedTurn& turn = observed.turn;
  const bool is_trunk = turn.site == "head" || turn.site == "chest" || turn.site == "pelvis";
  const Vec3 rest = is_trunk ? Vec3::UnitX() : Vec3(-Vec3::UnitX());
  const Vec3 expected = rest - turn.axis.cross(rest);
  const Vec3 mean = observed.recording.specific_force.rowwise().mean();
  const Mat3 one = rotation_between(up_site, turn.axis, up_sensor, axis);
  const Mat3 other = rotation_between(up_site, turn.axis, up_sensor, -axis);
  return expected.dot(one * mean) >= expected.dot(other * mean) ? one : other;
}

}  // namespace

TurningAxis turning_axis(const SensorRecording& movement, const Vec3& gyroscope_bias) {
  if (movement.num_samples() < 10) return {};
  if (movement.has_gyroscope()) return axis_from_gyroscope(movement, gyroscope_bias);
  return axis_from_forces(movement);
}

Mounting mounting_from(const Vec3& up_site, const Vec3& up_sensor, const Vec3& gyroscope_bias,
                       std::span<const ObservedTurn> turns) {
  Mounting out;
  out.R_site_sensor = Quat::FromTwoVectors(up_sensor, up_site).toRotationMatrix();
  for (const auto& observed : turns) {
    const TurningAxis axis = turning_axis(observed.recording, gyroscope_bias);
    const bool is_across = axis.axis.cross(up_sensor).norm() > kSmallestSine &&
                           observed.turn.axis.cross(up_site).norm() > kSmallestSine;
    const bool is_usable = is_across && stands_out(axis);
    if (out.is_determined && !is_usable) continue;
    if (is_usable == out.is_determined && axis.ratio <= out.axis_ratio) continue;
    if (is_usable) out.R_site_sensor = mounted(observed, axis.axis, up_site, up_sensor);
    out.is_determined = is_usable;
    out.axis_ratio = axis.ratio;
    out.sweep_rad = axis.sweep_rad;
    out.is_from_gyroscope = axis.is_from_gyroscope;
  }
  return out;
}

}  // namespace sparse_mocap
