// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/streams/xsens_frames.hpp"

#include <numeric>

#include "sparse_mocap/streams/wire.hpp"

namespace sparse_mocap::streams::xsens {
namespace {

constexpr std::uint8_t kExtended = 0xFF;

std::uint8_t sum_of(ByteView bytes) {
  return std::accumulate(bytes.begin(), bytes.end(), std::uint8_t{0},
                         [](auto a, auto b) { return static_cast<std::uint8_t>(a + b); });
}

}  // namespace

Head inspect(ByteView bytes, Counters& counters) {
  if (bytes[0] != kPreamble) return Head::skip();
  if (bytes.size() < 4) return Head::more();
  std::size_t header = 4, length = bytes[3];
  if (length == kExtended) {
    if (bytes.size() < 6) return Head::more();
    header = 6;
    length = read_big<std::uint16_t>(&bytes[4]);
    if (length > kLongestData) {
      ++counters[Count::overruns];
      return Head::skip();
    }
  }
  const std::size_t size = header + length + 1;
  if (bytes.size() < size) return Head::more();
  if (sum_of(bytes.subspan(1, size - 1)) == 0) return Head::frame(size);
  ++counters[Count::bad_checksums];
  return Head::skip();
}

Message open(ByteView frame) {
  const std::size_t header = frame[3] == kExtended ? 6 : 4;
  return {frame[1], frame[2], frame.subspan(header, frame.size() - header - 1)};
}

Bytes seal(std::uint8_t bus, std::uint8_t id, ByteView data) {
  Bytes frame{kPreamble, bus, id};
  if (data.size() < kExtended) {
    frame.push_back(static_cast<std::uint8_t>(data.size()));
  } else {
    frame.push_back(kExtended);
    append_big(frame, static_cast<std::uint16_t>(data.size()));
  }
  frame.insert(frame.end(), data.begin(), data.end());
  frame.push_back(static_cast<std::uint8_t>(-sum_of(ByteView(frame).subspan(1))));
  return frame;
}

}  // namespace sparse_mocap::streams::xsens
