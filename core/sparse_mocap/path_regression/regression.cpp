// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/regression.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

namespace sparse_mocap::path_regression {

Eigen::VectorXd regression_weights(const Eigen::MatrixXf& features, const Eigen::VectorXf& query,
                                   const Eigen::VectorXd& weights, double ridge) {
  std::vector<Eigen::Index> known;
  for (Eigen::Index d = 0; d < query.size(); ++d)
    if (!std::isnan(query[d])) known.push_back(d);
  if (known.empty()) return weights;
  const Eigen::MatrixXf selected = features(known, Eigen::all);
  const Eigen::VectorXf w = weights.cast<float>();
  const Eigen::VectorXf mean = selected * w;
  const Eigen::MatrixXf centred = selected.colwise() - mean;
  Eigen::MatrixXf covariance = Eigen::MatrixXf::Zero(centred.rows(), centred.rows());
  const Eigen::MatrixXf rooted = centred * w.cwiseSqrt().asDiagonal();
  covariance.selfadjointView<Eigen::Lower>().rankUpdate(rooted);
  const float mean_variance = covariance.trace() / static_cast<float>(covariance.rows());
  if (!(mean_variance > 0.0F)) return weights;
  covariance.diagonal().array() += static_cast<float>(ridge) * mean_variance;
  const Eigen::VectorXf direction =
      covariance.selfadjointView<Eigen::Lower>().llt().solve(query(known) - mean);
  const Eigen::VectorXf lean = centred.transpose() * direction;
  return weights.array() * (1.0 + lean.cast<double>().array());
}

}  // namespace sparse_mocap::path_regression
