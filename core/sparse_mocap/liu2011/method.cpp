// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/method.hpp"

#include <algorithm>
#include <string>

#include "sparse_mocap/liu2011/bone_lengths.hpp"
#include "sparse_mocap/liu2011/config.hpp"
#include "sparse_mocap/liu2011/reconstructor.hpp"
#include "sparse_mocap/liu2011/whole_take.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::liu2011 {
namespace {

// The sensors of section 4.
std::vector<Sensor> six_sensors(Channels channels) {
  std::vector<Sensor> sensors;
  for (const char* site : {"left_hand", "right_hand", "left_ankle", "right_ankle", "head", "torso"})
    sensors.push_back({find_site(site), 1.0, channels});
  return sensors;
}

std::vector<Experiment::Variant> models(const std::vector<Sensor>& sensors) {
  return {{"local dynamic models", {{"prior", "dynamic"}}, sensors},
          {"local PCA", {{"prior", "local_pca"}}, sensors},
          {"inverse kinematics", {{"prior", "inverse_kinematics"}}, sensors},
          {"local dynamic models, paper",
           {{"search_position_per_m", "0"},
            {"search_orientation", "0"},
            {"joint_residuals", "false"},
            {"history_trust", "1"}},
           sensors}};
}

// Section 7, "Different combinations of sensor data".
std::vector<Experiment::Variant> combinations() {
  auto with_torso = six_sensors(Channel::position);
  with_torso.back().channels = Channel::position | Channel::orientation;
  auto mixed = six_sensors(Channel::orientation);
  mixed[2].channels = mixed[3].channels = Channel::position;
  mixed.back().channels = Channel::position | Channel::orientation;
  return {{"positions and orientations", {}, six_sensors(Channel::position | Channel::orientation)},
          {"positions, orientation of the torso", {}, with_torso},
          {"positions", {}, six_sensors(Channel::position)},
          {"positions of torso and ankles, orientations of torso, head and hands", {}, mixed}};
}

std::vector<Experiment> experiments() {
  constexpr auto kAngles = Experiment::Error::joint_angle_deg;
  return {{"positions_and_orientations",
           "Against inverse kinematics and local PCA (figure 6, left)",
           models(six_sensors(Channel::position | Channel::orientation)),
           {},
           kAngles},
          {"positions",
           "The same from positions alone (figure 6, right)",
           models(six_sensors(Channel::position)),
           {},
           kAngles},
          {"combinations", "Combinations of sensor data (section 7)", combinations(), {}, kAngles}};
}

// What calibrations learn from: the bone lengths of people, one body a skeleton.
Model trained(const MethodSettings&, const std::vector<TrainingClip>& clips, const Progress&) {
  std::vector<MeasuredBody> bodies;
  std::vector<StandardBones> seen;
  for (const TrainingClip& clip : clips) {
    const StandardBones bones = bones_of(clip.motion.skeleton);
    const auto is_same = [&](const StandardBones& other) {
      return lengths_of(other).isApprox(lengths_of(bones), 1e-6);
    };
    if (std::any_of(seen.begin(), seen.end(), is_same)) continue;
    seen.push_back(bones);
    bodies.push_back(measured_body(bones));
  }
  Model model = to_model(learnt_bone_lengths(bodies));
  model.metadata["num_bodies"] = std::to_string(bodies.size());
  return model;
}

}  // namespace

MethodEntry method() {
  MethodEntry entry;
  entry.info.name = "liu2011";
  entry.info.title = "Liu et al. 2011";
  entry.info.summary = "The method of the paper, for a few trackers of position or orientation.";
  entry.info.paper =
      "Liu, Wei, Chai, Ha, Rhee: Realtime Human Motion Control with A Small Number of Inertial "
      "Sensors, I3D 2011";
  entry.info.presets = presets();
  entry.info.options = options().described(Config());
  entry.info.one_channel_of = Channel::position | Channel::orientation;
  entry.info.optional_channels = Channel::position | Channel::orientation | Channel::specific_force;
  entry.info.most_sensors = static_cast<int>(all_sites().size());
  entry.info.needs_database = true;
  entry.info.experiments = experiments();
  entry.make_live = [](const MethodSettings& settings,
                       const MethodContext& context) -> std::unique_ptr<LiveMethod> {
    return std::make_unique<Reconstructor>(config_of(settings), context);
  };
  entry.make_whole_take = [](const MethodSettings& settings,
                             const MethodContext& context) -> std::unique_ptr<WholeTakeMethod> {
    return std::make_unique<WholeTakeReconstructor>(config_of(settings), context);
  };
  entry.train = &trained;
  return entry;
}

}  // namespace sparse_mocap::liu2011
