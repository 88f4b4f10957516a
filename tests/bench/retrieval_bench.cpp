// SPDX-License-Identifier: GPL-3.0-or-later
//
// Retrieval, sections 3 and 4: the exact K nearest readings and the graph of paths, K = 4096.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <map>
#include <memory>
#include <nanoflann.hpp>
#include <vector>

#include "sparse_mocap/retrieval/knn_index.hpp"
#include "sparse_mocap/retrieval/olng.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {

using namespace retrieval;

namespace {

constexpr int kDimensions = 12;
constexpr std::size_t kNeighbours = 4096;

// Four sensors' readings that wander (m/s^2). Limbs move together: five walks and some noise make
// the twelve columns, about as many degrees of freedom as recorded readings have.
FeatureRows random_walk(Eigen::Index rows, unsigned seed) {
  const Eigen::MatrixXd mix = testing::Random(0).matrix(kDimensions, 5, 1.0);
  testing::Random random(seed);
  FeatureRows out(rows, kDimensions);
  Eigen::VectorXd now = random.column(5, 10.0);
  for (Eigen::Index r = 0; r < rows; ++r) {
    now = 0.95 * now + random.column(5, 4.0);
    out.row(r) = (mix * now + random.column(kDimensions, 0.5)).transpose().cast<float>();
  }
  return out;
}

const FeatureRows& rows_of(std::int64_t count) {
  static std::map<std::int64_t, FeatureRows> made;
  const auto [at, is_new] = made.try_emplace(count);
  if (is_new) at->second = random_walk(count, 1);
  return at->second;
}

std::vector<std::vector<float>> queries() {
  const FeatureRows rows = random_walk(256, 2);
  std::vector<std::vector<float>> out;
  for (const auto& row : rows.rowwise()) out.emplace_back(row.begin(), row.end());
  return out;
}

void knn_build(benchmark::State& state) {
  const FeatureRows& rows = rows_of(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(KnnIndex(rows));
}
BENCHMARK(knn_build)
    ->Arg(30'000)
    ->Arg(600'000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()  // on all processors
    ->UseRealTime();

void knn_search(benchmark::State& state) {
  const KnnIndex index(rows_of(state.range(0)));
  const auto asked = queries();
  std::vector<Neighbour> found;
  std::size_t i = 0;
  for (auto _ : state) {
    index.search(asked[i++ % asked.size()], static_cast<int>(kNeighbours), found);
    benchmark::DoNotOptimize(found.data());
  }
}
BENCHMARK(knn_search)->Arg(30'000)->Arg(600'000)->Unit(benchmark::kMillisecond);

// The baseline: nanoflann as it comes.
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
using PlainTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>,
                                                      Points, kDimensions, std::uint32_t>;

void knn_search_by_nanoflann(benchmark::State& state) {
  const Points points{rows_of(state.range(0))};
  PlainTree tree(kDimensions, points, nanoflann::KDTreeSingleIndexAdaptorParams(32));
  tree.buildIndex();
  const auto asked = queries();
  std::vector<std::uint32_t> rows(kNeighbours);
  std::vector<float> squares(kNeighbours);
  std::size_t i = 0;
  for (auto _ : state) {
    tree.knnSearch(asked[i++ % asked.size()].data(), kNeighbours, rows.data(), squares.data());
    benchmark::DoNotOptimize(rows.data());
  }
}
BENCHMARK(knn_search_by_nanoflann)->Arg(30'000)->Arg(600'000)->Unit(benchmark::kMillisecond);

// One reading's column, neighbours of a wandering query; window 0 forgets, 20 cuts.
void olng_extend(benchmark::State& state) {
  const auto count = state.range(0);
  const KnnIndex index(rows_of(count));
  std::vector<std::vector<Neighbour>> columns;
  for (const auto& query : queries())
    index.search(query, static_cast<int>(kNeighbours), columns.emplace_back());
  std::vector<std::int32_t> clips;
  for (std::int64_t n = 0; n < count; ++n) clips.push_back(static_cast<std::int32_t>(n / 200));
  OlngConfig config;
  config.window = static_cast<int>(state.range(1));
  if (config.window > 0) config.forgetting = 1.0;
  OnlineLazyNeighbourhoodGraph graph(clips, config);
  std::size_t i = 0;
  for (auto _ : state) {
    graph.extend(columns[i++ % columns.size()]);
    benchmark::DoNotOptimize(graph.paths().data());
  }
}
BENCHMARK(olng_extend)
    ->Args({30'000, 0})
    ->Args({600'000, 0})
    ->Args({600'000, 20})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sparse_mocap
