// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "sparse_mocap/base/conventions.hpp"
#include "support/refusals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::Random;

std::vector<double> even_times(int count, double rate_hz) {
  std::vector<double> times;
  for (int t = 0; t < count; ++t) times.push_back(t / rate_hz);
  return times;
}

TEST(FilteredAt, RefusesValuesThatDoNotFitTheTimes) {
  const std::vector<double> none, two{0.0, 1.0};
  EXPECT_REFUSED(std::invalid_argument, "one column of values",
                 filtered_at(none, Eigen::MatrixXd(1, 0), two, {0.1}));
  EXPECT_REFUSED(std::invalid_argument, "one column of values",
                 filtered_at(two, Eigen::MatrixXd(1, 3), two, {0.1}));
}

TEST(FilteredAt, IsTheNormalisedGaussianSumAtIrregularTimes) {
  Random random(1);
  std::vector<double> times;
  for (double time = 0.0; time < 2.0; time += random.in(0.001, 0.03)) times.push_back(time);
  const auto n = static_cast<Eigen::Index>(times.size());
  const Eigen::MatrixXd values = random.matrix(2, n, 5.0);
  const GaussianFilter filter{0.04};
  std::vector<double> wanted;
  for (int k = 0; k < 50; ++k) wanted.push_back(random.in(0.0, 1.9));
  const Eigen::MatrixXd filtered = filtered_at(times, values, wanted, filter);
  for (Eigen::Index k = 0; k < 50; ++k) {
    double top = 0.0, bottom = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double off = times[static_cast<std::size_t>(i)] - wanted[static_cast<std::size_t>(k)];
      if (std::abs(off) > 0.12) continue;
      top += std::exp(-off * off / (2.0 * 0.04 * 0.04)) * values(1, i);
      bottom += std::exp(-off * off / (2.0 * 0.04 * 0.04));
    }
    EXPECT_NEAR(filtered(1, k), top / bottom, 1e-12);
  }
}

TEST(FilteredAt, KeepsConstantsAndTheSlopesBetweenTheEnds) {
  const auto times = even_times(200, 100.0);
  Eigen::MatrixXd values(2, 200);
  for (int t = 0; t < 200; ++t) values.col(t) << 3.0, 0.5 * t;
  const Eigen::MatrixXd filtered = filtered_at(times, values, times, kReadingFilter);
  for (int t = 0; t < 200; ++t) {
    EXPECT_NEAR(filtered(0, t), 3.0, 1e-12);
    if (t >= 10 && t < 190) {
      EXPECT_NEAR(filtered(1, t), 0.5 * t, 1e-9);
    }
  }
}

TEST(FilteredAt, InterpolatesWhereTheKernelMeetsLessThanTwoSamples) {
  const std::vector<double> times{0.0, 1.0, 3.0};
  Eigen::MatrixXd values(1, 3);
  values << 10.0, 20.0, 60.0;
  const std::vector<double> wanted{-5.0, 0.0, 0.25, 2.0, 3.0, 9.0};
  for (const double sigma : {0.0, 0.05}) {
    const Eigen::MatrixXd filtered = filtered_at(times, values, wanted, {sigma});
    Eigen::RowVectorXd expected(6);
    expected << 10.0, 10.0, 12.5, 40.0, 60.0, 60.0;
    EXPECT_LT((filtered - expected).cwiseAbs().maxCoeff(), 1e-12) << sigma;
  }
}

// How much of a sine is left, measured against quadrature.
double magnitude_at(double frequency_hz, GaussianFilter filter) {
  const auto times = even_times(4001, 2000.0);
  Eigen::MatrixXd values(2, 4001);
  for (int t = 0; t < 4001; ++t) {
    const double phase = 2.0 * kPi * frequency_hz * times[static_cast<std::size_t>(t)];
    values.col(t) << std::sin(phase), std::cos(phase);
  }
  return filtered_at(times, values, std::vector<double>{1.0}, filter).norm();
}

TEST(Filters, HaveTheirHalfPowerPointsWhereTheySay) {
  EXPECT_NEAR(magnitude_at(20.0, kMarkerFilter), std::sqrt(0.5), 0.01);
  EXPECT_NEAR(magnitude_at(11.5, kReadingFilter), std::sqrt(0.5), 0.01);
  EXPECT_GT(magnitude_at(2.0, kReadingFilter), 0.98);
  EXPECT_LT(magnitude_at(40.0, kReadingFilter), 0.03);
}

}  // namespace
}  // namespace sparse_mocap
