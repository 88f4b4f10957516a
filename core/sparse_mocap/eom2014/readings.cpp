// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/readings.hpp"

#include <algorithm>
#include <cmath>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap::eom2014 {
namespace {

constexpr double kShortest_s = 1.0;
constexpr double kLargestGap = 0.5;            // share of the take
constexpr double kLeastGravity_mps2 = 5.0;     // of a specific force, on average
constexpr double kLeastG = 0.6, kMostG = 1.4;  // of one that is in g
constexpr double kFastestLimb_radps = 20.0;    // root mean square

// Rows between known ones in straight lines; those beyond the ends like the last.
void bridge(ReadingRows& rows, const std::vector<Eigen::Index>& known) {
  for (Eigen::Index t = 0; t < rows.rows(); ++t) {
    const auto after = std::lower_bound(known.begin(), known.end(), t);
    if (after != known.end() && *after == t) continue;
    if (after == known.begin()) {
      rows.row(t) = rows.row(known.front());
    } else if (after == known.end()) {
      rows.row(t) = rows.row(known.back());
    } else {
      const Eigen::Index before = *(after - 1);
      const double share = static_cast<double>(t - before) / static_cast<double>(*after - before);
      rows.row(t) = (1.0 - share) * rows.row(before) + share * rows.row(*after);
    }
  }
}

}  // namespace

ReadingRows reading_rows(const std::vector<Reading>& take, double rate_hz) {
  const auto n = static_cast<Eigen::Index>(take.size());
  if (static_cast<double>(n) < kShortest_s * rate_hz)
    throw ConfigError("the recording is too short: it has " +
                      std::to_string(std::lround(1000.0 * static_cast<double>(n) / rate_hz)) +
                      " ms, and at least a second is needed");
  ReadingRows rows(n, 6);
  std::vector<Eigen::Index> known;
  for (Eigen::Index t = 0; t < n; ++t) {
    const Reading& reading = take[static_cast<std::size_t>(t)];
    require_sensors(reading, 1);
    rows.row(t) << reading.specific_force.col(0).transpose(),
        reading.angular_velocity.col(0).transpose();
    if (rows.row(t).allFinite()) known.push_back(t);
  }
  if (static_cast<double>(known.size()) < (1.0 - kLargestGap) * static_cast<double>(n))
    throw ConfigError("the recording has gaps: only " +
                      std::to_string(100 * known.size() / take.size()) +
                      " % of it has both an acceleration and an angular velocity");
  bridge(rows, known);
  return rows;
}

ReadingRows Units::converted(ReadingRows readings) const {
  readings.leftCols<3>() *= to_mps2;
  readings.rightCols<3>() *= to_radps;
  return readings;
}

Units units_of(const ReadingRows& readings, std::vector<std::string>& notes) {
  Units units;
  const double gravity = readings.leftCols<3>().colwise().mean().norm();
  if (gravity > kLeastG && gravity < kMostG) {
    units.to_mps2 = kGravity_mps2;
    notes.emplace_back("accelerations were converted from g");
  } else if (gravity < kLeastGravity_mps2) {
    throw ConfigError("the recording's accelerations have no gravity in them: " +
                      std::to_string(std::lround(100.0 * gravity)) +
                      " cm/s^2 on average, where gravity alone is 981; record them with gravity");
  }
  const double turning = std::sqrt(readings.rightCols<3>().rowwise().squaredNorm().mean());
  if (turning > kFastestLimb_radps) {
    units.to_radps = kRadiansPerDegree;
    notes.emplace_back("angular velocities were converted from degrees a second");
  }
  return units;
}

ReadingRows smoothed(const ReadingRows& readings, double sigma_frames) {
  const auto reach = static_cast<Eigen::Index>(std::ceil(3.0 * sigma_frames));
  if (reach == 0) return readings;
  ReadingRows out = ReadingRows::Zero(readings.rows(), 6);
  for (Eigen::Index t = 0; t < readings.rows(); ++t) {
    double total = 0.0;
    for (Eigen::Index by = -reach; by <= reach; ++by) {
      if (t + by < 0 || t + by >= readings.rows()) continue;
      const double distance = static_cast<double>(by) / sigma_frames;
      const double weight = std::exp(-0.5 * distance * distance);
      out.row(t) += weight * readings.row(t + by);
      total += weight;
    }
    out.row(t) /= total;
  }
  return out;
}

ReadingRows turned(const ReadingRows& readings, const Mat3& R_site_sensor) {
  ReadingRows out(readings.rows(), 6);
  out.leftCols<3>() = readings.leftCols<3>() * R_site_sensor.transpose();
  out.rightCols<3>() = readings.rightCols<3>() * R_site_sensor.transpose();
  return out;
}

ReadingScale ReadingScale::of(const ReadingRows& readings) {
  ReadingScale out;
  out.mean = readings.colwise().mean();
  const auto n = static_cast<double>(readings.rows());
  out.deviation =
      ((readings.rowwise() - out.mean).colwise().squaredNorm() / n).cwiseSqrt().cwiseMax(1e-6);
  return out;
}

Eigen::MatrixXd features(const ReadingRows& readings, const ReadingScale& scale, int window) {
  const ReadingRows scaled =
      (readings.rowwise() - scale.mean).array().rowwise() / scale.deviation.array();
  const double share = 1.0 / std::sqrt(6.0 * (2.0 * window + 1.0));
  Eigen::MatrixXd out(readings.rows(), 6 * (2 * window + 1));
  for (Eigen::Index t = 0; t < readings.rows(); ++t)
    for (int by = -window; by <= window; ++by)
      out.row(t).segment<6>(6 * (by + window)) =
          share * scaled.row(std::clamp<Eigen::Index>(t + by, 0, readings.rows() - 1));
  return out;
}

Eigen::MatrixXd sequence_features(const ReadingRows& readings, const std::vector<int>& begins,
                                  const ReadingScale& scale, int window) {
  Eigen::MatrixXd out(readings.rows(), 6 * (2 * window + 1));
  for (std::size_t s = 0; s < begins.size(); ++s) {
    const Eigen::Index begin = begins[s];
    const Eigen::Index end = s + 1 < begins.size() ? begins[s + 1] : readings.rows();
    out.middleRows(begin, end - begin) =
        features(readings.middleRows(begin, end - begin), scale, window);
  }
  return out;
}

Eigen::MatrixXd squared_distances(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd out = -2.0 * a * b.transpose();
  out.colwise() += a.rowwise().squaredNorm();
  out.rowwise() += b.rowwise().squaredNorm().transpose();
  return out.cwiseMax(0.0);
}

}  // namespace sparse_mocap::eom2014
