// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/prepared_model.hpp"

#include <cmath>
#include <cstdio>
#include <limits>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/eom2014/synthesis.hpp"

namespace sparse_mocap::eom2014 {
namespace {

constexpr double kWorthSaying_rad = 5.0 * kRadiansPerDegree;
// What readings of a movement have that the model knows nothing of: found on walks, which have
// misfits of 0.4 to 0.8 and turn 0.4 to 1.6 times as much as other people's, and other movements.
constexpr double kUnlikeMisfit = 0.9;
constexpr double kUnlikeTurning = 0.35;
constexpr double kClearly = 0.8;  // smaller, of misfits of the other leg
constexpr double kMoving = 0.2;   // of the mean turning in the clips: slower is standing
// Frames in which the path stays or jumps: up to 21 % of walks by anybody, over 30 % of squats,
// throws, grabs and kicks.
constexpr double kMostAstray = 0.25;
constexpr int kLongestStep = 3;

std::string site_name(int site) {
  return std::string(all_sites().at(static_cast<std::size_t>(site)).name);
}

std::size_t index_of(const TrainedModel& model, int site) {
  std::string known;
  for (std::size_t i = 0; i < model.sites().size(); ++i) {
    if (model.sites()[i].site == site) return i;
    known += (i == 0 ? "" : ", ") + site_name(model.sites()[i].site);
  }
  throw ConfigError("the model was trained for a sensor at " + known + ", not at " +
                    site_name(site));
}

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

Eigen::VectorXd single(double value) { return Eigen::VectorXd::Constant(1, value); }

// How much a sensor turns, as a part of how much it does in the least lively type of motion.
double turning(const ReadingRows& readings, const TrainedModel& model, std::size_t site) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& type : model.types)
    least = std::min(least, type.sites[site].scale.deviation.tail<3>().norm());
  return ReadingScale::of(readings).deviation.tail<3>().norm() / least;
}

}  // namespace

double WornSensor::corrected_turning(double rate) const {
  // In degrees a second nothing was known of the vertical.
  if (units.to_radps != 1.0) return std::numeric_limits<double>::quiet_NaN();
  return turn.is_negated ? -rate : rate;
}

PreparedModel::PreparedModel(const MethodSettings& settings, const MethodContext& context)
    : config_(with_model(settings, *context.model)),
      model_(restored(*context.model, config_)),
      skeleton_(context.body ? *context.body : model_.skeleton),
      leg_scale_(leg_length_m(bones_of(skeleton_)) / leg_length_m(bones_of(model_.skeleton))),
      site_(index_of(model_, context.sensors.front().site)) {
  for (std::size_t site = 0; site < model_.sites().size(); ++site)
    known_.push_back(KnownReadings::of(model_, site));
}

SensorTurn PreparedModel::turn_at(std::size_t site, const ReadingRows& readings,
                                  int most_compared) const {
  if (config_.estimates_mounting) return estimated_turn(readings, known_[site], most_compared);
  SensorTurn as_it_is;
  as_it_is.misfit = misfit_of(readings, known_[site]);
  return as_it_is;
}

bool PreparedModel::is_moving(const ReadingRows& readings) const {
  return turning(readings, model_, site_) >= kUnlikeTurning;
}

void PreparedModel::compare_sites(const ReadingRows& readings, const SensorTurn& turn,
                                  int most_compared, std::vector<std::string>& notes) const {
  const std::string name = site_name(model_.sites()[site_].site);
  for (std::size_t other = 0; other < known_.size(); ++other) {
    if (other == site_) continue;
    const double misfit = turn_at(other, readings, most_compared).misfit;
    notes.push_back("misfit of the readings: " + rounded(turn.misfit) + " as " + name + ", " +
                    rounded(misfit) + " as " + site_name(model_.sites()[other].site) +
                    (misfit < kClearly * turn.misfit ? "; is the sensor on the other leg?" : ""));
  }
}

