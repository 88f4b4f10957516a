// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sparse_mocap/motion/extremities.hpp"
#include "sparse_mocap/readings/reading.hpp"

namespace sparse_mocap {

// What real sensors measured while a clip was performed, which its rows hold in place of what
// virtual ones read.
struct ClipTake {
  std::string name;                          // the take's file
  std::string hash;                          // tells its content from any other: SHA-256
  double begin_s = 0.0;                      // when the clip begins, on the take's clock
  double correlation = 0.0;                  // as TakeAlignment
  double coverage = 0.0;                     // part of the rows that hold real readings
  std::map<std::string, Channels> channels;  // by the sensors' sites

  bool operator==(const ClipTake&) const = default;
};

// A stretch of rows [begin, end) that is one continuous motion.
struct Clip {
  std::string name;
  std::string actor;
  std::string motion_class;
  std::string source;         // the file, relative to the folder that was built from, with '/'
  std::string source_hash;    // XXH3 of the file
  std::string skeleton_hash;  // XXH3 of the .asf that was read with it, "" for other formats
  std::string skeleton;       // id of its SourceSkeleton; "" in databases that do not say
  std::string origin;         // a note: where the recording comes from
  std::string license;        // a note: on which terms it may be used
  int source_frames = 0;      // of the file; 0 in databases that do not say
  double source_rate_hz = 0.0;
  // What was odd about the file: each kind of warning (numbers and names left out) and how often.
  // Empty for copies.
  std::map<std::string, int> warnings;
  // Which of feet, toes and hands its file has, see extremity::Index.
  std::array<bool, kNumExtremities> has_extremity{};
  bool is_mirrored = false;
  bool is_reversed = false;
  double tempo = 1.0;  // how much faster than performed
  std::optional<ClipTake> take;
  int begin = 0;
  int end = 0;

  int num_frames() const { return end - begin; }
  // Whether it is another clip mirrored, reversed or at another tempo.
  bool is_copy() const { return is_mirrored || is_reversed || tempo != 1.0; }
};

inline bool has_any_extremity(const Clip& clip) {
  return clip.has_extremity != std::array<bool, kNumExtremities>{};
}

// Whether the clip's rows hold what a real sensor at this site measured in a channel.
inline bool is_real(const Clip& clip, const std::string& site, Channel channel) {
  if (!clip.take) return false;
  const auto at = clip.take->channels.find(site);
  return at != clip.take->channels.end() && at->second.has(channel);
}

// Whether any of the clips has an orientation that a sensor at this site told.
inline bool has_real_orientation(const std::vector<Clip>& clips, const std::string& site) {
  return std::any_of(clips.begin(), clips.end(),
                     [&](const Clip& clip) { return is_real(clip, site, Channel::orientation); });
}

// One kind of skeleton among the sources: files whose joints have the same names and parents.
struct SourceSkeleton {
  std::string id;
  int num_joints = 0;
  std::map<std::string, std::string> joints;  // standard joint to the source's that moves it
  double unit_scale = 1.0;                    // its lengths as read times this are metres

  bool operator==(const SourceSkeleton&) const = default;
};

// A file that a database does not hold.
struct LeftOut {
  std::string source;  // as Clip::source
  std::string reason;

  bool operator==(const LeftOut&) const = default;
};

// What a database says about the files it was made from, beside its clips.
struct SourceRecord {
  std::vector<SourceSkeleton> skeletons;
  std::vector<LeftOut> skipped;     // could not be used
  std::vector<LeftOut> duplicates;  // the same motion is there already
};

}  // namespace sparse_mocap
