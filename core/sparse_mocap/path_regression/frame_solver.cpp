// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/frame_solver.hpp"

#include <algorithm>
#include <utility>

#include "sparse_mocap/path_regression/oriented_limbs.hpp"
#include "sparse_mocap/path_regression/regression.hpp"
#include "sparse_mocap/retrieval/diagnostics.hpp"
#include "sparse_mocap/retrieval/extremity_vote.hpp"
#include "sparse_mocap/retrieval/root_motion.hpp"
#include "sparse_mocap/retrieval/standing_feet.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::path_regression {

using namespace retrieval;

namespace {

std::vector<float> column_weights(const std::vector<Signal>& signals, const Config& config) {
  std::vector<float> weights;
  for (const auto& signal : signals) {
    const double unit = signal.channel == Channel::gravity_direction ? config.gravity_weight_mps2
                        : signal.channel == Channel::orientation ? config.orientation_weight_mps2
                                                                 : 1.0;
    const double leg = is_on_leg(signal) ? config.leg_weight : 1.0;
    weights.insert(weights.end(), 3, static_cast<float>(unit * leg));
  }
  return weights;
}

// How much the mean of poses counts that differ by spread_m, a joint: half at wide_spread_m.
double agreement(const Eigen::VectorXd& spread_m, double wide_spread_m) {
  const double mean_square = spread_m.squaredNorm() / static_cast<double>(spread_m.size());
  return 1.0 / (1.0 + mean_square / (wide_spread_m * wide_spread_m));
}

}  // namespace

