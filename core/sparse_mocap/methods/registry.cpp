// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/methods/registry.hpp"

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/database/model.hpp"
#include "sparse_mocap/readings/channel_names.hpp"
#include "sparse_mocap/reconstruction/human_limits.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap {

// method_list.inc is made by CMake: SPARSE_MOCAP_METHOD(name) for each method.
#define SPARSE_MOCAP_METHOD(name) \
  namespace name {                \
  MethodEntry method();           \
  }
#include "method_list.inc"
#undef SPARSE_MOCAP_METHOD

namespace {

void require(bool is_met, const MethodInfo& method, const std::string& what) {
  if (!is_met) throw ConfigError("method " + method.name + " needs " + what);
}

std::string missing_channels(Channels required, Channels given, const char* between) {
  std::string names;
  for (const Channel channel : all_channels())
    if (required.has(channel) && !given.has(channel))
      names += (names.empty() ? "" : between) + std::string(name_of(channel));
  return names;
}

void check_sensors(const MethodInfo& method, const std::vector<Sensor>& sensors) {
  const auto count = static_cast<int>(sensors.size());
  const std::string range =
      method.fewest_sensors == method.most_sensors
          ? std::to_string(method.fewest_sensors)
          : std::to_string(method.fewest_sensors) + " to " + std::to_string(method.most_sensors);
  require(count >= method.fewest_sensors && count <= method.most_sensors, method,
          range + " sensors, got " + std::to_string(count));
  for (const Sensor& sensor : sensors) {
    const std::string site(all_sites().at(static_cast<std::size_t>(sensor.site)).name);
    const auto missing = missing_channels(method.required_channels, sensor.channels, ", ");
    require(missing.empty(), method,
            missing + " of every sensor, and " + site + " does not give it");
    const Channels choice = method.one_channel_of;
    require(choice.is_empty() || !(choice & sensor.channels).is_empty(), method,
            missing_channels(choice, {}, " or ") + " of every sensor, and " + site +
                " does not give it");
  }
}

void check(const MethodInfo& method, const MethodContext& context) {
  require(!method.needs_database || context.database, method, "a motion database (--database)");
  require(!method.needs_model || context.model, method,
          "a trained model (--model); `train` makes one");
  require(!method.needs_body || context.body, method, "a calibrated body (--body)");
  check_sensors(method, context.sensors);
}

}  // namespace

const std::vector<MethodEntry>& methods() {
#define SPARSE_MOCAP_METHOD(name) name::method(),
  static const std::vector<MethodEntry> list{
#include "method_list.inc"
  };
#undef SPARSE_MOCAP_METHOD
  return list;
}

const MethodEntry& find_method(std::string_view name) {
  std::string known;
  for (const auto& method : methods()) {
    if (method.info.name == name) return method;
    known += (known.empty() ? "" : ", ") + method.info.name;
  }
  throw ConfigError("unknown method '" + std::string(name) + "'; known are " + known);
}

std::unique_ptr<LiveMethod> make_live_method(const MethodEntry& method,
                                             const MethodSettings& settings,
                                             const MethodContext& context) {
  if (method.make_live == nullptr)
    throw ConfigError("method " + method.info.name +
                      " does not work live: record a take and reconstruct it in best quality");
  check(method.info, context);
  return within_human_limits(method.make_live(settings, context));
}

std::unique_ptr<WholeTakeMethod> make_whole_take_method(const MethodEntry& method,
                                                        const MethodSettings& settings,
                                                        const MethodContext& context) {
  if (method.make_whole_take == nullptr)
    throw ConfigError("method " + method.info.name +
                      " has no best quality: it works live only, frame by frame");
  check(method.info, context);
  return within_human_limits(method.make_whole_take(settings, context));
}

Model train_model(const MethodEntry& method, const MethodSettings& settings,
                  const std::vector<TrainingClip>& clips, const Progress& progress) {
  if (method.train == nullptr)
    throw ConfigError("method " + method.info.name +
                      " needs no trained model: it works on a motion database as it is");
  if (clips.empty()) throw ConfigError("at least one clip is needed to train a model");
  return method.train(settings, clips, progress);
}

std::vector<Segment> segments_of_clip(const MethodEntry& method, const MethodSettings& settings,
                                      const TrainingClip& clip) {
  if (method.segment == nullptr)
    throw ConfigError("method " + method.info.name + " does not divide clips into phases");
  return method.segment(settings, clip);
}

}  // namespace sparse_mocap
