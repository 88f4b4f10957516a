// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/diagnostics.hpp"

#include <algorithm>
#include <string>
#include <string_view>

namespace sparse_mocap::retrieval {
namespace {

// The value of this name, in the memory that it has.
Eigen::VectorXd& value_of(Diagnostics& diagnostics, std::string_view name) {
  const auto at = diagnostics.find(name);
  return at != diagnostics.end() ? at->second : diagnostics[std::string(name)];
}

void put_spread_m(const MotionDatabase& database, const WeightedPaths& weighted,
                  Eigen::VectorXd& spread) {
  static thread_local Eigen::VectorXd mean, positions;
  mean.setZero(database.positions().cols());
  const auto look_up = [&](std::size_t i) {
    positions = database.positions().row(weighted.paths[i].frame).transpose().cast<double>();
    return weighted.weights[static_cast<Eigen::Index>(i)];
  };
  for (std::size_t i = 0; i < weighted.paths.size(); ++i) {
    const double weight = look_up(i);
    mean += weight * positions;
  }
  spread.setZero(mean.size() / 3);
  for (std::size_t i = 0; i < weighted.paths.size(); ++i) {
    const double weight = look_up(i);
    for (Eigen::Index j = 0; j < spread.size(); ++j)
      spread[j] += weight * (positions.segment<3>(3 * j) - mean.segment<3>(3 * j)).squaredNorm();
  }
  spread = spread.cwiseSqrt();
}

bool is_force(const Signal& signal) { return signal.channel == Channel::specific_force; }

void put_sensor_misfit_mps2(const WeightedPaths& weighted, std::span<const Signal> signals,
                            const FeatureRows& signal_rows,
                            const Eigen::Ref<const Eigen::RowVectorXf>& measured,
                            Eigen::VectorXd& norms) {
  static thread_local Eigen::RowVectorXd misfit;
  misfit = measured.cast<double>();
  for (std::size_t i = 0; i < weighted.paths.size(); ++i)
    misfit -= weighted.weights[static_cast<Eigen::Index>(i)] *
              signal_rows.row(weighted.paths[i].frame).cast<double>();
  norms.resize(std::count_if(signals.begin(), signals.end(), is_force));
  Eigen::Index next = 0;
  for (std::size_t s = 0; s < signals.size(); ++s)
    if (is_force(signals[s]))
      norms[next++] = misfit.segment<3>(static_cast<Eigen::Index>(3 * s)).norm();
}

void put_specific_force_mps2(std::span<const Signal> signals,
                             const Eigen::Ref<const Eigen::RowVectorXf>& measured,
                             Eigen::VectorXd& values) {
  values.resize(3 * std::count_if(signals.begin(), signals.end(), is_force));
  Eigen::Index next = 0;
  for (std::size_t s = 0; s < signals.size(); ++s)
    if (is_force(signals[s])) {
      values.segment<3>(next) =
          measured.segment<3>(static_cast<Eigen::Index>(3 * s)).transpose().cast<double>();
      next += 3;
    }
}

}  // namespace

Diagnostics retrieval_diagnostics(const MotionDatabase& database, const WeightedPaths& weighted,
                                  std::span<const Signal> signals, const FeatureRows& signal_rows,
                                  const Eigen::RowVectorXf& measured) {
  Diagnostics out;
  put_retrieval_diagnostics(database, weighted, signals, signal_rows, measured, out);
  return out;
}

void put_retrieval_diagnostics(const MotionDatabase& database, const WeightedPaths& weighted,
                               std::span<const Signal> signals, const FeatureRows& signal_rows,
                               const Eigen::Ref<const Eigen::RowVectorXf>& measured,
                               Diagnostics& out) {
  const int frame = weighted.paths.front().frame;
  put_sensor_misfit_mps2(weighted, signals, signal_rows, measured,
                         value_of(out, "sensor_misfit_mps2"));
  put_specific_force_mps2(signals, measured, value_of(out, "specific_force_mps2"));
  put_spread_m(database, weighted, value_of(out, "spread_m"));
  value_of(out, "clip").setConstant(1, database.clip_index(frame));
  value_of(out, "database_frame").setConstant(1, frame);
}

}  // namespace sparse_mocap::retrieval
