// SPDX-License-Identifier: GPL-3.0-or-later
//
// The exact K = 4096 nearest rows among those of recorded motion, beside a plain scan and
// nanoflann. The rows are written to files, on which faiss_bench.py times FAISS.
#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nanoflann.hpp>
#include <string>
#include <vector>

#include "latencies.hpp"
#include "recorded.hpp"
#include "sparse_mocap/retrieval/knn_index.hpp"

namespace sparse_mocap::testing {
namespace {

using retrieval::FeatureRows;
using retrieval::KnnIndex;
using retrieval::Neighbour;

constexpr int kNeighbours = 4096;
constexpr Eigen::Index kDimensionsOfSensor = 3;

void write_rows(const FeatureRows& rows, const std::string& name) {
  std::ofstream file(std::filesystem::path(SPARSE_MOCAP_BENCH_DIR) / (name + ".f32"),
                     std::ios::binary);
  file.write(reinterpret_cast<const char*>(rows.data()),
             static_cast<std::streamsize>(sizeof(float)) * rows.size());
}

// The rows that were asked for last stay.
const SearchedRows& kept_rows(const std::string& size, int dimensions) {
  static std::string kept_name;
  static SearchedRows kept;
  const std::string name = size + "-" + std::to_string(dimensions);
  if (kept_name != name) {
    kept = {};
    kept = searched_rows(size, dimensions);
    kept_name = name;
    if (size != "5m") write_rows(kept.rows, "rows-" + name);
    if (size != "5m") write_rows(kept.queries, "queries-" + name);
  }
  return kept;
}

// Which searches are timed.
struct Case {
  std::string size;
  int dimensions = 12;
  int num_silent = 0;  // sensors
};

std::vector<std::vector<float>> queries_of(const Case& searched) {
  const FeatureRows& queries = kept_rows(searched.size, searched.dimensions).queries;
  const auto num_parts = searched.dimensions / 12;
  std::vector<std::vector<float>> out;
  for (const auto& row : queries.rowwise()) {
    auto& query = out.emplace_back(row.begin(), row.end());
    for (int part = 0; part < num_parts; ++part)
      std::fill_n(query.begin() + 12 * part, kDimensionsOfSensor * searched.num_silent, NAN);
  }
  return out;
}

// search(query) for one query after another.
template <typename Search>
void time_search(benchmark::State& state, const Case& searched, const Search& search) {
  const auto queries = queries_of(searched);
  Latencies latencies;
  std::size_t i = 0;
  for (auto _ : state) {
    latencies.begin();
    search(queries[i++ % queries.size()]);
    latencies.end();
  }
  latencies.report(state);
}

void knn_search(benchmark::State& state, const Case& searched) {
  const KnnIndex index(kept_rows(searched.size, searched.dimensions).rows);
  std::vector<Neighbour> found;
  time_search(state, searched, [&](const std::vector<float>& query) {
    index.search(query, kNeighbours, found);
    benchmark::DoNotOptimize(found.data());
  });
}

void knn_build(benchmark::State& state, const Case& searched) {
  const FeatureRows& rows = kept_rows(searched.size, searched.dimensions).rows;
  for (auto _ : state) benchmark::DoNotOptimize(KnnIndex(rows));
}

// All distances, then the smallest of them.
void plain_scan(benchmark::State& state, const Case& searched) {
  const FeatureRows& rows = kept_rows(searched.size, searched.dimensions).rows;
  std::vector<std::pair<float, int>> all(static_cast<std::size_t>(rows.rows()));
  time_search(state, searched, [&](const std::vector<float>& query) {
    const Eigen::Map<const Eigen::RowVectorXf> asked(query.data(), rows.cols());
    for (Eigen::Index r = 0; r < rows.rows(); ++r)
      all[static_cast<std::size_t>(r)] = {(rows.row(r) - asked).squaredNorm(), static_cast<int>(r)};
    std::nth_element(all.begin(), all.begin() + kNeighbours, all.end());
    std::sort(all.begin(), all.begin() + kNeighbours);
    benchmark::DoNotOptimize(all.data());
  });
}

struct Points {
  const FeatureRows& rows;
  std::size_t kdtree_get_point_count() const { return static_cast<std::size_t>(rows.rows()); }
  float kdtree_get_pt(std::size_t row, std::size_t column) const {
    return rows(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>,
                                                 Points, -1, std::uint32_t>;

void nanoflann_search(benchmark::State& state, const Case& searched) {
  const Points points{kept_rows(searched.size, searched.dimensions).rows};
  Tree tree(searched.dimensions, points, nanoflann::KDTreeSingleIndexAdaptorParams(32));
  tree.buildIndex();
  std::vector<std::uint32_t> rows(kNeighbours);
  std::vector<float> squares(kNeighbours);
  time_search(state, searched, [&](const std::vector<float>& query) {
    tree.knnSearch(query.data(), kNeighbours, rows.data(), squares.data());
    benchmark::DoNotOptimize(rows.data());
  });
}

void add(const std::string& name, void (*run)(benchmark::State&, const Case&), const Case& searched,
         int iterations) {
  const std::string title =
      "recorded_knn/" + name + "/" + std::to_string(searched.dimensions) + "d/" + searched.size;
  auto* added = benchmark::RegisterBenchmark(title.c_str(), run, searched)
                    ->Unit(benchmark::kMillisecond)
                    ->Iterations(iterations);
  if (name == "build") added->MeasureProcessCPUTime()->UseRealTime();  // on all processors
}

const bool is_registered = [] {
  for (const auto& size : recorded_sizes())
    for (const int dimensions : {12, 24}) {
      const bool is_largest = size == "5m";
      add("sparse_mocap", knn_search, {size, dimensions, 0}, is_largest ? 100 : 500);
      add("silent_sensor", knn_search, {size, dimensions, 1}, is_largest ? 100 : 500);
      add("build", knn_build, {size, dimensions, 0}, 1);
      add("plain_scan", plain_scan, {size, dimensions, 0}, is_largest ? 5 : 20);
      add("nanoflann", nanoflann_search, {size, dimensions, 0}, is_largest ? 5 : 20);
    }
  return true;
}();

}  // namespace
}  // namespace sparse_mocap::testing
