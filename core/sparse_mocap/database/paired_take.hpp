// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "sparse_mocap/database/clip_import.hpp"
#include "sparse_mocap/motion/skeleton.hpp"
#include "sparse_mocap/readings/reading_stream.hpp"

namespace sparse_mocap {

// What sensors recorded while a motion file was performed.
struct PairedTake {
  std::string name;  // the take's file
  std::string hash;  // as ClipTake
  std::vector<SensorInput> sensors;
  std::vector<SensorRecording> recordings;  // one a sensor
  double begin_s = 0.0;                     // when the motion begins, on the take's clock
  double correlation = 0.0;                 // as TakeAlignment
};

// Puts what the sensors measured into the file's rows, in place of what virtual ones read. Rows of
// copies get what the same sensors would have measured: played backwards, readings follow one
// another backwards; at another tempo, all but gravity grows with its square, and turning with the
// tempo. Mirrored copies keep virtual readings, since the sensors were not on the other side.
//
// Channels that a sensor lacks, and rows during which nothing was recorded, stay virtual. Gives how
// many rows of the motion itself got real readings.
int put_real_readings(const PairedTake& take, const Skeleton& skeleton, double rate_hz,
                      ImportedFile& file);

// Puts the readings that a clip's rows have of its take into rows of the same motion.
void keep_real_readings(const ClipTake& take, const PackedRows& from, PackedRows& to);

}  // namespace sparse_mocap
