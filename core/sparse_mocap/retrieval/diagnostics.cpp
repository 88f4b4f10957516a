// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/diagnostics.hpp"

#include <cmath>

namespace sparse_mocap::retrieval {
namespace {

Eigen::VectorXd spread_m(const Neighbourhood& neighbours) {
  const Eigen::VectorXd mean = neighbours.positions * neighbours.weights;
  Eigen::VectorXd spread(mean.size() / 3);
  for (Eigen::Index j = 0; j < spread.size(); ++j) {
    const auto joint = neighbours.positions.middleRows(3 * j, 3);
    const Eigen::RowVectorXd squared =
        (joint.colwise() - mean.segment<3>(3 * j)).colwise().squaredNorm();
    spread[j] = std::sqrt(squared.dot(neighbours.weights));
  }
  return spread;
}

Eigen::VectorXd sensor_misfit_mps2(const Neighbourhood& neighbours, std::span<const Signal> signals,
                                   const FeatureRows& signal_rows,
                                   const Eigen::RowVectorXf& measured) {
  Eigen::RowVectorXd retrieved = Eigen::RowVectorXd::Zero(signal_rows.cols());
  for (std::size_t i = 0; i < neighbours.paths.size(); ++i)
    retrieved += neighbours.weights[static_cast<Eigen::Index>(i)] *
                 signal_rows.row(neighbours.paths[i].frame).cast<double>();
  const Eigen::RowVectorXd misfit = measured.cast<double>() - retrieved;
  std::vector<double> norms;
  for (std::size_t s = 0; s < signals.size(); ++s)
    if (signals[s].channel == Channel::specific_force)
      norms.push_back(misfit.segment<3>(static_cast<Eigen::Index>(3 * s)).norm());
  return Eigen::Map<const Eigen::VectorXd>(norms.data(), static_cast<Eigen::Index>(norms.size()));
}

}  // namespace

Diagnostics retrieval_diagnostics(const MotionDatabase& database, const Neighbourhood& neighbours,
                                  std::span<const Signal> signals, const FeatureRows& signal_rows,
                                  const Eigen::RowVectorXf& measured) {
  const int frame = neighbours.paths.front().frame;
  Diagnostics out;
  out["sensor_misfit_mps2"] = sensor_misfit_mps2(neighbours, signals, signal_rows, measured);
  out["spread_m"] = spread_m(neighbours);
  out["clip"] = Eigen::VectorXd::Constant(1, database.clip_index(frame));
  out["database_frame"] = Eigen::VectorXd::Constant(1, frame);
  return out;
}

}  // namespace sparse_mocap::retrieval
