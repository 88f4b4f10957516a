// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdint>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/eom2014/trained_model.hpp"

namespace sparse_mocap::eom2014 {
namespace {

constexpr int kVersion = 2;  // of what a model holds

std::string site_name(int index) {
  return std::string(all_sites().at(static_cast<std::size_t>(index)).name);
}

[[noreturn]] void refuse(const Model& model, const std::string& problem) {
  throw FormatError({model.path}, problem, "train it again with this version");
}

void store(const std::string& name, const Perceptron& perceptron, Model& model) {
  model.set(name + ".W1", perceptron.W1);
  model.set(name + ".b1", perceptron.b1);
  model.set(name + ".W2", perceptron.W2);
  model.set(name + ".b2", perceptron.b2);
}

Perceptron perceptron_in(const Model& model, const std::string& name, Eigen::Index num_inputs,
                         Eigen::Index num_outputs) {
  Perceptron out;
  out.W1 = model.matrix<double>(name + ".W1", {}, num_inputs);
  out.b1 = model.vector<double>(name + ".b1", out.W1.rows());
  out.W2 = model.matrix<double>(name + ".W2", num_outputs, out.W1.rows());
  out.b2 = model.vector<double>(name + ".b2", num_outputs);
  return out;
}

std::string prefix_of(std::size_t type) { return "type" + std::to_string(type) + "."; }

void store(const std::string& name, const SiteModel& site, Model& model) {
  model.set(name + ".readings", site.readings);
  model.set(name + ".level_slope", site.recognition.level_slope);
  store(name + ".perceptron", site.perceptron, model);
  for (std::size_t p = 0; p < site.recognition.phases.size(); ++p) {
    const std::string own = name + "." + std::string(name_of(site.recognition.phases[p]));
    const HiddenMarkovModel& hmm = site.recognition.models[p];
    model.set(own + ".transition", hmm.transition);
    for (std::size_t c = 0; c < hmm.emission.size(); ++c)
      model.set(own + ".emission" + std::to_string(c), hmm.emission[c]);
    store(own + ".perceptron", site.of_each_phase[p], model);
  }
}

void require_probabilities(const Model& model, const std::string& name, const Eigen::MatrixXd& p) {
  if (p.minCoeff() < 0.0 || ((p.rowwise().sum().array() - 1.0).abs() > 1e-6).any())
    refuse(model, "the rows of '" + name + "' are no probabilities");
}

HiddenMarkovModel hmm_in(const Model& model, const std::string& name) {
  HiddenMarkovModel out;
  const HmmSettings settings;
  out.transition =
      model.matrix<double>(name + ".transition", settings.num_states, settings.num_states);
  require_probabilities(model, name + ".transition", out.transition);
  for (int c = 0; c < 6; ++c) {
    const std::string channel = name + ".emission" + std::to_string(c);
    out.emission.emplace_back(
        model.matrix<double>(channel, settings.num_states, settings.num_symbols));
    require_probabilities(model, channel, out.emission.back());
    if (out.emission.back().minCoeff() <= 0.0) refuse(model, "'" + channel + "' holds a zero");
  }
  return out;
}

SiteModel site_in(const Model& model, const std::string& prefix, int index, Eigen::Index num_frames,
                  Eigen::Index dimensions, int window) {
  const std::string name = prefix + site_name(index);
  const Eigen::Index num_inputs = 6 * (2 * window + 1);
  SiteModel out;
  out.site = index;
  out.readings = model.matrix<double>(name + ".readings", num_frames, 6);
  out.scale = ReadingScale::of(out.readings);
  out.recognition.level_slope = model.vector<double>(name + ".level_slope", 6).transpose();
  out.perceptron = perceptron_in(model, name + ".perceptron", num_inputs, dimensions);
  for (int p = 0; p < kNumPhases; ++p) {
    const auto phase = static_cast<Phase>(p);
    const std::string own = name + "." + std::string(name_of(phase));
    if (!model.tensors.contains(own + ".transition")) continue;
    out.recognition.phases.push_back(phase);
    out.recognition.models.push_back(hmm_in(model, own));
    out.of_each_phase.push_back(perceptron_in(model, own + ".perceptron", num_inputs, dimensions));
  }
  if (out.recognition.phases.empty()) refuse(model, "the model has no phases of " + name);
  return out;
}

std::vector<int> begins_in(const Model& model, const std::string& prefix, Eigen::Index num_frames) {
  const std::string name = prefix + "sequence_begins";
  const auto stored = model.vector<std::int32_t>(name);
  std::vector<int> begins(stored.begin(), stored.end());
  for (std::size_t s = 0; s < begins.size(); ++s) {
    const Eigen::Index end = s + 1 < begins.size() ? begins[s + 1] : num_frames;
    if (begins[s] < 0 || end - begins[s] < 2 || (s == 0 && begins[s] != 0))
      refuse(model, "'" + name + "' does not divide its frames");
  }
  if (begins.empty()) refuse(model, "'" + name + "' is empty");
  return begins;
}

std::vector<Phase> phases_in(const Model& model, const std::string& prefix,
                             Eigen::Index num_frames) {
  std::vector<Phase> phases;
  for (const std::int32_t phase : model.vector<std::int32_t>(prefix + "phases", num_frames)) {
    if (phase < 0 || phase >= kNumPhases)
      refuse(model, "'" + prefix + "phases' has an unknown one");
    phases.push_back(static_cast<Phase>(phase));
  }
  return phases;
}

MotionModel motion_in(const Model& model, const std::string& prefix, const std::vector<int>& begins,
                      int dimensions) {
  MotionData data;
  data.poses = model.matrix<double>(prefix + "poses", {}, kNumPoseChannels);
  const Eigen::Index n = data.poses.rows();
  data.velocities = model.matrix<double>(
      prefix + "velocities", n - static_cast<Eigen::Index>(begins.size()), kNumVelocityChannels);
  for (std::size_t s = 0; s < begins.size(); ++s) {
    const Eigen::Index end = s + 1 < begins.size() ? begins[s + 1] : n;
    for (int t = begins[s] + 1; t < end; ++t) data.steps.push_back(t);
  }
  Latent latent;
  latent.X = model.matrix<double>(prefix + "latent", n, dimensions);
  latent.pose.alpha = model.vector<double>(prefix + "alpha", 3);
  latent.velocity.beta = model.vector<double>(prefix + "beta", 4);
  if (latent.pose.alpha.minCoeff() <= 0.0 || latent.velocity.beta.minCoeff() <= 0.0)
    refuse(model, "'" + prefix + "alpha' and 'beta' are positive");
  return {std::move(data), std::move(latent)};
}

Eigen::Matrix<std::int32_t, Eigen::Dynamic, 1> integers(const auto& values) {
  Eigen::Matrix<std::int32_t, Eigen::Dynamic, 1> out(static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    out[static_cast<Eigen::Index>(i)] = static_cast<std::int32_t>(values[i]);
  return out;
}

void store(const std::string& prefix, const MotionType& type, Model& model) {
  model.set(prefix + "sequence_begins", integers(type.begins));
  model.set(prefix + "phases", integers(type.phases));
  model.set(prefix + "poses", type.motion.data().poses);
  model.set(prefix + "velocities", type.motion.data().velocities);
  model.set(prefix + "extremities", type.extremities);
  model.set(prefix + "latent", type.motion.latent().X);
  model.set(prefix + "alpha", type.motion.latent().pose.alpha);
  model.set(prefix + "beta", type.motion.latent().velocity.beta);
  for (const auto& site : type.sites) store(prefix + site_name(site.site), site, model);
  model.metadata[prefix + "name"] = type.name;
  model.metadata[prefix + "log_posterior"] = std::to_string(type.motion.log_posterior());
}

MotionType type_in(const Model& model, const std::string& prefix, const Config& config) {
  const Eigen::Index n = model.matrix<double>(prefix + "poses", {}, kNumPoseChannels).rows();
  auto begins = begins_in(model, prefix, n);
  MotionModel motion = motion_in(model, prefix, begins, config.latent_dimensions);
  std::vector<SiteModel> sites;
  for (int index = 0; index < static_cast<int>(all_sites().size()); ++index)
    if (model.tensors.contains(prefix + site_name(index) + ".readings"))
      sites.push_back(
          site_in(model, prefix, index, n, config.latent_dimensions, config.window_frames));
  if (sites.empty()) refuse(model, "the model has readings of no site");
  const auto name = model.metadata.find(prefix + "name");
  return {name == model.metadata.end() ? "" : name->second,
          std::move(begins),
          phases_in(model, prefix, n),
          std::move(motion),
          model.matrix<double>(prefix + "extremities", n, kExtremityColumns),
          std::move(sites)};
}

void require_same_sites(const Model& model, const std::vector<MotionType>& types) {
  for (const auto& type : types)
    if (!std::equal(type.sites.begin(), type.sites.end(), types.front().sites.begin(),
                    types.front().sites.end(),
                    [](const auto& a, const auto& b) { return a.site == b.site; }))
      refuse(model, "its types of motion have sensors at different sites");
}

}  // namespace

Model stored(const TrainedModel& trained, const Config& config) {
  Model model{"eom2014", kVersion, training_options(config), {}, {}};
  const StandardBones bones = bones_of(trained.skeleton);
  Eigen::MatrixX3d rows(kNumStandardJoints, 3);
  for (Eigen::Index j = 0; j < rows.rows(); ++j)
    rows.row(j) = bones[static_cast<std::size_t>(j)].transpose();
  model.set("bones", rows);
  for (std::size_t k = 0; k < trained.types.size(); ++k)
    store(prefix_of(k), trained.types[k], model);
  return model;
}

TrainedModel restored(const Model& model, const Config& config) {
  if (model.method != "eom2014")
    refuse(model, "is a model of '" + model.method + "', not of 'eom2014'");
  if (model.version > kVersion) refuse(model, "was made by a newer version");
  if (model.version < kVersion) refuse(model, "was made by an older version");
  const auto bones = model.matrix<double>("bones", kNumStandardJoints, 3);
  StandardBones lengths;
  for (Eigen::Index j = 0; j < bones.rows(); ++j)
    lengths[static_cast<std::size_t>(j)] = bones.row(j).transpose();
  TrainedModel trained{make_standard_skeleton(lengths), {}};
  do {
    trained.types.push_back(type_in(model, prefix_of(trained.types.size()), config));
  } while (model.tensors.contains(prefix_of(trained.types.size()) + "poses"));
  require_same_sites(model, trained.types);
  return trained;
}

}  // namespace sparse_mocap::eom2014
