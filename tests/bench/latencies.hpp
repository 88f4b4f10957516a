// SPDX-License-Identifier: GPL-3.0-or-later
//
// What one call costs, call by call: a mean hides the slow ones that a live preview stumbles over.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <vector>

namespace sparse_mocap::testing {

// Processor time of this thread, so that other programs on the machine count little.
class Latencies {
 public:
  void begin() { begun_ms_ = now_ms(); }
  void end() { all_ms_.push_back(now_ms() - begun_ms_); }

  // Adds p50_ms, p99_ms and worst_ms to the results.
  void report(benchmark::State& state) {
    if (all_ms_.empty()) return;
    std::sort(all_ms_.begin(), all_ms_.end());
    state.counters["p50_ms"] = at_share(0.5);
    state.counters["p99_ms"] = at_share(0.99);
    state.counters["worst_ms"] = all_ms_.back();
  }

 private:
  static double now_ms() {
    std::timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
  }
  double at_share(double share) const {
    return all_ms_[static_cast<std::size_t>(share * static_cast<double>(all_ms_.size() - 1))];
  }

  double begun_ms_ = 0.0;
  std::vector<double> all_ms_;
};

}  // namespace sparse_mocap::testing
