// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/frame_solver.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <tuple>
#include <utility>

#include "sparse_mocap/path_regression/oriented_limbs.hpp"
#include "sparse_mocap/path_regression/recent_points.hpp"
#include "sparse_mocap/path_regression/regression.hpp"
#include "sparse_mocap/path_regression/sensor_turning.hpp"
#include "sparse_mocap/retrieval/diagnostics.hpp"
#include "sparse_mocap/retrieval/extremity_vote.hpp"
#include "sparse_mocap/retrieval/real_readings.hpp"
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

// A row with those next to it, so that limbs do not tremble as orientations do.
void put_steady_row(const SignalWindow& window, Eigen::Index row, Eigen::RowVectorXf& steady) {
  const auto before = window.rows.row(std::max(row - 1, window.begin));
  const auto after = window.rows.row(std::min(row + 1, window.end - 1));
  steady = 0.25F * before + 0.5F * window.rows.row(row) + 0.25F * after;
  for (Eigen::Index column = 0; column < steady.size(); ++column)
    if (std::isnan(steady[column])) steady[column] = window.rows(row, column);
}

HeadingSettings heading_settings(const std::vector<Sensor>& sensors, const Config& config,
                                 double rate_hz) {
  HeadingSettings settings;
  for (const Sensor& sensor : sensors)
    settings.is_own.push_back(has_own_heading(sensor, config.use_own_headings));
  settings.rate_hz = rate_hz;
  settings.memory_s = config.heading_memory_s;
  return settings;
}

std::uint64_t next_number() {
  static std::atomic<std::uint64_t> last = 0;
  return ++last;
}

}  // namespace

FrameSolver::FrameSolver(const Config& config, const MethodContext& context)
    : number_(next_number()),
      database_(context.database),
      signals_(all_signals(with_turning(context.sensors, config.use_own_headings))),
      num_sensors_(static_cast<Eigen::Index>(context.sensors.size())),
      column_weights_(column_weights(signals_, config)),
      features_(config.features, database_->rate_hz()),
      regression_features_(config.regression_features, database_->rate_hz()),
      signal_rows_(database_signals(*database_, signals_)),
      index_(database_features(*database_, signal_rows_, features_, column_weights_),
             searched_frames(*database_, config.use_tempo_copies, context.excluded_clips)),
      distance_factors_(distance_factors(*database_, signals_, config.real_preference)),
      config_(config),
      headings_(heading_settings(context.sensors, config, database_->rate_hz())),
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

bool FrameSolver::has_headings() const {
  return std::any_of(signals_.begin(), signals_.end(),
                     [](const Signal& signal) { return signal.channel == Channel::orientation; });
}

bool FrameSolver::has_own_headings() const {
  return std::find(headings_.is_own.begin(), headings_.is_own.end(), true) !=
         headings_.is_own.end();
}

void FrameSolver::search(const SignalWindow& window, std::vector<Neighbour>& out) const {
  static thread_local std::vector<float> feature;
  feature.resize(static_cast<std::size_t>(index_.num_dimensions()));
  feature_at(window, features_, column_weights_, feature);
  index_.search(feature, config_.num_neighbours, out);
  if (!distance_factors_.empty()) scale_distances(*database_, distance_factors_, out);
}

void FrameSolver::retrieve(const std::vector<Path>& paths, const SignalWindow& window,
                           const Reading& reading, RetrievedFrame& frame) const {
  static thread_local WeightedPaths weighted;
  static thread_local Eigen::VectorXd weights;
  put_weights(paths, window, weighted, weights);
  put_points(weighted.paths, weights, window, frame);
  put_inclination_target(database_->skeleton(), reading, signals_, frame.target.inclination);
  put_turning_targets(reading, signals_, frame.target.turning);
  frame.target.root = root_rates(*database_, weighted);
  frame.extremities = extremity_vote(*database_, weighted);
  frame.target.root.height_m = root_height_m(*database_, weighted, standing_heights_);
  frame.target.feet = feet(weighted, window);
  put_retrieval_diagnostics(*database_, weighted, signals_, signal_rows_,
                            window.rows.row(window.at), frame.diagnostics);
  frame.target.agreement =
      agreement(frame.diagnostics.find("spread_m")->second, config_.wide_spread_m);
}

Eigen::MatrixXf FrameSolver::positions(const std::vector<Path>& paths) const {
  Eigen::MatrixXf out(database_->positions().cols(), static_cast<Eigen::Index>(paths.size()));
  for (std::size_t i = 0; i < paths.size(); ++i)
    out.col(static_cast<Eigen::Index>(i)) = database_->positions().row(paths[i].frame).transpose();
  return out;
}

