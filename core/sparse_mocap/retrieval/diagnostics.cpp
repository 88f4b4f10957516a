// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/diagnostics.hpp"

#include <cmath>

namespace sparse_mocap::retrieval {
namespace {

Eigen::VectorXd spread_m(const MotionDatabase& database, const WeightedPaths& weighted) {
  const auto count = static_cast<Eigen::Index>(weighted.paths.size());
  Eigen::MatrixXd positions(database.positions().cols(), count);
  for (Eigen::Index i = 0; i < count; ++i)
    positions.col(i) = database.positions()
                           .row(weighted.paths[static_cast<std::size_t>(i)].frame)
                           .transpose()
                           .cast<double>();
  const Eigen::VectorXd mean = positions * weighted.weights;
  Eigen::VectorXd spread(mean.size() / 3);
  for (Eigen::Index j = 0; j < spread.size(); ++j) {
    const auto joint = positions.middleRows(3 * j, 3);
    const Eigen::RowVectorXd squared =
        (joint.colwise() - mean.segment<3>(3 * j)).colwise().squaredNorm();
    spread[j] = std::sqrt(squared.dot(weighted.weights));
  }
  return spread;
}

Eigen::VectorXd specific_force_mps2(std::span<const Signal> signals,
                                    const Eigen::RowVectorXf& measured) {
  std::vector<double> values;
  for (std::size_t s = 0; s < signals.size(); ++s)
    if (signals[s].channel == Channel::specific_force)
      for (Eigen::Index axis = 0; axis < 3; ++axis)
        values.push_back(static_cast<double>(measured[static_cast<Eigen::Index>(3 * s) + axis]));
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Eigen::VectorXd sensor_misfit_mps2(const WeightedPaths& weighted, std::span<const Signal> signals,
                                   const FeatureRows& signal_rows,
                                   const Eigen::RowVectorXf& measured) {
  Eigen::RowVectorXd retrieved = Eigen::RowVectorXd::Zero(signal_rows.cols());
  for (std::size_t i = 0; i < weighted.paths.size(); ++i)
    retrieved += weighted.weights[static_cast<Eigen::Index>(i)] *
                 signal_rows.row(weighted.paths[i].frame).cast<double>();
  const Eigen::RowVectorXd misfit = measured.cast<double>() - retrieved;
  std::vector<double> norms;
  for (std::size_t s = 0; s < signals.size(); ++s)
    if (signals[s].channel == Channel::specific_force)
      norms.push_back(misfit.segment<3>(static_cast<Eigen::Index>(3 * s)).norm());
  return Eigen::Map<const Eigen::VectorXd>(norms.data(), static_cast<Eigen::Index>(norms.size()));
}

}  // namespace

Diagnostics retrieval_diagnostics(const MotionDatabase& database, const WeightedPaths& weighted,
                                  std::span<const Signal> signals, const FeatureRows& signal_rows,
                                  const Eigen::RowVectorXf& measured) {
  const int frame = weighted.paths.front().frame;
  Diagnostics out;
  out["sensor_misfit_mps2"] = sensor_misfit_mps2(weighted, signals, signal_rows, measured);
  out["specific_force_mps2"] = specific_force_mps2(signals, measured);
  out["spread_m"] = spread_m(database, weighted);
  out["clip"] = Eigen::VectorXd::Constant(1, database.clip_index(frame));
  out["database_frame"] = Eigen::VectorXd::Constant(1, frame);
  return out;
}

}  // namespace sparse_mocap::retrieval
