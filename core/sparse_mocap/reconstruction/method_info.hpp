// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/reconstruction/method.hpp"
#include "sparse_mocap/reconstruction/options.hpp"

namespace sparse_mocap {

struct Model;

// Settings that belong together, by a name.
struct PresetInfo {
  std::string name;
  std::string help;
};

// A comparison that a paper makes: `evaluate` runs every variant and states the errors side by
// side.
struct Experiment {
  enum class Error { position_cm, joint_angle_deg };

  struct Variant {
    std::string label;
    OptionValues options;
    std::vector<Sensor> sensors{};  // with the channels that it gets; empty: the evaluation's own
    std::string method{};           // empty: the one whose experiment it is
    bool in_best_quality = false;   // of methods that work live as well
    bool knows_all_clips = false;   // a database of all but the tests, not of training clips alone
  };
  struct ClipPair {  // names of clips, as patterns
    std::string training, test;
  };

  std::string name;
  std::string help;  // with the figure or table of the paper
  std::vector<Variant> variants;
  std::vector<ClipPair> pairs;  // empty: the evaluation's own scenario
  Error error = Error::position_cm;
};

// What people and programs can know of a method before they use it.
struct MethodInfo {
  std::string name;
  std::string title;
  std::string summary;              // one sentence
  std::string paper;                // empty: the project's own method
  std::vector<PresetInfo> presets;  // the default first
  std::vector<OptionInfo> options;  // with the default preset's values
  Channels required_channels;       // of every sensor
  Channels optional_channels;       // used where a sensor has them
  Channels one_channel_of;          // of every sensor, of the optional ones; none: it does not ask
  int fewest_sensors = 1;
  int most_sensors = 1;
  bool needs_database = false;
  bool needs_model = false;
  bool needs_body = false;
  std::vector<Experiment> experiments;
};

// What a method works with, for one performance.
struct MethodContext {
  std::shared_ptr<const MotionDatabase> database;
  std::shared_ptr<const Model> model;
  std::optional<Skeleton> body;  // the performer's own standard skeleton
  std::vector<Sensor> sensors;
  std::vector<int> excluded_clips;  // of the database, as if they were not in it
  int num_threads = 0;              // of whole takes; 0: one a processor. The result is the same
};

// A preset, and options that differ from it.
struct MethodSettings {
  std::string preset;  // empty: the default
  OptionValues options;
};

// A part of a clip, until the next one begins.
struct Segment {
  double begin_s = 0.0;
  std::string label;
};

// One example that a model is trained from.
struct TrainingClip {
  std::string name;
  std::string motion_class;         // empty: not known
  Motion motion;                    // on a standard skeleton
  std::vector<Sensor> sensors;      // of readings
  std::vector<Reading> readings;    // recorded with the motion, at its rate; empty: simulate them
  std::vector<Segment> segments{};  // as the method's `segment` gives them; empty: the method's own
};

// A method as the registry knows it. A factory that is null means that the method does not work
// that way. Factories throw ConfigError; trainers also Cancelled.
struct MethodEntry {
  MethodInfo info;
  std::unique_ptr<LiveMethod> (*make_live)(const MethodSettings&, const MethodContext&) = nullptr;
  std::unique_ptr<WholeTakeMethod> (*make_whole_take)(const MethodSettings&,
                                                      const MethodContext&) = nullptr;
  Model (*train)(const MethodSettings&, const std::vector<TrainingClip>&,
                 const Progress&) = nullptr;
  // The parts that training divides a clip into; null: it divides none.
  std::vector<Segment> (*segment)(const MethodSettings&, const TrainingClip&) = nullptr;
};

}  // namespace sparse_mocap
