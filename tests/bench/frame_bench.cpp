// SPDX-License-Identifier: GPL-3.0-or-later
//
// One frame from reading to pose, on a made-up database of about 30,000 frames.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "sparse_mocap/methods/registry.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

const std::shared_ptr<const MotionDatabase>& database() {
  static const auto made = [] {
    std::vector<Motion> motions;
    for (unsigned seed = 0; seed < 150; ++seed)
      motions.push_back(testing::swaying_motion(testing::template_skeleton(), seed, 200, 25.0));
    return testing::database_of(motions);
  }();
  return made;
}

// The performance: a movement that is not in the database.
std::vector<Reading> take() {
  const auto other =
      testing::database_of({testing::swaying_motion(testing::template_skeleton(), 999, 400, 25.0)});
  return testing::readings_of(*other, 0, testing::paper_sensors());
}

void frame(benchmark::State& state, const std::string& name) {
  const auto method = make_live_method(find_method(name), {},
                                       {database(), nullptr, {}, testing::paper_sensors(), {}});
  const auto readings = take();
  std::size_t t = 0;
  for (auto _ : state) {
    if (t == readings.size()) {
      state.PauseTiming();
      method->reset();
      t = 0;
      state.ResumeTiming();
    }
    benchmark::DoNotOptimize(method->step(readings[t++]));
  }
  state.counters["frames"] = benchmark::Counter(static_cast<double>(database()->num_frames()));
}
BENCHMARK_CAPTURE(frame, path_regression, "path_regression")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame, tautges2011, "tautges2011")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sparse_mocap
