// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/database_metadata.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "sparse_mocap/database/clip_json.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"
#include "sparse_mocap/sensors/filter.hpp"

namespace sparse_mocap {
namespace {

using nlohmann::json;

// --- Writing -------------------------------------------------------------------------------------

// File names need not be UTF-8; what is not is replaced, so that the header is sound JSON.
std::string dumped(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

json skeleton_json(const Skeleton& skeleton) {
  json joints = json::array();
  for (const auto& joint : skeleton.joints())
    joints.push_back({{"name", joint.name}, {"bone_m", vector_json(joint.bone)}});
  return joints;
}

json clips_json(const std::vector<Clip>& clips) {
  json entries = json::array();
  for (const Clip& clip : clips) entries.push_back(clip_json(clip));
  return entries;
}

json left_out_json(const std::vector<LeftOut>& files) {
  json entries = json::array();
  for (const auto& file : files)
    entries.push_back({{"source", file.source}, {"reason", file.reason}});
  return entries;
}

json sources_json(const SourceRecord& sources) {
  json skeletons = json::array();
  for (const auto& skeleton : sources.skeletons)
    skeletons.push_back(source_skeleton_json(skeleton));
  return {{"skeletons", skeletons},
          {"skipped", left_out_json(sources.skipped)},
          {"duplicates", left_out_json(sources.duplicates)}};
}

// --- Reading -------------------------------------------------------------------------------------

std::vector<LeftOut> left_out_from(const json& entries) {
  std::vector<LeftOut> files;
  for (const auto& entry : entries)
    files.push_back({entry.at("source").get<std::string>(), entry.at("reason").get<std::string>()});
  return files;
}

class MetadataReader {
 public:
  explicit MetadataReader(const Container& container) : container_(container) {}

  DatabaseMetadata read() {
    read_settings();
    read_skeleton();
    read_sources();
    read_clips();
    return std::move(metadata_);
  }

 private:
  [[noreturn]] void refuse(const std::string& problem) const { container_.refuse(problem); }

  const std::string& text(const char* key) const { return container_.text(key); }

  void read_settings() {
    metadata_.rate_hz = json::parse(text("rate_hz")).get<double>();
    if (!(metadata_.rate_hz >= 1.0 && metadata_.rate_hz <= 1000.0))
      refuse("its frame rate is not between 1 and 1000 Hz");
    metadata_.build_info = text("build");
    metadata_.site_names = json::parse(text("sites")).get<std::vector<std::string>>();
    if (metadata_.site_names.empty()) refuse("it has no sensor sites");
    const std::set<std::string> names(metadata_.site_names.begin(), metadata_.site_names.end());
    if (names.size() != metadata_.site_names.size()) refuse("it has a sensor site twice");
  }

  void read_skeleton() {
    const json joints = json::parse(text("skeleton"));
    StandardBones bones;
    if (joints.size() != bones.size()) refuse("its skeleton has not 21 joints");
    for (std::size_t j = 0; j < bones.size(); ++j) {
      if (joints[j].at("name").get<std::string>() != standard_joint_names()[j])
        refuse("its skeleton has other joints");
      const auto bone = joints[j].at("bone_m").get<std::array<double, 3>>();
      bones[j] = {bone[0], bone[1], bone[2]};
      if (!bones[j].allFinite() || bones[j].norm() > 10.0) refuse("a bone's length is impossible");
    }
    metadata_.skeleton = make_standard_skeleton(bones);
  }

  void read_sources() {
    if (!container_.metadata().contains("sources")) return;  // not in every database
    const json sources = json::parse(text("sources"));
    for (const auto& entry : sources.at("skeletons")) {
      SourceSkeleton skeleton = source_skeleton_from(entry);
      if (skeleton.id.empty() || skeleton.num_joints < 1 ||
          !(skeleton.unit_scale > 0.0 && skeleton.unit_scale < 1e9))
        refuse("the skeleton '" + skeleton.id + "' of its sources is impossible");
      metadata_.sources.skeletons.push_back(std::move(skeleton));
    }
    metadata_.sources.skipped = left_out_from(sources.at("skipped"));
    metadata_.sources.duplicates = left_out_from(sources.at("duplicates"));
  }

  bool is_possible(const ClipTake& take) const {
    const auto& sites = metadata_.site_names;
    return std::isfinite(take.begin_s) && std::abs(take.correlation) <= 1.001 &&
           take.coverage >= 0.0 && take.coverage <= 1.0 &&
           std::all_of(take.channels.begin(), take.channels.end(), [&](const auto& entry) {
             return std::find(sites.begin(), sites.end(), entry.first) != sites.end();
           });
  }

  void check_clip(const Clip& clip, int expected_begin) const {
    const auto refuse_clip = [&](const char* problem) {
      refuse("clip '" + clip.name + "' " + problem);
    };
    if (clip.begin != expected_begin || clip.end <= clip.begin)
      refuse("the frames of clip '" + clip.name + "' do not follow the clip before it");
    if (!(clip.tempo > 0.0 && clip.tempo < 100.0)) refuse_clip("has an impossible tempo");
    if (clip.source_frames < 0 || !(clip.source_rate_hz >= 0.0 && clip.source_rate_hz < 1e6))
      refuse_clip("has an impossible source");
    if (clip.take && !is_possible(*clip.take)) refuse_clip("has an impossible take");
    const auto& skeletons = metadata_.sources.skeletons;
    if (!clip.skeleton.empty() &&
        std::none_of(skeletons.begin(), skeletons.end(),
                     [&](const SourceSkeleton& known) { return known.id == clip.skeleton; }))
      refuse_clip("names an unknown skeleton");
  }

  void read_clips() {
    int expected_begin = 0;
    for (const auto& entry : json::parse(text("clips"))) {
      Clip clip = clip_from(entry);
      check_clip(clip, expected_begin);
      expected_begin = clip.end;
      metadata_.clips.push_back(std::move(clip));
    }
  }

  const Container& container_;
  DatabaseMetadata metadata_;
};

}  // namespace

DatabaseMetadata read_database_metadata(const Container& container) {
  try {
    return MetadataReader(container).read();
  } catch (const json::exception&) {
    container.refuse("its metadata is damaged");
  }
}

std::map<std::string, std::string> text_of(const DatabaseMetadata& metadata) {
  return {{"rate_hz", json(metadata.rate_hz).dump()},
          {"filter", json{{"kind", "gaussian"},
                          {"marker_sigma_s", kMarkerFilter.sigma_s},
                          {"reading_sigma_s", kReadingFilter.sigma_s}}
                         .dump()},
          {"skeleton", skeleton_json(metadata.skeleton).dump()},
          {"sites", dumped(metadata.site_names)},
          {"clips", dumped(clips_json(metadata.clips))},
          {"sources", dumped(sources_json(metadata.sources))},
          {"build", metadata.build_info}};
}

const std::set<std::string>& database_metadata_keys() {
  static const std::set<std::string> keys{"rate_hz", "filter", "skeleton", "sites",
                                          "clips",   "build",  "sources"};
  return keys;
}

}  // namespace sparse_mocap
