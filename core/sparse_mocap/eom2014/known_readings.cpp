// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/known_readings.hpp"

namespace sparse_mocap::eom2014 {
namespace {

constexpr int kWindow = 8;          // readings to both sides that tell a type
constexpr double kWidth = 0.5;      // of readings about those of a type, in deviations
constexpr double kChanging = 0.01;  // the probability to change the type from frame to frame

// How far each reading is from the nearest one of each type, squared.
Eigen::MatrixXd squared_misfits(const ReadingRows& readings, const KnownReadings& known) {
  const Eigen::MatrixXd distances =
      squared_distances(features(readings, known.scale, kWindow),
                        sequence_features(known.rows, known.begins, known.scale, kWindow));
  const std::size_t num_types = known.type_begins.size();
  Eigen::MatrixXd out(readings.rows(), static_cast<Eigen::Index>(num_types));
  for (std::size_t k = 0; k < num_types; ++k) {
    const Eigen::Index begin = known.type_begins[k];
    const Eigen::Index end = k + 1 < num_types ? known.type_begins[k + 1] : distances.cols();
    out.col(static_cast<Eigen::Index>(k)) =
        distances.middleCols(begin, end - begin).rowwise().minCoeff();
  }
  return out;
}

}  // namespace

KnownReadings KnownReadings::of(const TrainedModel& model, std::size_t site) {
  KnownReadings known;
  Eigen::Index num_frames = 0;
  for (const auto& type : model.types) num_frames += type.sites[site].readings.rows();
  known.rows.resize(num_frames, 6);
  Eigen::Index at = 0;
  for (const auto& type : model.types) {
    const ReadingRows& own = type.sites[site].readings;
    known.rows.middleRows(at, own.rows()) = own;
    known.type_begins.push_back(at);
    for (const int begin : type.begins) known.begins.push_back(static_cast<int>(at) + begin);
    at += own.rows();
  }
  known.scale = ReadingScale::of(known.rows);
  return known;
}

Eigen::MatrixXd type_weights(const ReadingRows& readings, const KnownReadings& known) {
  const auto num_types = static_cast<Eigen::Index>(known.type_begins.size());
  const Eigen::Index n = readings.rows();
  if (num_types == 1) return Eigen::MatrixXd::Ones(n, 1);
  Eigen::MatrixXd emitted = squared_misfits(readings, known);
  emitted.colwise() -= emitted.rowwise().minCoeff().eval();
  emitted = (-0.5 / (kWidth * kWidth) * emitted.array()).exp();
  const double to_any = kChanging / static_cast<double>(num_types);
  const auto gone_on = [&](const Eigen::RowVectorXd& from) -> Eigen::RowVectorXd {
    return ((1.0 - kChanging) * from.array() + to_any * from.sum()).matrix();
  };
  Eigen::MatrixXd weights = emitted;
  for (Eigen::Index t = 0; t < n; ++t) {
    if (t > 0) weights.row(t).array() *= gone_on(weights.row(t - 1)).array();
    weights.row(t) /= weights.row(t).sum();
  }
  Eigen::RowVectorXd ahead = Eigen::RowVectorXd::Ones(num_types);
  for (Eigen::Index t = n - 2; t >= 0; --t) {
    ahead = gone_on(ahead.cwiseProduct(emitted.row(t + 1)));
    ahead /= ahead.sum();
    weights.row(t).array() *= ahead.array();
    weights.row(t) /= weights.row(t).sum();
  }
  return weights;
}

}  // namespace sparse_mocap::eom2014
