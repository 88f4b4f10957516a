// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/streams/counters.hpp"

namespace sparse_mocap::streams {

std::string_view count_name(Count count) {
  static constexpr std::array<std::string_view, kNumCounts> kNames{
      "samples",       "frames",          "bad_checksums", "malformed",       "resyncs",
      "skipped_bytes", "unknown_types",   "overruns",      "missing_samples", "repeated",
      "out_of_order",  "device_resets",   "device_errors", "unconfigured",    "incomplete",
      "implausible",   "too_many_sensors"};
  return kNames[static_cast<std::size_t>(count)];
}

}  // namespace sparse_mocap::streams
