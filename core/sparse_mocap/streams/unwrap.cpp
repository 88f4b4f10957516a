// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/streams/unwrap.hpp"

#include <algorithm>
#include <limits>

namespace sparse_mocap::streams {
namespace {

// The difference of two counts of so many bits, in the shorter direction.
std::int64_t signed_step(std::uint64_t from, std::uint64_t to, int bits) {
  const int unused = 64 - bits;
  return static_cast<std::int64_t>((to - from) << unused) >> unused;
}

}  // namespace

PacketCounter::Step PacketCounter::unwrap(std::uint64_t raw) {
  Step step;
  const std::int64_t by = is_started_ ? signed_step(last_raw_, raw, bits_) : 1;
  step.is_repeated = by == 0;
  step.is_backwards = by < 0;
  if (is_started_) {
    counter_ += std::max<std::int64_t>(by, 0);
    step.missing = std::max<std::int64_t>(by - 1, 0);
  } else {
    counter_ = static_cast<std::int64_t>(raw);
  }
  is_started_ = true;
  last_raw_ = raw;
  step.counter = counter_;
  return step;
}

TickClock::Step TickClock::unwrap(std::uint64_t raw) {
  // No clock of 64 bits counts this far.
  raw = std::min<std::uint64_t>(raw, std::numeric_limits<std::int64_t>::max() / 4);
  Step step;
  if (!is_started_) {
    ticks_ = static_cast<std::int64_t>(raw);
    is_started_ = true;
  } else {
    const std::int64_t by = signed_step(last_raw_, raw, bits_);
    step.is_repeated = by <= 0 && static_cast<double>(by) * tick_s_ > -kSmallStepBack_s;
    step.is_restarted = by < 0 && !step.is_repeated;
    if (by > 0) last_step_ = by;
    const std::int64_t ahead = step.is_repeated ? 0 : last_step_;
    const std::int64_t room = std::numeric_limits<std::int64_t>::max() - ticks_;
    ticks_ += std::min(ahead, room);
  }
  if (!step.is_repeated) last_raw_ = raw;
  step.time_s = static_cast<double>(ticks_) * tick_s_;
  return step;
}

}  // namespace sparse_mocap::streams
