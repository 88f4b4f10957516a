// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/reconstructor.hpp"

#include <cmath>
#include <cstdio>
#include <utility>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/eom2014/frame_path.hpp"
#include "sparse_mocap/eom2014/synthesis.hpp"
#include "sparse_mocap/motion/contacts.hpp"

namespace sparse_mocap::eom2014 {
namespace {

constexpr double kWorthSaying_rad = 5.0 * kRadiansPerDegree;
// What readings of a movement have that the model knows nothing of: found on walks, which have
// misfits of 0.4 to 0.8 and turn 0.4 to 1.6 times as much as other people's, and other movements.
constexpr double kUnlikeMisfit = 0.9;
constexpr double kUnlikeTurning = 0.35;
constexpr double kClearly = 0.8;  // smaller, of misfits of the other leg

std::string site_name(int site) {
  return std::string(all_sites().at(static_cast<std::size_t>(site)).name);
}

std::size_t index_of(const TrainedModel& model, int site) {
  std::string known;
  for (std::size_t i = 0; i < model.sites.size(); ++i) {
    if (model.sites[i].site == site) return i;
    known += (i == 0 ? "" : ", ") + site_name(model.sites[i].site);
  }
  throw ConfigError("the model was trained for a sensor at " + known + ", not at " +
                    site_name(site));
}

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

// How far the specific force of the nearest training frame is from each reading's; known, own: the
// features of both.
Eigen::VectorXd force_misfits(const ReadingRows& readings, const SiteModel& site,
                              const Eigen::MatrixXd& known, const Eigen::MatrixXd& own) {
  Eigen::VectorXd out(readings.rows());
  for (Eigen::Index t = 0; t < readings.rows(); ++t) {
    Eigen::Index nearest = 0;
    (known.rowwise() - own.row(t)).rowwise().squaredNorm().minCoeff(&nearest);
    out[t] = (readings.row(t) - site.readings.row(nearest)).head<3>().norm();
  }
  return out;
}

std::vector<PoseEstimate> estimates_of(const Motion& motion, const std::vector<Reading>& take,
                                       const MappedFrames& frames,
                                       const Eigen::VectorXd& misfits_mps2) {
  const Eigen::Matrix2Xd contacts = foot_contacts(motion);
  std::vector<PoseEstimate> estimates;
  for (int t = 0; t < motion.num_frames(); ++t) {
    const auto at = static_cast<std::size_t>(t);
    PoseEstimate estimate;
    estimate.time_s = take[at].time_s;
    for (int j = 0; j < motion.skeleton.num_joints(); ++j)
      estimate.rotations.push_back(motion.rotation(t, j));
    estimate.root_position = motion.root_positions[at];
    estimate.contacts = contacts.col(t);
    estimate.diagnostics["phase"] =
        Eigen::VectorXd::Constant(1, static_cast<double>(frames.phases[at]));
    if (frames.latent.rows() > 0) estimate.diagnostics["latent"] = frames.latent.row(t);
    estimate.diagnostics["sensor_misfit_mps2"] = Eigen::VectorXd::Constant(1, misfits_mps2[t]);
    estimates.push_back(std::move(estimate));
  }
  return estimates;
}

}  // namespace

Reconstructor::Reconstructor(const MethodSettings& settings, const MethodContext& context)
    : config_(with_model(settings, *context.model)),
      model_(restored(*context.model, config_)),
      skeleton_(context.body ? *context.body : model_.skeleton),
      leg_scale_(leg_length_m(bones_of(skeleton_)) / leg_length_m(bones_of(model_.skeleton))),
      site_(index_of(model_, context.sensors.front().site)) {}

SensorTurn Reconstructor::turn_at(const SiteModel& site, const ReadingRows& readings) const {
  if (config_.estimates_mounting) return estimated_turn(readings, site);
  SensorTurn as_it_is;
  as_it_is.misfit = misfit_of(readings, site);
  return as_it_is;
}

// The sensor may be turned on its limb; how it is, and how each leg fits, is noted.
ReadingRows Reconstructor::in_site_axes(const ReadingRows& readings) {
  const SiteModel& site = model_.sites[site_];
  const SensorTurn turn = turn_at(site, readings);
  const std::string name = site_name(site.site);
  if (turn.is_negated)
    notes_.emplace_back("accelerations were negated, since they have the sign of an iPhone's");
  if (std::abs(turn.turn_rad) > kWorthSaying_rad)
    notes_.push_back("the sensor at " + name + " is turned by " +
                     std::to_string(std::lround(std::abs(turn.turn_rad) / kRadiansPerDegree)) +
                     " degrees about the limb; this was corrected");
  for (std::size_t other = 0; other < model_.sites.size(); ++other) {
    if (other == site_) continue;
    const double misfit = turn_at(model_.sites[other], readings).misfit;
    notes_.push_back("misfit of the readings: " + rounded(turn.misfit) + " as " + name + ", " +
                     rounded(misfit) + " as " + site_name(model_.sites[other].site) +
                     (misfit < kClearly * turn.misfit ? "; is the sensor on the other leg?" : ""));
  }
  const double turning =
      ReadingScale::of(readings).deviation.tail<3>().norm() / site.scale.deviation.tail<3>().norm();
  if (turn.misfit > kUnlikeMisfit || turning < kUnlikeTurning)
    notes_.emplace_back(
        "the recording is unlike the clips that the model was trained on, so the motion is a "
        "guess");
  return turn.corrected(readings);
}

std::vector<PoseEstimate> Reconstructor::solve(const std::vector<Reading>& take,
                                               const Progress& progress) {
  constexpr std::size_t kParts = 3;
  notes_.clear();
  // Section 4.1: readings are at even times already; noise is filtered.
  ReadingRows readings = in_si_units(reading_rows(take, config_.rate_hz), notes_);
  readings = smoothed(readings, config_.reading_smoothing_s * config_.rate_hz);
  progress.report(0, kParts, "finding how the sensor is worn");
  readings = in_site_axes(readings);
  // Sections 6.1 and 6.2: phases, latent points, poses.
  progress.report(1, kParts, "reconstructing");
  const SiteModel& site = model_.sites[site_];
  MappedFrames frames = mapped(model_, site, readings, config_);
  const Eigen::MatrixXd known = training_features(site, model_.begins, config_.window_frames);
  const Eigen::MatrixXd own = features(readings, site.scale, config_.window_frames);
  frames.poses.col(kHeightChannel) *= leg_scale_;
  frames.root_velocities.leftCols<2>() *= leg_scale_;
  Motion motion = motion_of(skeleton_, config_.rate_hz, frames.poses, frames.root_velocities);
  smooth_rotations(motion, config_.smoothing_passes);
  progress.report(2, kParts, "placing the feet");
  if (config_.stops_skating) stop_skating(motion);
  auto estimates = estimates_of(motion, take, frames, force_misfits(readings, site, known, own));
  const auto votes = extremity_votes(
      model_.extremities, frame_posterior(own, known, model_.begins, config_.path_width));
  for (std::size_t t = 0; t < estimates.size(); ++t) estimates[t].extremities = votes[t];
  return estimates;
}

}  // namespace sparse_mocap::eom2014
