// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "sparse_mocap/motion/extremities.hpp"

namespace sparse_mocap {

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
  int begin = 0;
  int end = 0;

  int num_frames() const { return end - begin; }
  // Whether it is another clip mirrored, reversed or at another tempo.
  bool is_copy() const { return is_mirrored || is_reversed || tempo != 1.0; }
};

inline bool has_any_extremity(const Clip& clip) {
  return clip.has_extremity != std::array<bool, kNumExtremities>{};
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
