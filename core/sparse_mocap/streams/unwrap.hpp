// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace sparse_mocap::streams {

// A device's clock that goes back by less was read late, as micros() may be in an interrupt; one
// that goes back further was restarted.
inline constexpr double kSmallStepBack_s = 0.1;

// Unwraps a device's packet counter of a few bits to an ever-growing count.
class PacketCounter {
 public:
  struct Step {
    std::int64_t counter = 0;
    std::int64_t missing = 0;  // how many packets were lost before this one
    bool is_repeated = false;
    bool is_backwards = false;  // the counter restarted; the next step is from here
  };

  explicit PacketCounter(int bits) : bits_(bits) {}

  Step unwrap(std::uint64_t raw);

 private:
  int bits_;
  bool is_started_ = false;
  std::uint64_t last_raw_ = 0;
  std::int64_t counter_ = 0;
};

// Unwraps a device's clock of a few bits to an ascending time.
class TickClock {
 public:
  struct Step {
    double time_s = 0.0;
    bool is_repeated = false;   // or a little before the last
    bool is_restarted = false;  // it went back; the last step is repeated instead
  };

  TickClock(int bits, double tick_s) : bits_(bits), tick_s_(tick_s) {}

  Step unwrap(std::uint64_t raw);

 private:
  int bits_;
  double tick_s_;
  bool is_started_ = false;
  std::uint64_t last_raw_ = 0;
  std::int64_t last_step_ = 1;
  std::int64_t ticks_ = 0;
};

}  // namespace sparse_mocap::streams