FrameSolver::FrameSolver(const Config& config, const MethodContext& context)
    : database_(context.database),
      signals_(all_signals(with_turning(context.sensors))),
      num_sensors_(static_cast<Eigen::Index>(context.sensors.size())),
      column_weights_(column_weights(signals_, config)),
      features_(config.features, database_->rate_hz()),
      regression_features_(config.regression_features, database_->rate_hz()),
      signal_rows_(database_signals(*database_, signals_)),
      index_(database_features(*database_, signal_rows_, features_, column_weights_),
             searched_frames(*database_, config.use_tempo_copies, context.excluded_clips)),
      config_(config),
      standing_heights_(*database_) {
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

RetrievedFrame FrameSolver::retrieve(const std::vector<Path>& paths, const SignalWindow& window,
                                     const Reading& reading) const {
  WeightedPaths weighted;
  weighted.paths = best_paths(paths, config_.num_paths);
  weighted.weights = softmax_weights(weighted.paths, config_.sharpness);
  RetrievedFrame frame;
  const Eigen::VectorXd weights =
      config_.regression_ridge > 0.0 ? regressed(weighted, window) : weighted.weights;
  MeanPoints mean = mean_points(weighted.paths, weights);
  place_oriented_limbs(database_->skeleton(), signals_, window.rows.row(window.at),
                       config_.fit.lever_m, mean.now);
  if (mean.before.size() > 0) {
    const Eigen::Index before = std::max(window.at - 1, window.begin);
    place_oriented_limbs(database_->skeleton(), signals_, window.rows.row(before),
                         config_.fit.lever_m, mean.before);
    frame.target.step = mean.now - mean.before;
  }
  frame.target.points = std::move(mean.now);
  frame.target.inclination = inclination_target(database_->skeleton(), reading, signals_);
  frame.target.turning = turning_targets(reading, signals_);
  frame.target.root = root_rates(*database_, weighted);
  frame.extremities = extremity_vote(*database_, weighted);
  frame.target.root.height_m = root_height_m(*database_, weighted, standing_heights_);
  frame.target.feet = feet(weighted, window);
  frame.diagnostics = retrieval_diagnostics(*database_, weighted, signals_, signal_rows_,
                                            window.rows.row(window.at));
  frame.target.agreement = agreement(frame.diagnostics.at("spread_m"), config_.wide_spread_m);
  return frame;
}

// The weights by which the regression from signals to poses predicts.
Eigen::VectorXd FrameSolver::regressed(const WeightedPaths& weighted,
                                       const SignalWindow& window) const {
  const Eigen::Index dimensions =
      regression_features_.num_dimensions(static_cast<int>(signals_.size()));
  const auto size = static_cast<std::size_t>(dimensions);
  Eigen::MatrixXf features(dimensions, static_cast<Eigen::Index>(weighted.paths.size()));
  for (std::size_t i = 0; i < weighted.paths.size(); ++i) {
    const int frame = weighted.paths[i].frame;
    const Clip& clip = clip_at(*database_, frame);
    feature_at({signal_rows_, clip.begin, clip.end, frame}, regression_features_, column_weights_,
               {features.data() + static_cast<Eigen::Index>(i) * dimensions, size});
  }
  Eigen::VectorXf query(dimensions);
  feature_at(window, regression_features_, column_weights_, {query.data(), size});
  return regression_weights(features, query, weighted.weights, config_.regression_ridge);
}

// The retrieved frames' vote, together with how still the shanks' own sensors are.
StandingFeet FrameSolver::feet(const WeightedPaths& weighted, const SignalWindow& window) const {
  StandingFeet feet = standing_feet(*database_, weighted, standing_heights_);
  const Eigen::Index before = std::max(window.at - 1, window.begin);
  const Eigen::Index after = std::min(window.at + 1, window.end - 1);
  const double span = static_cast<double>(std::max<Eigen::Index>(after - before, 1));
  for (std::size_t s = 0; s < signals_.size(); ++s) {
    if (signals_[s].channel != Channel::specific_force) continue;
    const int carrier = all_sites()[static_cast<std::size_t>(signals_[s].site)].carrier;
    for (const auto& [side, shank] :
         {std::pair{0, standard_joint::ltibia}, std::pair{1, standard_joint::rtibia}}) {
      if (carrier != shank) continue;
      const auto column = static_cast<Eigen::Index>(3 * s);
      const Eigen::RowVector3f change =
          window.rows.row(after).segment<3>(column) - window.rows.row(before).segment<3>(column);
      feet.certainty[side] =
          standing_certainty(feet.certainty[side], static_cast<double>(change.norm()) / span);
    }
  }
  return feet;
}

// Paths follow one another through the same clips, so most frames stand at an end and before
// another.
FrameSolver::MeanPoints FrameSolver::mean_points(const std::vector<Path>& paths,
                                                 const Eigen::VectorXd& weights) const {
  struct Used {
    int frame;
    double now, before;  // weights
  };
  std::vector<Used> all;
  const bool with_step = config_.fit.step > 0.0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const int frame = paths[i].frame;
    const double weight = weights[static_cast<Eigen::Index>(i)];
    all.push_back({frame, weight, 0.0});
    if (with_step)
      all.push_back({std::max(frame - 1, clip_at(*database_, frame).begin), 0.0, weight});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Used& a, const Used& b) { return a.frame < b.frame; });
  const Skeleton& skeleton = database_->skeleton();
  MeanPoints mean{Eigen::VectorXd::Zero(12 * skeleton.num_joints()), {}};
  if (with_step) mean.before.setZero(mean.now.size());
  JointTransforms pose;
  Eigen::VectorXd angles;
  for (auto used = all.begin(); used != all.end();) {
    Used sum{used->frame, 0.0, 0.0};
    for (; used != all.end() && used->frame == sum.frame; ++used) {
      sum.now += used->now;
      sum.before += used->before;
    }
    angles = database_->angles().row(sum.frame).transpose().cast<double>();
    forward_kinematics(skeleton, Vec3::Zero(), angles, pose);
    const Eigen::VectorXd points = pose_points(pose, config_.fit.lever_m);
    mean.now += sum.now * points;
    if (with_step) mean.before += sum.before * points;
  }
  return mean;
}

}  // namespace sparse_mocap::path_regression
