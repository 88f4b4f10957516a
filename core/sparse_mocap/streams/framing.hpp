// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "sparse_mocap/streams/counters.hpp"
#include "sparse_mocap/streams/stream_parser.hpp"

namespace sparse_mocap::streams {

// What the unread bytes start with.
struct Head {
  enum class Kind { need_more, frame, skip };

  Kind kind = Kind::need_more;
  std::size_t size = 0;  // of the frame

  static Head more() { return {}; }
  static Head skip() { return {Kind::skip, 0}; }
  static Head frame(std::size_t size) { return {Kind::frame, size}; }
};

// Splits a stream of bytes into frames. Where no frame starts it advances by one byte, so that a
// damaged frame never hides a good one behind it.
class FrameScanner {
 public:
  // capacity: the length of the longest frame.
  explicit FrameScanner(std::size_t capacity) : capacity_(capacity) {}

  // inspect classifies the unread bytes from their start; accept receives complete frames.
  void feed(ByteView bytes, Counters& counters, const std::function<Head(ByteView)>& inspect,
            const std::function<void(ByteView)>& accept);
  void reset();

 private:
  void scan(Counters& counters, const std::function<Head(ByteView)>& inspect,
            const std::function<void(ByteView)>& accept);

  std::size_t capacity_;
  Bytes pending_;
  bool is_skipping_ = false;
};

// Splits a stream of bytes into lines that end in '\n'. Longer ones are dropped and counted.
class LineSplitter {
 public:
  static constexpr std::size_t kLongestLine = 4096;

  void feed(ByteView bytes, Counters& counters, const std::function<void(ByteView)>& accept);
  void reset();

 private:
  Bytes line_;
  bool is_too_long_ = false;
};

}  // namespace sparse_mocap::streams
