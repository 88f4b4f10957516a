// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/regression.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace sparse_mocap::path_regression {
namespace {

// Memory that is used again and again.
struct Workspace {
  std::vector<Eigen::Index> known;  // dimensions of the query
  Eigen::MatrixXf centred, rooted, covariance;
  Eigen::VectorXf weights, rooted_weights, mean, direction, lean;
  Eigen::LLT<Eigen::MatrixXf> decomposition;
};

// The dimensions that the query has, around their weighted mean.
void centre(const Eigen::MatrixXf& features, Workspace& work) {
  const auto count = static_cast<Eigen::Index>(work.known.size());
  work.centred.resize(count, features.cols());
  for (Eigen::Index i = 0; i < features.cols(); ++i)
    for (Eigen::Index d = 0; d < count; ++d)
      work.centred(d, i) = features(work.known[static_cast<std::size_t>(d)], i);
  work.mean.noalias() = work.centred * work.weights;
  work.centred.colwise() -= work.mean;
}

// In pieces that Eigen multiplies without memory of the heap.
void put_covariance(Workspace& work) {
  constexpr Eigen::Index kOnStack = 32'768;  // floats
  const Eigen::Index dimensions = work.centred.rows(), count = work.centred.cols();
  work.rooted.noalias() = work.centred * work.rooted_weights.asDiagonal();
  work.covariance.setZero(dimensions, dimensions);
  const Eigen::Index piece = std::max<Eigen::Index>(kOnStack / dimensions, 1);
  for (Eigen::Index begin = 0; begin < count; begin += piece)
    work.covariance.selfadjointView<Eigen::Lower>().rankUpdate(
        work.rooted.middleCols(begin, std::min(piece, count - begin)));
}

}  // namespace

Eigen::VectorXd regression_weights(const Eigen::MatrixXf& features, const Eigen::VectorXf& query,
                                   const Eigen::VectorXd& weights, double ridge) {
  Eigen::VectorXd out;
  put_regression_weights(features, query, weights, ridge, out);
  return out;
}

void put_regression_weights(const Eigen::MatrixXf& features, const Eigen::VectorXf& query,
                            const Eigen::VectorXd& weights, double ridge, Eigen::VectorXd& out) {
  static thread_local Workspace work;
  work.known.clear();
  for (Eigen::Index d = 0; d < query.size(); ++d)
    if (!std::isnan(query[d])) work.known.push_back(d);
  out = weights;
  if (work.known.empty()) return;
  work.weights = weights.cast<float>();
  work.rooted_weights = work.weights.cwiseSqrt();
  centre(features, work);
  const Eigen::Index dimensions = work.centred.rows();
  put_covariance(work);
  const float mean_variance = work.covariance.trace() / static_cast<float>(dimensions);
  if (!(mean_variance > 0.0F)) return;
  work.covariance.diagonal().array() += static_cast<float>(ridge) * mean_variance;
  work.direction.resize(dimensions);
  for (Eigen::Index d = 0; d < dimensions; ++d)
    work.direction[d] = query[work.known[static_cast<std::size_t>(d)]] - work.mean[d];
  work.decomposition.compute(work.covariance);
  work.decomposition.solveInPlace(work.direction);
  work.lean.noalias() = work.centred.transpose() * work.direction;
  out.array() *= 1.0 + work.lean.cast<double>().array();
}

}  // namespace sparse_mocap::path_regression
