// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace sparse_mocap::streams {

// The counters of a parser.
enum class Count {
  samples,
  frames,  // whole frames, lines or datagrams that were understood
  bad_checksums,
  malformed,  // framed or spelt right, but not what the protocol allows inside
  resyncs,    // how often bytes had to be skipped to find a frame
  skipped_bytes,
  unknown_types,    // frames or fields of a type that the parser does not know
  overruns,         // longer than any frame may be
  missing_samples,  // by the device's counter
  repeated,         // the same counter or time again
  out_of_order,     // a counter that went back
  device_resets,    // the device reported a restart, or its clock restarted
  device_errors,    // the device reported an error
  unconfigured,     // data before their layout is known
  incomplete,       // parts of a sample whose other parts never came
  implausible,      // not finite, or beyond what any such sensor reads
  too_many_sensors,
};

inline constexpr std::size_t kNumCounts = static_cast<std::size_t>(Count::too_many_sensors) + 1;

std::string_view count_name(Count count);

class Counters {
 public:
  std::uint64_t& operator[](Count count) { return values_[static_cast<std::size_t>(count)]; }
  std::uint64_t operator[](Count count) const { return values_[static_cast<std::size_t>(count)]; }
  bool operator==(const Counters&) const = default;

 private:
  std::array<std::uint64_t, kNumCounts> values_{};
};

}  // namespace sparse_mocap::streams
