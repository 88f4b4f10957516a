// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "sparse_mocap/streams/stream_parser.hpp"
#include "sparse_mocap/streams/wire.hpp"

namespace sparse_mocap::streams::slimevr {

enum Type : std::int32_t {
  kHeartbeat = 0,
  kOldRotation = 1,  // of the first sensor: owoTrack
  kHandshake = 3,
  kAcceleration = 4,
  kPing = 10,
  kBattery = 12,
  kSensorInfo = 15,
  kOldSecondRotation = 16,
  kRotation = 17,
  kRotationAndAcceleration = 23,
  kBundle = 100,
  kCompactBundle = 101,
};
constexpr std::int32_t kHighestType = 30;  // of the others, such as battery and signal strength

inline constexpr std::uint8_t kNormalRotation = 1;
// Earlier protocols turn the acceleration by 90 degrees about z.
inline constexpr std::int32_t kTurnedBefore = 22;

// What a datagram starts with.
inline Bytes header(std::int32_t type, std::int64_t number) {
  Bytes packet;
  append_big(packet, type);
  append_big(packet, number);
  return packet;
}

}  // namespace sparse_mocap::streams::slimevr
