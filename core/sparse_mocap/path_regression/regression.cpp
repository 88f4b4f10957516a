// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/regression.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace sparse_mocap::path_regression {
namespace {

using MatrixMap = Eigen::Map<Eigen::MatrixXf>;
using VectorMap = Eigen::Map<Eigen::VectorXf>;

// Memory that is used again and again. It only grows: a query that lacks some dimensions, since a
// sensor is silent, needs none.
struct Workspace {
  std::vector<Eigen::Index> known;  // dimensions of the query
  std::vector<float> centred, rooted, covariance, mean, direction;
  Eigen::VectorXf weights, rooted_weights, lean;
};

MatrixMap shaped(std::vector<float>& memory, Eigen::Index rows, Eigen::Index columns) {
  const auto size = static_cast<std::size_t>(rows * columns);
  if (memory.size() < size) memory.resize(size);
  return {memory.data(), rows, columns};
}

// The dimensions that the query has, around their weighted mean.
void centre(const Eigen::MatrixXf& features, Workspace& work, MatrixMap& centred, VectorMap& mean) {
  for (Eigen::Index i = 0; i < features.cols(); ++i)
    for (Eigen::Index d = 0; d < centred.rows(); ++d)
      centred(d, i) = features(work.known[static_cast<std::size_t>(d)], i);
  mean.noalias() = centred * work.weights;
  centred.colwise() -= mean;
}

// In pieces that Eigen multiplies without memory of the heap.
void put_covariance(const MatrixMap& centred, Workspace& work, MatrixMap& covariance) {
  constexpr Eigen::Index kOnStack = 32'768;  // floats
  const Eigen::Index dimensions = centred.rows(), count = centred.cols();
  MatrixMap rooted = shaped(work.rooted, dimensions, count);
  rooted.noalias() = centred * work.rooted_weights.asDiagonal();
  covariance.setZero();
  const Eigen::Index piece = std::max<Eigen::Index>(kOnStack / dimensions, 1);
  for (Eigen::Index begin = 0; begin < count; begin += piece)
    covariance.selfadjointView<Eigen::Lower>().rankUpdate(
        rooted.middleCols(begin, std::min(piece, count - begin)));
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
  const auto dimensions = static_cast<Eigen::Index>(work.known.size());
  MatrixMap centred = shaped(work.centred, dimensions, features.cols());
  VectorMap mean(shaped(work.mean, dimensions, 1).data(), dimensions);
  centre(features, work, centred, mean);
  MatrixMap covariance = shaped(work.covariance, dimensions, dimensions);
  put_covariance(centred, work, covariance);
  const float mean_variance = covariance.trace() / static_cast<float>(dimensions);
  if (!(mean_variance > 0.0F)) return;
  covariance.diagonal().array() += static_cast<float>(ridge) * mean_variance;
  VectorMap direction(shaped(work.direction, dimensions, 1).data(), dimensions);
  for (Eigen::Index d = 0; d < dimensions; ++d)
    direction[d] = query[work.known[static_cast<std::size_t>(d)]] - mean[d];
  Eigen::Ref<Eigen::MatrixXf> in_place(covariance);
  Eigen::LLT<Eigen::Ref<Eigen::MatrixXf>>(in_place).solveInPlace(direction);
  work.lean.noalias() = centred.transpose() * direction;
  out.array() *= 1.0 + work.lean.cast<double>().array();
}

}  // namespace sparse_mocap::path_regression
