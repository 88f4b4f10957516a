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

// The stages of the paper, and what is beside them, from one phone.
std::vector<Experiment::Variant> stages(const char* site, OptionValues many) {
  if (find_site(site) != find_site("left_ankle")) many["site"] = site;
  OptionValues one = many;
  one["window_frames"] = "0";
  const std::vector<Sensor> phone{
      {find_site(site), 1.0, Channel::specific_force | Channel::angular_velocity}};
  const auto best = [&](const char* label, OptionValues options, const char* mapping) {
    options["mapping"] = mapping;
    return Experiment::Variant{label, options, phone, "", true};
  };
  return {best("linear", one, "direct_linear"),
          best("linear, latent", one, "linear"),
          best("perceptron", one, "perceptron"),
          best("perceptron a phase", one, "phases"),
          best("perceptron, windows", many, "perceptron"),
          best("perceptron a phase, windows", many, "phases"),
          best("Gaussian process, windows", many, "gaussian_process"),
          best("path", many, "path"),
          {"path, live", many, phone},
          {"path_regression", {}, phone, "path_regression", true},
          {"path_regression, all clips", {}, phone, "path_regression", true, true}};
}

Experiment experiment(const char* name, const char* help, std::vector<Experiment::ClipPair> pairs,
                      const char* site = "left_ankle", const OptionValues& options = {}) {
  return {name, help, stages(site, options), std::move(pairs), Experiment::Error::position_cm};
}

std::vector<Experiment::ClipPair> walks_of_a_performer() {
  return {{"02_01.bvh", "02_02.bvh"},
          {"07_01.bvh", "07_0[26-9].bvh"},
          {"08_01.bvh", "08_0[369].bvh"},
          {"16_15.bvh", "16_[15][68].bvh"},
          {"35_02.bvh", "35_0*.bvh"}};
}

// On walks, runs, jumps and hops of the CMU database; each model knows one clip.
std::vector<Experiment> experiments() {
  return {
      experiment("one_walk_same_performer",
                 "Figures 8 and 9, table 1: other walks of the performer.", walks_of_a_performer()),
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
                 {{"35_17.bvh", "35_1[89].bvh"}, {"35_17.bvh", "35_2[0-6].bvh"}}),
      experiment("one_jump", "Figure 10: jumps and hops, each from the other clip of them.",
                 {{"49_02.bvh", "49_03.bvh"}, {"49_03.bvh", "49_02.bvh"}}, "left_ankle",
                 {{"motion_frames", "450"}, {"iterations", "200"}}),
      experiment("walk_from_a_wrist", "Other walks of the performer, the phone at a wrist.",
                 walks_of_a_performer(), "left_wrist"),
      experiment("walk_from_the_pelvis", "Other walks of the performer, the phone at the pelvis.",
                 walks_of_a_performer(), "pelvis")};
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
