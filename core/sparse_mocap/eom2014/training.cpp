// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

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

std::vector<Phase> checked_phases(const TrainingClip& clip, const TrainingSequence& sequence,
                                  double rate_hz) {
  if (!clip.segments.empty())
    return phases_from(clip.segments, sequence.poses.rows(), rate_hz, clip.name);
  if (num_steps(sequence.contacts, rate_hz) < kFewestSteps)
    throw ConfigError("the clip '" + clip.name +
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
  const Eigen::MatrixXd inputs =
      sequence_features(site.readings, begins, site.scale, config.window_frames);
  site.perceptron = trained(inputs, X, settings, progress);
  for (const Phase phase : site.recognition.phases) {
    const Eigen::MatrixXd own = rows_of(inputs, phases, phase);
    site.of_each_phase.push_back(own.rows() == 0
                                     ? site.perceptron
                                     : trained(own, rows_of(X, phases, phase), settings, progress));
  }
}

// What is learnt from: the clips as a site's sensor sees them, for each site.
using SiteSequences = std::vector<std::vector<TrainingSequence>>;

std::vector<TrainingSequence> sequences_of(const Config& config,
                                           const std::vector<TrainingClip>& clips, int site) {
  auto all = training_sequences(clips, {site, config.position_along_bone, config.rate_hz});
  const double leg_m = leg_length_m(bones_of(clips.front().motion.skeleton));
  for (std::size_t c = 0; c < clips.size(); ++c) {
    auto& sequence = all[c];
    sequence.readings = smoothed(sequence.readings, config.reading_smoothing_s * config.rate_hz);
    // On the first performer's legs, on which poses are shown.
    const double scale = leg_m / leg_length_m(bones_of(clips[c].motion.skeleton));
    sequence.poses.col(kHeightChannel) *= scale;
    sequence.velocities.col(kHeightChannel) *= scale;
    sequence.velocities.middleCols<2>(kRootVelocityChannel) *= scale;
  }
  return all;
}

// The classes in the order in which they appear, with their clips.
std::vector<std::pair<std::string, std::vector<std::size_t>>> by_class(
    const std::vector<TrainingClip>& clips) {
  std::vector<std::pair<std::string, std::vector<std::size_t>>> classes;
  for (std::size_t c = 0; c < clips.size(); ++c) {
    const auto known = std::find_if(classes.begin(), classes.end(), [&](const auto& one) {
      return one.first == clips[c].motion_class;
    });
    if (known == classes.end())
      classes.push_back({clips[c].motion_class, {c}});
    else
      known->second.push_back(c);
  }
  return classes;
}

template <typename T>
std::vector<T> chosen(const std::vector<T>& all, const std::vector<std::size_t>& indices) {
  std::vector<T> out;
  for (const std::size_t i : indices) out.push_back(all[i]);
  return out;
}

SiteModel site_model(int site, const std::vector<TrainingSequence>& all,
                     const std::vector<TrainingSequence>& used,
                     const std::vector<std::vector<Phase>>& phases) {
  SiteModel out;
  out.site = site;
  Eigen::Index num_frames = 0;
  for (const auto& sequence : used) num_frames += sequence.readings.rows();
  out.readings.resize(num_frames, 6);
  Eigen::Index at = 0;
  for (const auto& sequence : used) {
    out.readings.middleRows(at, sequence.readings.rows()) = sequence.readings;
    at += sequence.readings.rows();
  }
  std::vector<ReadingRows> readings;
  for (const auto& sequence : all) readings.push_back(sequence.readings);
  out.scale = ReadingScale::of(out.readings);
  out.recognition = PhaseRecognition::trained(readings, phases);
  return out;
}

MotionType learnt_type(const Config& config, const std::string& name, const SiteSequences& clips,
                       std::vector<std::vector<Phase>> phases, const Progress& progress) {
  drop_rare(phases);
  MotionData data;
  std::vector<int> begins;
  std::vector<Phase> used_phases;
  ExtremityRows extremities;
  std::vector<SiteModel> sites;
  const auto indices = sites_of(config);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const auto used = for_motion(clips[i], config.motion_frames);
    if (i == 0) {
      data = joined(used);
      extremities.resize(data.poses.rows(), kExtremityColumns);
      for (std::size_t s = 0; s < used.size(); ++s) {
        begins.push_back(static_cast<int>(used_phases.size()));
        extremities.middleRows(begins.back(), used[s].extremities.rows()) = used[s].extremities;
        used_phases.insert(used_phases.end(), phases[s].begin(),
                           phases[s].begin() + used[s].poses.rows());
      }
    }
    sites.push_back(site_model(indices[i], clips[i], used, phases));
  }
  MotionModel motion =
      MotionModel::learnt(data, {config.latent_dimensions, config.iterations}, progress);
  for (auto& site : sites)
    learn_mapping(config, motion.latent().X, begins, used_phases, site, progress);
  return {name,
          std::move(begins),
          std::move(used_phases),
          std::move(motion),
          std::move(extremities),
          std::move(sites)};
}

}  // namespace

TrainedModel trained_model(const Config& config, const std::vector<TrainingClip>& clips,
                           const Progress& progress) {
  SiteSequences sequences;
  for (const int site : sites_of(config)) sequences.push_back(sequences_of(config, clips, site));
  std::vector<std::vector<Phase>> phases;
  for (std::size_t c = 0; c < clips.size(); ++c)
    phases.push_back(checked_phases(clips[c], sequences.front()[c], config.rate_hz));
  TrainedModel trained{without_extremities(clips.front().motion.skeleton), {}};
  for (const auto& [name, indices] : by_class(clips)) {
    SiteSequences own;
    for (const auto& of_site : sequences) own.push_back(chosen(of_site, indices));
    trained.types.push_back(learnt_type(config, name, own, chosen(phases, indices), progress));
  }
  return trained;
}

std::vector<Segment> found_phases(const Config& config, const TrainingClip& clip) {
  TrainingClip without = clip;
  without.segments.clear();
  const auto sequence = sequences_of(config, {without}, sites_of(config).front()).front();
  return segments_of(checked_phases(without, sequence, config.rate_hz), config.rate_hz);
}

}  // namespace sparse_mocap::eom2014