void FrameSolver::retrieve_posed_sensors(const std::vector<Path>& paths, const SignalWindow& window,
                                         std::vector<Mat3>& posed_sensors) const {
  static thread_local WeightedPaths weighted;
  static thread_local Eigen::VectorXd weights, points, before;
  put_weights(paths, window, weighted, weights);
  put_mean_points(weighted.paths, weights, points, before);
  posed_sensors.resize(static_cast<std::size_t>(num_sensors_));
  put_posed_sensors(database_->skeleton(), signals_, config_.fit.lever_m, points, posed_sensors);
}

// The best paths, their own weights, and those by which poses are averaged.
void FrameSolver::put_weights(const std::vector<Path>& paths, const SignalWindow& window,
                              WeightedPaths& weighted, Eigen::VectorXd& weights) const {
  put_best_paths(paths, config_.num_paths, weighted.paths);
  put_softmax_weights(weighted.paths, config_.sharpness, weighted.weights);
  weights = weighted.weights;
  if (config_.regression_ridge > 0.0) put_regressed(weighted, window, weights);
}

// The weights by which the regression from signals to poses predicts.
void FrameSolver::put_regressed(const WeightedPaths& weighted, const SignalWindow& window,
                                Eigen::VectorXd& weights) const {
  static thread_local Eigen::MatrixXf features;
  static thread_local Eigen::VectorXf query;
  const Eigen::Index dimensions =
      regression_features_.num_dimensions(static_cast<int>(signals_.size()));
  const auto size = static_cast<std::size_t>(dimensions);
  features.resize(dimensions, static_cast<Eigen::Index>(weighted.paths.size()));
  for (std::size_t i = 0; i < weighted.paths.size(); ++i) {
    const int frame = weighted.paths[i].frame;
    const Clip& clip = clip_at(*database_, frame);
    feature_at({signal_rows_, clip.begin, clip.end, frame}, regression_features_, column_weights_,
               {features.data() + static_cast<Eigen::Index>(i) * dimensions, size});
  }
  query.resize(dimensions);
  feature_at(window, regression_features_, column_weights_, {query.data(), size});
  put_regression_weights(features, query, weighted.weights, config_.regression_ridge, weights);
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

// The mean of the retrieved poses, its limbs turned as their sensors measure, and how it moves.
void FrameSolver::put_points(const std::vector<Path>& paths, const Eigen::VectorXd& weights,
                             const SignalWindow& window, RetrievedFrame& frame) const {
  static thread_local Eigen::VectorXd before;
  FrameTarget& target = frame.target;
  put_mean_points(paths, weights, target.points, before);
  frame.posed_sensors.resize(static_cast<std::size_t>(num_sensors_));
  put_posed_sensors(database_->skeleton(), signals_, config_.fit.lever_m, target.points,
                    frame.posed_sensors);
  target.step.resize(before.size());
  if (before.size() > 0) target.step = target.points - before;
  const auto place = [&](Eigen::Index row, Eigen::VectorXd& points) {
    static thread_local Eigen::RowVectorXf steady;
    put_steady_row(window, row, steady);
    return place_oriented_limbs(database_->skeleton(), signals_, steady, config_.fit.lever_m,
                                points);
  };
  const int num_placed = place(window.at, target.points);
  if (before.size() == 0 || num_placed == 0) return;
  // A limb that is placed from now on has not moved there.
  if (place(std::max(window.at - 1, window.begin), before) == num_placed)
    target.step = target.points - before;
}

// The weighted means of the points at the paths' ends and, where the fit uses steps, a frame before
// them inside their clips (otherwise empty). Paths follow one another through the same clips, so
// most frames stand at an end and before another.
void FrameSolver::put_mean_points(const std::vector<Path>& paths, const Eigen::VectorXd& weights,
                                  Eigen::VectorXd& now, Eigen::VectorXd& before) const {
  struct Used {
    int frame;
    double now, before;  // weights
  };
  static thread_local std::vector<Used> all;
  static thread_local RecentPoints recent;
  all.clear();
  const bool with_step = config_.fit.step > 0.0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const int frame = paths[i].frame;
    const double weight = weights[static_cast<Eigen::Index>(i)];
    all.push_back({frame, weight, 0.0});
    if (with_step)
      all.push_back({std::max(frame - 1, clip_at(*database_, frame).begin), 0.0, weight});
  }
  std::sort(all.begin(), all.end(), [](const Used& a, const Used& b) {
    return std::tie(a.frame, a.now, a.before) < std::tie(b.frame, b.now, b.before);
  });
  now.setZero(12 * database_->skeleton().num_joints());
  before.setZero(with_step ? now.size() : 0);
  recent.begin(number_, *database_, config_.fit.lever_m, all.size());
  for (auto used = all.begin(); used != all.end();) {
    Used sum{used->frame, 0.0, 0.0};
    for (; used != all.end() && used->frame == sum.frame; ++used) {
      sum.now += used->now;
      sum.before += used->before;
    }
    const Eigen::VectorXd& points = recent.of(sum.frame);
    now += sum.now * points;
    if (with_step) before += sum.before * points;
  }
}

}  // namespace sparse_mocap::path_regression
