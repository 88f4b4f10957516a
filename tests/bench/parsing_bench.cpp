// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reading motion files, beside a reader that only calls strtod. Recorded files where they are at
// hand (see tests/core/support/real_data.hpp), else one made here. The label is the file;
// parsing_bench.py times a public Python reader on it.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "sparse_mocap/base/files.hpp"
#include "sparse_mocap/formats/acclaim.hpp"
#include "sparse_mocap/formats/acclaim_writer.hpp"
#include "sparse_mocap/formats/bvh.hpp"
#include "support/real_data.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

namespace fs = std::filesystem;

// The recorded file, or the motion made here in the same format.
fs::path motion_file(const std::string& recorded) {
  if (const auto path = testing::real_data(recorded); !path.empty()) return fs::canonical(path);
  const auto made =
      fs::path(SPARSE_MOCAP_BENCH_DIR) / ("made" + fs::path(recorded).extension().string());
  const auto motion = testing::swaying_motion(testing::template_skeleton(), 1, 5000, 120.0);
  (made.extension() == ".bvh" ? write_bvh : write_acclaim)(made, motion);
  return made;
}

fs::path bvh_file() { return motion_file("cmu/bvh/02_10.bvh"); }
fs::path amc_file() { return motion_file("cmu/asf_amc/01_07.amc"); }

void report(benchmark::State& state, const std::string& text, const fs::path& path) {
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) *
                          static_cast<std::int64_t>(text.size()));
  state.SetLabel(path.string());
}

void parse_bvh_sparse_mocap(benchmark::State& state) {
  const auto path = bvh_file();
  const auto text = read_file(path, ReadOptions().max_bytes);
  for (auto _ : state) benchmark::DoNotOptimize(bvh_from_text(text, path));
  report(state, text, path);
}

void parse_amc_sparse_mocap(benchmark::State& state) {
  const auto path = amc_file();
  const auto text = read_file(path, ReadOptions().max_bytes);
  const auto skeleton = read_asf(find_asf(path));
  for (auto _ : state) benchmark::DoNotOptimize(amc_from_text(text, path, skeleton));
  report(state, text, path);
}

// The numbers from here on, and nothing else.
void append_numbers(const char* cursor, std::vector<double>& numbers) {
  for (char* end = nullptr;; cursor = end) {
    const double value = std::strtod(cursor, &end);
    if (end == cursor) return;
    numbers.push_back(value);
  }
}

void parse_bvh_strtod(benchmark::State& state) {
  const auto path = bvh_file();
  const auto text = read_file(path, ReadOptions().max_bytes);
  for (auto _ : state) {
    std::vector<double> numbers;
    const auto rows = text.find('\n', text.find("Frame Time"));
    append_numbers(text.c_str() + rows, numbers);
    benchmark::DoNotOptimize(numbers);
  }
  report(state, text, path);
}

// Every word is skipped, so that the numbers behind the bones' names are reached.
void parse_amc_strtod(benchmark::State& state) {
  const auto path = amc_file();
  const auto text = read_file(path, ReadOptions().max_bytes);
  for (auto _ : state) {
    std::vector<double> numbers;
    const char* cursor = text.c_str() + text.find("\n1");
    while (*cursor != '\0') {
      char* end = nullptr;
      const double value = std::strtod(cursor, &end);
      if (end != cursor) {
        numbers.push_back(value);
        cursor = end;
      } else {
        while (*cursor == ' ' || *cursor == '\r' || *cursor == '\n') ++cursor;
        while (*cursor != '\0' && *cursor != ' ' && *cursor != '\n') ++cursor;
      }
    }
    benchmark::DoNotOptimize(numbers);
  }
  report(state, text, path);
}

BENCHMARK(parse_bvh_sparse_mocap)->Name("parse_bvh/sparse_mocap")->Unit(benchmark::kMillisecond);
BENCHMARK(parse_bvh_strtod)->Name("parse_bvh/strtod")->Unit(benchmark::kMillisecond);
BENCHMARK(parse_amc_sparse_mocap)->Name("parse_amc/sparse_mocap")->Unit(benchmark::kMillisecond);
BENCHMARK(parse_amc_strtod)->Name("parse_amc/strtod")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sparse_mocap
