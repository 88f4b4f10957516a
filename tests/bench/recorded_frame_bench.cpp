// SPDX-License-Identifier: GPL-3.0-or-later
//
// Frames of live quality, whole takes in best quality, and the opening of databases of recorded
// motion.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>

#include "latencies.hpp"
#include "recorded.hpp"
#include "sparse_mocap/methods/registry.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::testing {
namespace {

MethodContext context_of(const std::string& size) {
  return {recorded_database(size), nullptr, {}, paper_sensors(), {}};
}

void frame(benchmark::State& state, const std::string& method_name, const std::string& size) {
  const auto method = make_live_method(find_method(method_name), {}, context_of(size));
  const auto readings = recorded_performances();
  constexpr std::size_t kWarmUp = 10;
  for (std::size_t t = 0; t < kWarmUp; ++t) method->step(readings[t]);
  Latencies latencies;
  std::size_t t = kWarmUp;
  for (auto _ : state) {
    latencies.begin();
    benchmark::DoNotOptimize(method->step(readings[t++ % readings.size()]));
    latencies.end();
  }
  latencies.report(state);
}

// In real time, for it uses all processors; the counter says what a frame takes.
void whole_take(benchmark::State& state, const std::string& size) {
  const auto method = make_whole_take_method(find_method("path_regression"), {}, context_of(size));
  auto readings = recorded_performances();
  readings.resize(std::min<std::size_t>(readings.size(), 1500));  // a minute
  for (auto _ : state) benchmark::DoNotOptimize(method->solve(readings, Progress()));
  state.counters["frames"] = static_cast<double>(readings.size());
}

void opening(benchmark::State& state, const std::string& size) {
  for (auto _ : state) benchmark::DoNotOptimize(MotionDatabase::open(recorded_path(size)));
}

void making_method(benchmark::State& state, const std::string& size) {
  const auto context = context_of(size);
  for (auto _ : state)
    benchmark::DoNotOptimize(make_live_method(find_method("path_regression"), {}, context));
}

const bool is_registered = [] {
  for (const auto& size : recorded_sizes()) {
    for (const std::string method : {"path_regression", "tautges2011"})
      benchmark::RegisterBenchmark(("recorded_frame/" + method + "/" + size).c_str(), frame, method,
                                   size)
          ->Unit(benchmark::kMillisecond)
          ->Iterations(size == "5m" ? 300 : 1000);
    benchmark::RegisterBenchmark(("recorded_whole_take/path_regression/" + size).c_str(),
                                 whole_take, size)
        ->Unit(benchmark::kMillisecond)
        ->Iterations(1)
        ->MeasureProcessCPUTime()
        ->UseRealTime();
    benchmark::RegisterBenchmark(("recorded_opening/database/" + size).c_str(), opening, size)
        ->Unit(benchmark::kMillisecond)
        ->Iterations(3)
        ->MeasureProcessCPUTime()
        ->UseRealTime();
    benchmark::RegisterBenchmark(("recorded_opening/method/" + size).c_str(), making_method, size)
        ->Unit(benchmark::kMillisecond)
        ->Iterations(3)
        ->MeasureProcessCPUTime()
        ->UseRealTime();
  }
  return true;
}();

}  // namespace
}  // namespace sparse_mocap::testing
