// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/reconstructor.hpp"

#include <algorithm>

#include "sparse_mocap/eom2014/heading_rate.hpp"
#include "sparse_mocap/motion/contacts.hpp"

namespace sparse_mocap::eom2014 {
namespace {

constexpr int kMostCompared = 150;  // instants that tell how the sensor is worn

Eigen::VectorXd turning_of(const std::vector<Reading>& take, const WornSensor& worn) {
  Eigen::VectorXd rates(static_cast<Eigen::Index>(take.size()));
  for (std::size_t t = 0; t < take.size(); ++t)
    rates[static_cast<Eigen::Index>(t)] = worn.corrected_turning(turning_rate(take[t]));
  return rates;
}

}  // namespace

std::vector<PoseEstimate> Reconstructor::solve(const std::vector<Reading>& take,
                                               const Progress& progress) {
  constexpr std::size_t kParts = 3;
  notes_.clear();
  const Config& config = model_.config();
  // Section 4.1: readings are at even times already; noise is filtered.
  const ReadingRows recorded =
      smoothed(reading_rows(take, config.rate_hz), config.reading_smoothing_s * config.rate_hz);
  progress.report(0, kParts, "finding how the sensor is worn");
  const WornSensor worn = model_.worn(recorded, kMostCompared, notes_);
  const ReadingRows readings = worn.corrected(recorded);
  // Sections 6.1 and 6.2: phases, latent points, poses.
  progress.report(1, kParts, "reconstructing");
  MappedFrames frames = model_.mapped(readings, {0, readings.rows()});
  if (!model_.follows_clips(readings, frames) &&
      std::find(notes_.begin(), notes_.end(), kUnlikeNote) == notes_.end())
    notes_.emplace_back(kUnlikeNote);
  if (config.turns_by_gyroscope)
    frames.root_velocities.col(2) =
        turned_as_measured(frames.root_velocities.col(2), turning_of(take, worn), config.rate_hz);
  progress.report(2, kParts, "placing the feet");
  const Motion motion = model_.motion_of(frames);
  const Eigen::Matrix2Xd contacts = foot_contacts(motion);
  const Eigen::VectorXd misfits_mps2 = model_.force_misfits(readings, {0, readings.rows()});
  std::vector<PoseEstimate> estimates;
  for (Eigen::Index t = 0; t < readings.rows(); ++t) {
    estimates.push_back(model_.estimate(frames, motion, t));
    estimates.back().time_s = take[static_cast<std::size_t>(t)].time_s;
    estimates.back().contacts = contacts.col(t);
    estimates.back().diagnostics["sensor_misfit_mps2"] =
        Eigen::VectorXd::Constant(1, misfits_mps2[t]);
  }
  return estimates;
}

}  // namespace sparse_mocap::eom2014
