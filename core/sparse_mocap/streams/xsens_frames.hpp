// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/streams/framing.hpp"

namespace sparse_mocap::streams::xsens {

// Xsens low-level protocol (MT0101P, MT0605P): FA BID MID LEN DATA CS, or with LEN FF two bytes of
// length. All bytes after FA add up to 0 mod 256. Numbers are big-endian.
inline constexpr std::uint8_t kPreamble = 0xFA;
inline constexpr std::uint8_t kMasterBus = 0xFF;
inline constexpr std::size_t kLongestData = 2048;
inline constexpr std::size_t kLongestFrame = kLongestData + 7;

enum MessageId : std::uint8_t {
  kReqDeviceId = 0x00,
  kDeviceId = 0x01,
  kInitBus = 0x02,
  kSetPeriod = 0x04,
  kReqConfiguration = 0x0C,
  kConfiguration = 0x0D,
  kGoToMeasurement = 0x10,
  kGoToConfig = 0x30,
  kData = 0x32,
  kData2 = 0x36,
  kWakeUp = 0x3E,
  kWakeUpAck = 0x3F,
  kReset = 0x40,
  kError = 0x42,
  kSetOutputConfiguration = 0xC0,
  kSetOutputMode = 0xD0,
  kSetOutputSettings = 0xD2,
};

struct Message {
  std::uint8_t bus = kMasterBus;
  std::uint8_t id = 0;
  ByteView data;
};

// Classifies the start of the bytes; counts bad checksums and impossible lengths.
Head inspect(ByteView bytes, Counters& counters);

// The message of a frame that inspect found.
Message open(ByteView frame);

// A frame; extended where the data are longer than 254 bytes.
Bytes seal(std::uint8_t bus, std::uint8_t id, ByteView data = {});

}  // namespace sparse_mocap::streams::xsens
