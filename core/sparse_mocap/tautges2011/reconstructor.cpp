// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/reconstructor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/tautges2011/control.hpp"
#include "sparse_mocap/tautges2011/inclination_term.hpp"
#include "sparse_mocap/tautges2011/minimizer.hpp"
#include "sparse_mocap/tautges2011/offline.hpp"
#include "sparse_mocap/tautges2011/prior.hpp"
#include "sparse_mocap/tautges2011/regression.hpp"

namespace sparse_mocap::tautges2011 {
namespace {

std::vector<bool> searched_frames(const MotionDatabase& database, bool use_tempo_copies,
                                  const std::vector<int>& excluded_clips) {
  std::vector<bool> is_searched(static_cast<std::size_t>(database.num_frames()), true);
  for (const Clip& clip : database.clips())
    if (clip.tempo != 1.0 && !use_tempo_copies)
      std::fill(is_searched.begin() + clip.begin, is_searched.begin() + clip.end, false);
  for (const int clip : excluded_clips) {
    if (clip < 0 || clip >= static_cast<int>(database.clips().size()))
      throw ConfigError("excluded clip " + std::to_string(clip) + " is not in the database");
    const Clip& excluded = database.clips()[static_cast<std::size_t>(clip)];
    std::fill(is_searched.begin() + excluded.begin, is_searched.begin() + excluded.end, false);
  }
  if (std::none_of(is_searched.begin(), is_searched.end(), [](bool b) { return b; }))
    throw ConfigError("every clip of the database is excluded");
  return is_searched;
}

std::vector<float> column_weights(const std::vector<WornSensor>& sensors, const Config& config) {
  using namespace standard_joint;
  std::vector<float> weights;
  for (const auto& sensor : sensors) {
    const int carrier = all_sites()[static_cast<std::size_t>(sensor.site)].carrier;
    const bool is_leg =
        carrier == ltibia || carrier == rtibia || carrier == lfemur || carrier == rfemur;
    const double unit = sensor.quantity == Quantity::up ? config.up_weight_mps2 : 1.0;
    weights.insert(weights.end(), 3, static_cast<float>(unit * (is_leg ? config.leg_weight : 1.0)));
  }
  return weights;
}

std::vector<std::int32_t> clips_of_frames(const MotionDatabase& database) {
  std::vector<std::int32_t> clips;
  for (int frame = 0; frame < database.num_frames(); ++frame)
    clips.push_back(database.clip_index(frame));
  return clips;
}

const Config& validated(const Config& config, const std::vector<WornSensor>& sensors) {
  config.validate();
  if (sensors.empty()) throw ConfigError("at least one sensor is needed");
  for (std::size_t a = 0; a < sensors.size(); ++a)
    for (std::size_t b = a + 1; b < sensors.size(); ++b)
      if (sensors[a].site == sensors[b].site && sensors[a].quantity == sensors[b].quantity)
        throw ConfigError("two sensors at " +
                          std::string(all_sites()[static_cast<std::size_t>(sensors[a].site)].name));
  return config;
}

}  // namespace

Reconstructor::Reconstructor(std::shared_ptr<const MotionDatabase> database,
                             std::vector<WornSensor> sensors, const Config& config,
                             const std::vector<int>& excluded_clips)
    : database_(std::move(database)),
      sensors_(std::move(sensors)),
      config_(validated(config, sensors_)),
      excluded_clips_(excluded_clips),
      column_weights_(column_weights(sensors_, config_)),
      readings_(database_readings(*database_, sensors_)),
      index_(database_features(*database_, readings_, config_.features, column_weights_),
             searched_frames(*database_, config_.use_tempo_copies, excluded_clips)),
      clip_of_frame_(clips_of_frames(*database_)),
      graph_(clip_of_frame_, config_.olng),
      root_(database_->frame_time_s(), config_.foot_lock) {
  look_ahead_ = config_.features.look_ahead();
  reach_back_ = config_.features.reach_back();
  if (config_.regression_ridge > 0.0) {
    look_ahead_ = std::max(look_ahead_, config_.regression_features.look_ahead());
    reach_back_ = std::max(reach_back_, config_.regression_features.reach_back());
  }
  const int searchable = static_cast<int>(config_.neighbour_fraction * index_.num_rows());
  config_.num_neighbours = std::clamp(config_.num_neighbours, 1, std::max(searchable, 1));
  const int most_paths =
      std::max(Config::kFewestPaths, static_cast<int>(config_.path_fraction * index_.num_rows()));
  config_.num_paths = std::clamp(config_.num_paths, 1,
                                 std::max(std::min(config_.num_neighbours / 4, most_paths), 1));
  recent_.resize(reach_back_ + look_ahead_ + 2, static_cast<Eigen::Index>(3 * sensors_.size()));
}

void Reconstructor::reset() {
  graph_.reset();
  root_.reset();
  past_.reset();
  num_recent_ = 0;
  num_owed_ = 0;
}

std::optional<PoseEstimate> Reconstructor::step(const Reading& reading) {
  if (reading.cols() != static_cast<Eigen::Index>(sensors_.size()))
    throw ConfigError("a reading of " + std::to_string(sensors_.size()) +
                      " sensors is expected, got " + std::to_string(reading.cols()));
  if (num_recent_ == recent_.rows()) {
    recent_.topRows(num_recent_ - 1) = recent_.bottomRows(num_recent_ - 1).eval();
    --num_recent_;
  }
  recent_.row(num_recent_++) = reading.reshaped().transpose().cast<float>();
  if (++num_owed_ <= look_ahead_) return std::nullopt;
  return estimate_online({recent_, 0, num_recent_, num_recent_ - num_owed_});
}

std::vector<PoseEstimate> Reconstructor::flush() {
  std::vector<PoseEstimate> owed;
  while (num_owed_ > 0)
    owed.push_back(estimate_online({recent_, 0, num_recent_, num_recent_ - num_owed_}));
  reset();
  return owed;
}

// Sections 4 and 5 for one frame.
PoseEstimate Reconstructor::estimate_online(const Window& window) {
  --num_owed_;
  search(window, neighbours_);  // S^(t+1), section 3
  graph_.extend(neighbours_);   // section 4
  auto paths = best_paths(graph_.paths(), config_.num_paths);
  auto weights = path_weights(paths, config_.weight_rule, config_.sharpness);  // equation (1)
  return synthesize(std::move(paths), std::move(weights), window);
}

// Section 5: the pose that the paths and the past ask for.
PoseEstimate Reconstructor::synthesize(std::vector<Path> paths, Eigen::VectorXd weights,
                                       const Window& window) {
  Neighbourhood neighbours = gather(*database_, config_, std::move(paths), std::move(weights),
                                    past_ ? &past_->angles : nullptr);
  if (config_.regression_ridge > 0.0) correct_poses(neighbours, window);
  const Eigen::VectorXd angles = minimize_energy(neighbours, reading_at(window));
  return remember(neighbours, angles, window);
}

Eigen::VectorXd Reconstructor::minimize_energy(const Neighbourhood& neighbours,
                                               const Reading& reading) const {
  const double dt = database_->frame_time_s();
  std::vector<KernelTerm> terms{pose_prior(neighbours, config_)};  // equation (5)
  if (past_) {
    const auto& [angles, x, x_before, accelerations] = *past_;
    if (config_.w_motion > 0.0)
      terms.push_back(motion_prior(neighbours, config_, x, dt));  // equation (7)
    if (config_.w_smooth > 0.0)
      terms.push_back(smoothness_prior(neighbours, config_, x, x_before, dt));  // equation (8)
    if (config_.w_contr > 0.0)
      terms.push_back(
          control_term(neighbours, config_, x, accelerations, sensors_, dt));  // equation (11)
  }
  terms.push_back(inclination_term(database_->skeleton(), reading, sensors_, config_.w_inclination,
                                   neighbours.weights.size()));
  const Energy energy(database_->skeleton(), neighbours.weights, std::move(terms));
  const PoseSubspace subspace =
      weighted_pca(neighbours.angles, neighbours.weights, config_.pca_variance);
  std::vector<Eigen::VectorXd> starts;
  if (past_) starts.push_back(past_->angles);
  if (!past_ || config_.is_multi_start) {
    starts.push_back(subspace.mean);
    starts.push_back(neighbours.angles.col(0));
  }
  return minimize(energy, subspace, starts, config_.max_iterations).angles;  // equation (2)
}

PoseEstimate Reconstructor::remember(const Neighbourhood& neighbours, const Eigen::VectorXd& angles,
                                     const Window& window) {
  JointTransforms pose;
  forward_kinematics(database_->skeleton(), Vec3::Zero(), angles, pose);
  PoseEstimate estimate;
  estimate.angles = angles;
  estimate.positions.resize(3 * kNumStandardJoints);
  for (Eigen::Index j = 0; j < kNumStandardJoints; ++j)
    estimate.positions.segment<3>(3 * j) = pose.end[static_cast<std::size_t>(j)];
  const RootRates rates = root_rates(*database_, neighbours);  // section 6.4
  root_.advance(rates, estimate.positions);
  estimate.root_position = root_.position();
  estimate.yaw_rad = root_.yaw_rad();
  estimate.contacts = rates.contacts;
  describe_retrieval(neighbours, window, estimate);
  past_ = Past{angles, estimate.positions, past_ ? past_->positions : estimate.positions,
               heading_accelerations(reading_at(window), pose, sensors_)};
  return estimate;
}

Reading Reconstructor::reading_at(const Window& window) const {
  const Eigen::VectorXd row = window.readings.row(window.at).transpose().cast<double>();
  return row.reshaped(3, static_cast<Eigen::Index>(sensors_.size()));
}

void Reconstructor::search(const Window& window, std::vector<Neighbour>& out) const {
  std::vector<float> feature(static_cast<std::size_t>(index_.num_dimensions()));
  feature_at(window.readings, window.begin, window.end, window.at, config_.features,
             column_weights_, feature);
  index_.search(feature, config_.num_neighbours, out);
}

void Reconstructor::correct_poses(Neighbourhood& neighbours, const Window& window) const {
  const FeatureLayout& layout = config_.regression_features;
  const Eigen::Index dimensions = layout.num_dimensions(static_cast<int>(sensors_.size()));
  const auto size = static_cast<std::size_t>(dimensions);
  Eigen::MatrixXf features(dimensions, static_cast<Eigen::Index>(neighbours.paths.size()));
  for (std::size_t i = 0; i < neighbours.paths.size(); ++i) {
    const int frame = neighbours.paths[i].frame;
    const Clip& clip = database_->clips()[static_cast<std::size_t>(database_->clip_index(frame))];
    feature_at(readings_, clip.begin, clip.end, frame, layout, column_weights_,
               {features.data() + static_cast<Eigen::Index>(i) * dimensions, size});
  }
  Eigen::VectorXf query(dimensions);
  feature_at(window.readings, window.begin, window.end, window.at, layout, column_weights_,
             {query.data(), size});
  shift_to_regression(neighbours, regression_weights(features, query, neighbours.weights,
                                                     config_.regression_ridge));
}

void Reconstructor::describe_retrieval(const Neighbourhood& neighbours, const Window& window,
                                       PoseEstimate& estimate) const {
  estimate.database_frame = neighbours.paths.front().frame;
  estimate.clip = database_->clip_index(estimate.database_frame);
  estimate.spread_m.resize(kNumStandardJoints);
  const Eigen::VectorXd mean = neighbours.positions * neighbours.weights;
  for (Eigen::Index j = 0; j < kNumStandardJoints; ++j) {
    const auto joint = neighbours.positions.middleRows(3 * j, 3);
    const Eigen::RowVectorXd squared =
        (joint.colwise() - mean.segment<3>(3 * j)).colwise().squaredNorm();
    estimate.spread_m[j] = std::sqrt(squared.dot(neighbours.weights));
  }
  Eigen::VectorXd retrieved = Eigen::VectorXd::Zero(readings_.cols());
  for (std::size_t i = 0; i < neighbours.paths.size(); ++i)
    retrieved += neighbours.weights[static_cast<Eigen::Index>(i)] *
                 readings_.row(neighbours.paths[i].frame).transpose().cast<double>();
  const Eigen::Matrix3Xd misfit =
      reading_at(window) - retrieved.reshaped(3, static_cast<Eigen::Index>(sensors_.size()));
  std::vector<double> norms_mps2;
  for (std::size_t s = 0; s < sensors_.size(); ++s)
    if (sensors_[s].quantity == Quantity::specific_force)
      norms_mps2.push_back(misfit.col(static_cast<Eigen::Index>(s)).norm());
  estimate.sensor_misfit_mps2 = Eigen::Map<const Eigen::VectorXd>(
      norms_mps2.data(), static_cast<Eigen::Index>(norms_mps2.size()));
}

std::vector<PoseEstimate> Reconstructor::solve(const std::vector<Reading>& take,
                                               const Progress& progress) {
  if (!config_.offline) return solve_both_ways(take, progress);
  Reconstructor offline(database_, sensors_, *config_.offline, excluded_clips_);
  return offline.solve_both_ways(take, progress);
}

std::vector<PoseEstimate> Reconstructor::solve_both_ways(const std::vector<Reading>& take,
                                                         const Progress& progress) {
  reset();
  FeatureRows readings(static_cast<Eigen::Index>(take.size()), readings_.cols());
  for (std::size_t t = 0; t < take.size(); ++t)
    readings.row(static_cast<Eigen::Index>(t)) = take[t].reshaped().transpose().cast<float>();
  const auto frames = static_cast<std::size_t>(readings.rows());
  TwoWayRetrieval retrieval(clip_of_frame_, config_.olng);
  std::vector<std::vector<Neighbour>> columns(frames);
  for (std::size_t t = 0; t < frames; ++t) {
    progress.report(t, 2 * frames, "searching");
    search({readings, 0, readings.rows(), static_cast<Eigen::Index>(t)}, columns[t]);
  }
  retrieval.run(columns);
  std::vector<PoseEstimate> estimates;
  for (std::size_t t = 0; t < frames; ++t) {
    progress.report(frames + t, 2 * frames, "reconstructing");
    auto paths = best_paths(retrieval.paths(t), config_.num_paths);
    auto weights = path_weights(paths, config_.weight_rule, config_.sharpness);
    estimates.push_back(synthesize(std::move(paths), std::move(weights),
                                   {readings, 0, readings.rows(), static_cast<Eigen::Index>(t)}));
  }
  reset();
  return smoothed_take(estimates, *database_, config_);
}

}  // namespace sparse_mocap::tautges2011
