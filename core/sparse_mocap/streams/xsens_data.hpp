// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "sparse_mocap/streams/stream_parser.hpp"

namespace sparse_mocap::streams::xsens {

// One sensor's part of a measurement message.
struct Measured {
  Sample sample;
  std::optional<std::uint16_t> counter;
  std::optional<std::uint32_t> time_fine;            // SampleTimeFine
  Vec3 free_acceleration = Vec3::Constant(kAbsent);  // without gravity, in the device's world
  std::uint64_t num_unknown = 0;                     // fields of unknown type, skipped
};

// The layout of an MTData message (OutputMode and OutputSettings of MT0101P).
struct Layout {
  unsigned mode = 0;
  unsigned settings = 0;

  std::size_t length() const;  // in bytes, with the sample counter if settings include one
};

inline constexpr unsigned kModeCalibrated = 0x0002;
inline constexpr unsigned kModeOrientation = 0x0004;
inline constexpr unsigned kSettingsCounter = 0x0001;

// MTData2: fields of [type u16][size u8][data]. Nothing when a field contradicts its type or runs
// beyond the end.
std::optional<Measured> read_data2(ByteView data);

// One sensor's block of MTData. Nothing when the length is not the layout's.
std::optional<Measured> read_data(ByteView block, const Layout& layout);

}  // namespace sparse_mocap::streams::xsens