WornSensor PreparedModel::worn(const ReadingRows& readings, int most_compared,
                               std::vector<std::string>& notes) const {
  WornSensor out;
  out.units = units_of(readings, notes);
  const ReadingRows converted = out.units.converted(readings);
  out.turn = turn_at(site_, converted, most_compared);
  if (out.turn.is_negated)
    notes.emplace_back("accelerations were negated, since they have the sign of an iPhone's");
  const double turn_rad = std::abs(out.turn.turn_rad);
  if (turn_rad > kWorthSaying_rad)
    notes.push_back("the sensor at " + site_name(model_.sites()[site_].site) + " is turned by " +
                    std::to_string(std::lround(turn_rad / kRadiansPerDegree)) +
                    " degrees about the limb; this was corrected");
  compare_sites(converted, out.turn, most_compared, notes);
  if (out.turn.misfit > kUnlikeMisfit || !is_moving(converted)) notes.emplace_back(kUnlikeNote);
  return out;
}

bool PreparedModel::follows_clips(const ReadingRows& readings, const MappedFrames& frames) const {
  const double moving_radps = kMoving * known().rows.rightCols<3>().rowwise().norm().mean();
  int num_moving = 0, num_astray = 0;
  for (std::size_t t = 1; t < frames.types.size(); ++t) {
    if (frames.types[t] != frames.types[t - 1]) continue;
    if (readings.row(static_cast<Eigen::Index>(t)).tail<3>().norm() < moving_radps) continue;
    const int step = frames.training_frames[t] - frames.training_frames[t - 1];
    ++num_moving;
    if (step < 1 || step > kLongestStep) ++num_astray;
  }
  return num_astray <= kMostAstray * num_moving;
}

MappedFrames PreparedModel::mapped(const ReadingRows& readings, const FrameRange& range) const {
  MappedFrames frames = eom2014::mapped(model_, site_, known(), readings, config_, range);
  frames.poses.col(kHeightChannel) *= leg_scale_;
  frames.root_velocities.leftCols<2>() *= leg_scale_;
  return frames;
}

Motion PreparedModel::motion_of(const MappedFrames& frames) const {
  Motion motion =
      eom2014::motion_of(skeleton_, config_.rate_hz, frames.poses, frames.root_velocities);
  smooth_rotations(motion, config_.smoothing_passes);
  if (config_.stops_skating) stop_skating(motion);
  return motion;
}

PoseEstimate PreparedModel::estimate(const MappedFrames& frames, const Motion& motion,
                                     Eigen::Index frame) const {
  const auto at = static_cast<std::size_t>(frame);
  PoseEstimate estimate;
  for (int j = 0; j < motion.skeleton.num_joints(); ++j)
    estimate.rotations.push_back(motion.rotation(static_cast<int>(frame), j));
  estimate.root_position = motion.root_positions[at];
  estimate.diagnostics["phase"] = single(static_cast<double>(frames.phases[at]));
  estimate.diagnostics["motion_type"] = single(frames.types[at]);
  estimate.extremities = frames.extremities[at];
  if (frames.latent.rows() > 0) estimate.diagnostics["latent"] = frames.latent.row(frame);
  return estimate;
}

Eigen::VectorXd PreparedModel::force_misfits(const ReadingRows& readings,
                                             const FrameRange& range) const {
  const int window = config_.window_frames;
  const Eigen::MatrixXd own = features(readings, known().scale, window);
  const Eigen::MatrixXd distances =
      squared_distances(own.middleRows(range.begin, range.size()),
                        sequence_features(known().rows, known().begins, known().scale, window));
  Eigen::VectorXd out(range.size());
  for (Eigen::Index t = 0; t < range.size(); ++t) {
    Eigen::Index nearest = 0;
    distances.row(t).minCoeff(&nearest);
    out[t] = (readings.row(range.begin + t) - known().rows.row(nearest)).head<3>().norm();
  }
  return out;
}

}  // namespace sparse_mocap::eom2014
