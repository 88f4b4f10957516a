// SPDX-License-Identifier: GPL-3.0-or-later
//
// One frame of the paper's method, stage by stage as in its Table III, on a database of recorded
// motion that is about as large as the paper's, with its K = 4096 and I = 256; and the graph of
// paths beside one that is made anew for each reading from the last M of them.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "ceres_least_squares.hpp"
#include "latencies.hpp"
#include "recorded.hpp"
#include "sparse_mocap/retrieval/knn_index.hpp"
#include "sparse_mocap/retrieval/olng.hpp"
#include "sparse_mocap/retrieval/signals.hpp"
#include "support/synthetic.hpp"
#include "tautges2011/ceres_minimizer.hpp"
#include "tautges2011/neighbourhoods.hpp"

namespace sparse_mocap::testing {
namespace {

using retrieval::KnnIndex;
using retrieval::Neighbour;
using retrieval::OnlineLazyNeighbourhoodGraph;
using tautges2011::Energy;

constexpr int kNeighbours = 4096, kPaths = 256;
constexpr std::size_t kReadings = 400;

// Of about as many frames as the paper's, 600,000.
constexpr const char* kSize = "680k";

std::shared_ptr<const MotionDatabase> database() { return recorded_database(kSize); }

retrieval::FeatureRows rows() { return retrieval::database_signals(*database(), paper_signals()); }

std::vector<std::vector<float>> readings() {
  const auto signals = paper_signals();
  std::vector<std::vector<float>> out;
  for (const auto& reading : recorded_performances()) {
    const Eigen::RowVectorXf row = retrieval::signal_row(reading, signals);
    out.emplace_back(row.begin(), row.end());
    if (out.size() == kReadings) break;
  }
  return out;
}

// The neighbours of one reading after another.
const std::vector<std::vector<Neighbour>>& columns() {
  static const auto found = [] {
    const KnnIndex index(rows());
    std::vector<std::vector<Neighbour>> out;
    for (const auto& reading : readings()) index.search(reading, kNeighbours, out.emplace_back());
    return out;
  }();
  return found;
}

void index_build(benchmark::State& state) {
  const auto searched = rows();
  for (auto _ : state) benchmark::DoNotOptimize(KnnIndex(searched));
}

void search(benchmark::State& state) {
  const KnnIndex index(rows());
  const auto asked = readings();
  std::vector<Neighbour> found;
  Latencies latencies;
  std::size_t t = 0;
  for (auto _ : state) {
    latencies.begin();
    index.search(asked[t++ % asked.size()], kNeighbours, found);
    latencies.end();
  }
  latencies.report(state);
}

OnlineLazyNeighbourhoodGraph new_graph() {
  return {retrieval::clips_of_frames(*database()), {1.0, 1.0, 20, true}};
}

void graph(benchmark::State& state) {
  columns();
  auto paths = new_graph();
  Latencies latencies;
  std::size_t t = 0;
  for (auto _ : state) {
    latencies.begin();
    paths.extend(columns()[t++ % columns().size()]);
    benchmark::DoNotOptimize(retrieval::best_paths(paths.paths(), kPaths));
    latencies.end();
  }
  latencies.report(state);
}

void graph_made_anew(benchmark::State& state) {
  const auto window = static_cast<std::size_t>(state.range(0));
  auto paths = new_graph();
  Latencies latencies;
  std::size_t t = window;
  for (auto _ : state) {
    latencies.begin();
    paths.reset();
    for (std::size_t i = t - window; i < t; ++i) paths.extend(columns()[i]);
    benchmark::DoNotOptimize(retrieval::best_paths(paths.paths(), kPaths));
    latencies.end();
    t = t + 1 < columns().size() ? t + 1 : window;
  }
  latencies.report(state);
}

// What there is to minimise in a frame, and where to begin.
struct Frame {
  const Skeleton& skeleton;
  const Eigen::VectorXd& weights;
  const tautges2011::EnergyTerms& terms;
  retrieval::PoseSubspace subspace;
  Eigen::VectorXd start;

  Energy energy() const { return Energy(skeleton, weights, terms); }
};

// The frames of a performance, each minimised by minimize(frame).
template <typename Minimize>
void minimisation(benchmark::State& state, const Minimize& minimize) {
  columns();
  auto paths = new_graph();
  const auto frames = database();
  Latencies latencies;
  std::size_t t = 0;
  for (auto _ : state) {
    paths.extend(columns()[t++ % columns().size()]);
    latencies.begin();
    auto best = retrieval::best_paths(paths.paths(), kPaths);
    auto weights = retrieval::linear_weights(best);
    const auto found = retrieval::gather(*frames, std::move(best), std::move(weights), nullptr);
    const auto subspace = retrieval::weighted_pca(found.angles, found.weights, 0.99);
    const auto terms = all_terms(*frames, found, tautges2011::Config());
    benchmark::DoNotOptimize(
        minimize(Frame{frames->skeleton(), found.weights, terms, subspace, found.angles.col(0)}));
    latencies.end();
  }
  latencies.report(state);
}

void by_majorising(benchmark::State& state) {
  minimisation(state, [](const Frame& frame) {
    return retrieval::minimize(frame.energy(), frame.subspace,
                               std::vector<retrieval::PoseVector>{frame.start}, 50)
        .value;
  });
}

void by_ceres_lbfgs(benchmark::State& state) {
  minimisation(state, [](const Frame& frame) {
    return ceres_minimum(frame.energy(), frame.subspace, frame.start);
  });
}

void by_ceres_lm(benchmark::State& state) {
  minimisation(state, [](const Frame& frame) {
    return least_squares_minimum(frame.skeleton, frame.weights, frame.terms.kernels, frame.subspace,
                                 frame.start);
  });
}

const bool is_registered = [] {
  const auto sizes = recorded_sizes();
  if (std::find(sizes.begin(), sizes.end(), kSize) == sizes.end()) return false;
  const auto add = [](const char* name, void (*run)(benchmark::State&), int iterations) {
    return benchmark::RegisterBenchmark(name, run)
        ->Unit(benchmark::kMillisecond)
        ->Iterations(iterations);
  };
  // On all processors.
  add("paper_frame/index_build", index_build, 3)->MeasureProcessCPUTime()->UseRealTime();
  add("paper_frame/search", search, 1000);
  add("paper_frame/graph", graph, 1000);
  for (const int window : {8, 16, 32, 64})
    add("paper_frame/graph_made_anew", graph_made_anew, 200)->Arg(window);
  add("paper_frame/minimisation", by_majorising, 1000);
  add("paper_frame/minimisation_by_ceres_lbfgs", by_ceres_lbfgs, 300);
  add("paper_frame/minimisation_by_ceres_lm", by_ceres_lm, 100);
  return true;
}();

}  // namespace
}  // namespace sparse_mocap::testing
