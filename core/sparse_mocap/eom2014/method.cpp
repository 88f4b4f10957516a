// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/method.hpp"

#include <utility>
#include <vector>

#include "sparse_mocap/eom2014/config.hpp"
#include "sparse_mocap/eom2014/live.hpp"
#include "sparse_mocap/eom2014/reconstructor.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::eom2014 {
namespace {

// The stages of the paper, and what is beside them.
std::vector<Experiment::Variant> stages() {
  const OptionValues one{{"window_frames", "0"}}, many{};
  const auto with = [](OptionValues options, const char* mapping) {
    options["mapping"] = mapping;
    return options;
  };
  const std::vector<Sensor> phone{
      {find_site("left_ankle"), 1.0, Channel::specific_force | Channel::angular_velocity}};
  return {{"linear", with(one, "direct_linear"), phone},
          {"linear, latent", with(one, "linear"), phone},
          {"perceptron", with(one, "perceptron"), phone},
          {"perceptron a phase", with(one, "phases"), phone},
          {"perceptron a phase, windows", with(many, "phases"), phone},
          {"Gaussian process, windows", with(many, "gaussian_process"), phone},
          {"path", with(many, "path"), phone}};
}

Experiment experiment(const char* name, const char* help, std::vector<Experiment::ClipPair> pairs) {
  return {name, help, stages(), std::move(pairs), Experiment::Error::position_cm};
}

// On walks, runs and jumps of the CMU database; each model knows one clip.
std::vector<Experiment> experiments() {
  return {experiment("one_walk_same_performer",
                     "Figures 8 and 9, table 1: other walks of the performer.",
                     {{"02_01.bvh", "02_02.bvh"},
                      {"07_01.bvh", "07_0[26-9].bvh"},
                      {"08_01.bvh", "08_0[369].bvh"},
                      {"16_15.bvh", "16_[15][68].bvh"},
                      {"35_02.bvh", "35_0*.bvh"}}),
          experiment("one_walk_other_performer",
                     "Figures 8 and 9, table 1: walks of others, as in figure 10.",
                     {{"02_01.bvh", "07_01.bvh"},
                      {"07_01.bvh", "08_01.bvh"},
                      {"08_01.bvh", "16_15.bvh"},
                      {"16_15.bvh", "35_01.bvh"},
                      {"35_02.bvh", "02_01.bvh"},
                      {"07_01.bvh", "16_58.bvh"},
                      {"16_15.bvh", "08_03.bvh"},
                      {"35_02.bvh", "07_06.bvh"}}),
          experiment("one_run", "Figure 10: other runs of the performer.",
                     {{"35_17.bvh", "35_1[89].bvh"}, {"35_17.bvh", "35_2[0-6].bvh"}})};
}

Model train(const MethodSettings& settings, const std::vector<TrainingClip>& clips,
            const Progress& progress) {
  const Config config = with_settings(settings);
  return stored(trained_model(config, clips, progress), config);
}

std::vector<Segment> segment(const MethodSettings& settings, const TrainingClip& clip) {
  return found_phases(with_settings(settings), clip);
}

}  // namespace

MethodEntry method() {
  MethodEntry entry;
  entry.info.name = "eom2014";
  entry.info.title = "Eom et al. 2014";
  entry.info.summary =
      "Whole-body locomotion from one phone on an ankle, with a model of the movement learnt from "
      "a clip or two.";
  entry.info.paper =
      "H. Eom, B. Choi, J. Noh: Data-Driven Reconstruction of Human Locomotion Using a Single "
      "Smartphone. Computer Graphics Forum 33 (2014)";
  entry.info.presets = presets();
  entry.info.options = options().described(Config());
  entry.info.required_channels = Channel::specific_force | Channel::angular_velocity;
  entry.info.optional_channels = Channel::gravity_direction;
  entry.info.needs_model = true;
  entry.info.experiments = experiments();
  entry.make_live = [](const MethodSettings& settings,
                       const MethodContext& context) -> std::unique_ptr<LiveMethod> {
    return std::make_unique<LiveReconstructor>(settings, context);
  };
  entry.make_whole_take = [](const MethodSettings& settings,
                             const MethodContext& context) -> std::unique_ptr<WholeTakeMethod> {
    return std::make_unique<Reconstructor>(settings, context);
  };
  entry.train = train;
  entry.segment = segment;
  return entry;
}

}  // namespace sparse_mocap::eom2014
