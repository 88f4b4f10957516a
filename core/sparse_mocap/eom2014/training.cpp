// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/eom2014/trained_model.hpp"

namespace sparse_mocap::eom2014 {
namespace {

constexpr int kFewestSteps = 2;
constexpr std::size_t kFewestFramesOfPhase = 6;

std::vector<int> sites_of(const Config& config) {
  if (config.site == 0) return {find_site("left_ankle"), find_site("right_ankle")};
  return {config.site - 1};
}

// The first clips until their frames reach the limit; the last one is cut there.
std::vector<TrainingSequence> for_motion(const std::vector<TrainingSequence>& all, int limit) {
  std::vector<TrainingSequence> used;
  Eigen::Index left = limit;
  for (const auto& sequence : all) {
    if (left < 2) break;
    TrainingSequence part = sequence;
    const Eigen::Index n = std::min(left, sequence.poses.rows());
    part.poses = sequence.poses.topRows(n);
    part.velocities = sequence.velocities.topRows(n - 1);
    part.readings = sequence.readings.topRows(n);
    part.contacts = sequence.contacts.leftCols(n);
    part.extremities = sequence.extremities.topRows(n);
    left -= n;
    used.push_back(std::move(part));
  }
  return used;
}

std::vector<Phase> checked_phases(const TrainingSequence& sequence, double rate_hz) {
  if (num_steps(sequence.contacts, rate_hz) < kFewestSteps)
    throw ConfigError("the clip '" + sequence.name +
                      "' has no steps: its feet stay on the floor; choose clips of locomotion");
  return phases_of(sequence.contacts, rate_hz);
}

// Phases that are hardly there become the one before them, or at the begin the one after.
void drop_rare(std::vector<std::vector<Phase>>& phases) {
  for (int p = 0; p < kNumPhases; ++p) {
    const auto phase = static_cast<Phase>(p);
    std::size_t count = 0;
    for (const auto& one : phases)
      count += static_cast<std::size_t>(std::count(one.begin(), one.end(), phase));
    if (count >= kFewestFramesOfPhase) continue;
    for (auto& one : phases) {
      const auto other =
          std::find_if(one.begin(), one.end(), [&](Phase known) { return known != phase; });
      if (other == one.end()) continue;
      std::fill(one.begin(), other, *other);
      for (std::size_t t = 1; t < one.size(); ++t)
        if (one[t] == phase) one[t] = one[t - 1];
    }
  }
}

Eigen::MatrixXd rows_of(const Eigen::MatrixXd& values, const std::vector<Phase>& phases,
                        Phase phase) {
  Eigen::MatrixXd out(std::count(phases.begin(), phases.end(), phase), values.cols());
  for (Eigen::Index t = 0, to = 0; t < values.rows(); ++t)
    if (phases[static_cast<std::size_t>(t)] == phase) out.row(to++) = values.row(t);
  return out;
}

// A perceptron for each phase (section 5.5), and one for all; phases that the motion model's clips
// do not have share that one.
void learn_mapping(const Config& config, const Eigen::MatrixXd& X, const std::vector<int>& begins,
                   const std::vector<Phase>& phases, SiteModel& site, const Progress& progress) {
  PerceptronSettings settings;
  settings.num_hidden = config.hidden_units;
  settings.weight_decay = config.weight_decay;
  const Eigen::MatrixXd inputs = training_features(site, begins, config.window_frames);
  site.perceptron = trained(inputs, X, settings, progress);
  for (const Phase phase : site.recognition.phases) {
    const Eigen::MatrixXd own = rows_of(inputs, phases, phase);
    site.of_each_phase.push_back(own.rows() == 0
                                     ? site.perceptron
                                     : trained(own, rows_of(X, phases, phase), settings, progress));
  }
}

}  // namespace

Eigen::MatrixXd training_features(const SiteModel& site, const std::vector<int>& begins,
                                  int window) {
  Eigen::MatrixXd out(site.readings.rows(), 6 * (2 * window + 1));
  for (std::size_t s = 0; s < begins.size(); ++s) {
    const Eigen::Index begin = begins[s];
    const Eigen::Index end = s + 1 < begins.size() ? begins[s + 1] : site.readings.rows();
    out.middleRows(begin, end - begin) =
        features(site.readings.middleRows(begin, end - begin), site.scale, window);
  }
  return out;
}

TrainedModel trained_model(const Config& config, const std::vector<TrainingClip>& clips,
                           const Progress& progress) {
  std::vector<int> begins;
  std::vector<Phase> motion_phases;
  std::vector<std::vector<Phase>> phases;
  std::vector<SiteModel> sites;
  MotionData data;
  ExtremityRows extremities;
  for (const int index : sites_of(config)) {
    auto all = training_sequences(clips, {index, config.position_along_bone, config.rate_hz});
    for (auto& sequence : all)
      sequence.readings = smoothed(sequence.readings, config.reading_smoothing_s * config.rate_hz);
    const auto used = for_motion(all, config.motion_frames);
    if (sites.empty()) {
      data = joined(used);
      extremities.resize(data.poses.rows(), kExtremityColumns);
      for (const auto& sequence : all) phases.push_back(checked_phases(sequence, config.rate_hz));
      drop_rare(phases);
      for (std::size_t s = 0; s < used.size(); ++s) {
        begins.push_back(static_cast<int>(motion_phases.size()));
        extremities.middleRows(begins.back(), used[s].extremities.rows()) = used[s].extremities;
        motion_phases.insert(motion_phases.end(), phases[s].begin(),
                             phases[s].begin() + used[s].poses.rows());
      }
    }
    SiteModel site;
    site.site = index;
    site.readings.resize(data.poses.rows(), 6);
    std::vector<ReadingRows> readings;
    for (std::size_t s = 0; s < used.size(); ++s)
      site.readings.middleRows(begins[s], used[s].readings.rows()) = used[s].readings;
    for (auto& sequence : all) readings.push_back(std::move(sequence.readings));
    site.scale = ReadingScale::of(site.readings);
    site.recognition = PhaseRecognition::trained(readings, phases);
    sites.push_back(std::move(site));
  }
  MotionModel motion =
      MotionModel::learnt(data, {config.latent_dimensions, config.iterations}, progress);
  for (auto& site : sites)
    learn_mapping(config, motion.latent().X, begins, motion_phases, site, progress);
  return {without_extremities(clips.front().motion.skeleton), std::move(begins), std::move(motion),
          std::move(extremities), std::move(sites)};
}

}  // namespace sparse_mocap::eom2014
