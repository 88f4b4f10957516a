// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/clip_json.hpp"

#include <set>

#include "sparse_mocap/motion/extremities.hpp"
#include "sparse_mocap/readings/channel_names.hpp"

namespace sparse_mocap {

using nlohmann::json;

namespace {

std::vector<std::string> names_of_extremities(const Clip& clip) {
  std::vector<std::string> names;
  for (std::size_t e = 0; e < clip.has_extremity.size(); ++e)
    if (clip.has_extremity[e]) names.emplace_back(extremity_names()[e]);
  return names;
}

json take_json(const ClipTake& take) {
  json channels = json::object();
  for (const auto& [site, of_site] : take.channels) channels[site] = names_of(of_site);
  return {{"name", take.name},         {"hash", take.hash},
          {"begin_s", take.begin_s},   {"correlation", take.correlation},
          {"coverage", take.coverage}, {"channels", std::move(channels)}};
}

// Channels that only later versions know are left out.
ClipTake take_from(const json& entry) {
  ClipTake take{entry.at("name").get<std::string>(), entry.at("hash").get<std::string>(),
                entry.at("begin_s").get<double>(),   entry.at("correlation").get<double>(),
                entry.at("coverage").get<double>(),  {}};
  for (const auto& [site, names] : entry.at("channels").items()) {
    const auto known = names.get<std::set<std::string>>();
    Channels& channels = take.channels[site];
    for (const Channel channel : all_channels())
      if (known.contains(std::string(name_of(channel)))) channels = channels | channel;
  }
  return take;
}

}  // namespace

json clip_json(const Clip& clip) {
  json entry{{"name", clip.name},
             {"actor", clip.actor},
             {"class", clip.motion_class},
             {"source", clip.source},
             {"source_hash", clip.source_hash},
             {"mirrored", clip.is_mirrored},
             {"reversed", clip.is_reversed},
             {"tempo", clip.tempo},
             {"begin", clip.begin},
             {"end", clip.end},
             {"source_frames", clip.source_frames},
             {"source_rate_hz", clip.source_rate_hz}};
  const auto put = [&](const char* key, const std::string& value) {
    if (!value.empty()) entry[key] = value;
  };
  put("skeleton", clip.skeleton);
  put("skeleton_hash", clip.skeleton_hash);
  put("origin", clip.origin);
  put("license", clip.license);
  if (!clip.warnings.empty()) entry["warnings"] = clip.warnings;
  const auto extremities = names_of_extremities(clip);
  if (!extremities.empty()) entry["extremities"] = extremities;
  if (clip.take) entry["take"] = take_json(*clip.take);
  return entry;
}

Clip clip_from(const json& entry) {
  Clip clip;
  clip.name = entry.at("name").get<std::string>();
  clip.actor = entry.at("actor").get<std::string>();
  clip.motion_class = entry.at("class").get<std::string>();
  clip.source = entry.at("source").get<std::string>();
  clip.source_hash = entry.at("source_hash").get<std::string>();
  clip.is_mirrored = entry.at("mirrored").get<bool>();
  clip.is_reversed = entry.at("reversed").get<bool>();
  clip.tempo = entry.at("tempo").get<double>();
  clip.begin = entry.at("begin").get<int>();
  clip.end = entry.at("end").get<int>();
  // Not in every database:
  clip.skeleton = entry.value("skeleton", "");
  clip.skeleton_hash = entry.value("skeleton_hash", "");
  clip.origin = entry.value("origin", "");
  clip.license = entry.value("license", "");
  clip.source_frames = entry.value("source_frames", 0);
  clip.source_rate_hz = entry.value("source_rate_hz", 0.0);
  clip.warnings = entry.value("warnings", std::map<std::string, int>());
  const auto extremities = entry.value("extremities", std::set<std::string>());
  for (std::size_t e = 0; e < clip.has_extremity.size(); ++e)
    clip.has_extremity[e] = extremities.contains(std::string(extremity_names()[e]));
  if (const auto take = entry.find("take"); take != entry.end()) clip.take = take_from(*take);
  return clip;
}

json source_skeleton_json(const SourceSkeleton& skeleton) {
  return {{"id", skeleton.id},
          {"num_joints", skeleton.num_joints},
          {"joints", skeleton.joints},
          {"unit_scale", skeleton.unit_scale}};
}

SourceSkeleton source_skeleton_from(const json& entry) {
  SourceSkeleton skeleton;
  skeleton.id = entry.at("id").get<std::string>();
  skeleton.num_joints = entry.at("num_joints").get<int>();
  skeleton.joints = entry.at("joints").get<std::map<std::string, std::string>>();
  skeleton.unit_scale = entry.at("unit_scale").get<double>();
  return skeleton;
}

}  // namespace sparse_mocap
