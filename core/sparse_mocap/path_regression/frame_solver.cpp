// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/frame_solver.hpp"

#include <algorithm>
#include <utility>

#include "sparse_mocap/path_regression/pose_fit.hpp"
#include "sparse_mocap/path_regression/regression.hpp"
#include "sparse_mocap/retrieval/diagnostics.hpp"
#include "sparse_mocap/retrieval/pose_minimizer.hpp"

namespace sparse_mocap::path_regression {

using namespace retrieval;

namespace {

std::vector<float> column_weights(const std::vector<Signal>& signals, const Config& config) {
  std::vector<float> weights;
  for (const auto& signal : signals) {
    const double unit =
        signal.channel == Channel::gravity_direction ? config.gravity_weight_mps2 : 1.0;
    const double leg = is_on_leg(signal) ? config.leg_weight : 1.0;
    weights.insert(weights.end(), 3, static_cast<float>(unit * leg));
  }
  return weights;
}

}  // namespace

FrameSolver::FrameSolver(const Config& config, const MethodContext& context)
    : database_(context.database),
      signals_(compared_signals(context.sensors, true)),
      num_sensors_(static_cast<Eigen::Index>(context.sensors.size())),
      column_weights_(column_weights(signals_, config)),
      features_(config.features, database_->rate_hz()),
      regression_features_(config.regression_features, database_->rate_hz()),
      signal_rows_(database_signals(*database_, signals_)),
      index_(database_features(*database_, signal_rows_, features_, column_weights_),
             searched_frames(*database_, config.use_tempo_copies, context.excluded_clips)),
      config_(config),
      root_(database_->frame_time_s(), config.foot_lock) {
  const int most_neighbours = static_cast<int>(Config::kNeighbourShare * index_.num_rows());
  config_.num_neighbours = std::min(config_.num_neighbours, std::max(most_neighbours, 1));
  config_.num_paths = std::min(config_.num_paths, std::max(config_.num_neighbours / 4, 1));
}

int FrameSolver::look_ahead() const {
  const int search = features_.look_ahead();
  return config_.regression_ridge > 0.0 ? std::max(search, regression_features_.look_ahead())
                                        : search;
}

int FrameSolver::reach_back() const {
  const int search = features_.reach_back();
  return config_.regression_ridge > 0.0 ? std::max(search, regression_features_.reach_back())
                                        : search;
}

void FrameSolver::search(const SignalWindow& window, std::vector<Neighbour>& out) const {
  std::vector<float> feature(static_cast<std::size_t>(index_.num_dimensions()));
  feature_at(window, features_, column_weights_, feature);
  index_.search(feature, config_.num_neighbours, out);
}

SolvedFrame FrameSolver::solve(const std::vector<Path>& paths, const SignalWindow& window,
                               const Reading& reading) {
  auto best = best_paths(paths, config_.num_paths);
  auto weights = softmax_weights(best, config_.sharpness);
  Neighbourhood neighbours =
      gather(*database_, std::move(best), std::move(weights), past_ ? &past_->angles : nullptr);
  if (config_.regression_ridge > 0.0) regress(neighbours, window);
  SolvedFrame frame;
  frame.time_s = reading.time_s;
  frame.angles = fitted_angles(neighbours, reading);
  JointTransforms pose;
  forward_kinematics(database_->skeleton(), Vec3::Zero(), frame.angles, pose);
  frame.positions = stacked_ends(pose);
  const RootRates rates = root_rates(*database_, neighbours);
  root_.advance(rates, frame.positions);
  frame.root_position = root_.position();
  frame.yaw_rad = root_.yaw_rad();
  frame.contacts = rates.contacts;
  frame.diagnostics = retrieval_diagnostics(*database_, neighbours, signals_, signal_rows_,
                                            window.rows.row(window.at));
  past_ = Past{frame.angles, frame.positions};
  return frame;
}

void FrameSolver::reset() {
  root_.reset();
  past_.reset();
}

// Moves the retrieved poses to where the regression from signals to poses says.
void FrameSolver::regress(Neighbourhood& neighbours, const SignalWindow& window) const {
  const Eigen::Index dimensions =
      regression_features_.num_dimensions(static_cast<int>(signals_.size()));
  const auto size = static_cast<std::size_t>(dimensions);
  Eigen::MatrixXf features(dimensions, static_cast<Eigen::Index>(neighbours.paths.size()));
  for (std::size_t i = 0; i < neighbours.paths.size(); ++i) {
    const int frame = neighbours.paths[i].frame;
    const Clip& clip = clip_at(*database_, frame);
    feature_at({signal_rows_, clip.begin, clip.end, frame}, regression_features_, column_weights_,
               {features.data() + static_cast<Eigen::Index>(i) * dimensions, size});
  }
  Eigen::VectorXf query(dimensions);
  feature_at(window, regression_features_, column_weights_, {query.data(), size});
  shift_to_regression(neighbours, regression_weights(features, query, neighbours.weights,
                                                     config_.regression_ridge));
}

// Inverse kinematics in the local linear model of the poses, from the frame before, the mean and
// the best path's pose.
Eigen::VectorXd FrameSolver::fitted_angles(const Neighbourhood& neighbours,
                                           const Reading& reading) const {
  const auto& weights = neighbours.weights;
  std::vector<PositionTarget> positions{
      position_target(config_.pose_weight, neighbours.positions, weights)};
  if (past_ && config_.motion_weight > 0.0) {
    const Eigen::MatrixXd moved = steps_into(neighbours.paths).colwise() + past_->positions;
    positions.push_back(position_target(config_.motion_weight, moved, weights));
  }
  const PoseFit fit(
      database_->skeleton(), std::move(positions),
      inclination_target(config_.gravity_weight, database_->skeleton(), reading, signals_));
  const PoseSubspace subspace = weighted_pca(neighbours.angles, weights, config_.pca_variance);
  std::vector<Eigen::VectorXd> starts{subspace.mean, neighbours.angles.col(0)};
  if (past_) starts.insert(starts.begin(), past_->angles);
  return minimize(fit, subspace, starts, config_.max_iterations).angles;
}

// What the joints' positions change by from the frame before into each path's frame, inside its
// clip: 63 x paths, m.
Eigen::MatrixXd FrameSolver::steps_into(const std::vector<Path>& paths) const {
  const auto& positions = database_->positions();
  Eigen::MatrixXd steps(positions.cols(), static_cast<Eigen::Index>(paths.size()));
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const Clip& clip = clip_at(*database_, paths[i].frame);
    const int into = std::max(paths[i].frame, std::min(clip.begin + 1, clip.end - 1));
    const int from = std::max(into - 1, clip.begin);
    steps.col(static_cast<Eigen::Index>(i)) =
        (positions.row(into) - positions.row(from)).transpose().cast<double>();
  }
  return steps;
}

}  // namespace sparse_mocap::path_regression
