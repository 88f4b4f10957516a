// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

namespace sparse_mocap {

// A Gaussian low-pass over time. Takes and databases are filtered by the same kernel, so that a
// reading and its virtual counterpart have the same magnitude response and the same (zero) delay;
// the price is a look-ahead of reach_s.
struct GaussianFilter {
  double sigma_s = 0.0;

  double reach_s() const { return 3.0 * sigma_s; }
};

// The two filters that every virtual signal passes (-3 dB points beside them): marker jitter must
// go before positions are differentiated twice, and what the database's rate cannot carry must go
// before readings are sampled.
inline constexpr GaussianFilter kMarkerFilter{0.0066};   // 20 Hz, on positions
inline constexpr GaussianFilter kReadingFilter{0.0115};  // 11.5 Hz, on readings

// Values (rows x times) observed at times_s (ascending), low-passed and sampled at wanted_s.
// Irregular times are fine. Where the kernel meets fewer than two samples, neighbours are
// interpolated; beyond the ends the nearest sample holds.
Eigen::MatrixXd filtered_at(std::span<const double> times_s,
                            const Eigen::Ref<const Eigen::MatrixXd>& values,
                            std::span<const double> wanted_s, GaussianFilter filter);

}  // namespace sparse_mocap
