// SPDX-License-Identifier: GPL-3.0-or-later
//
// Synthesis, section 5: the energy of 256 paths, its gradient and its minimum.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "ceres_least_squares.hpp"
#include "sparse_mocap/retrieval/pose_minimizer.hpp"
#include "support/synthetic.hpp"
#include "tautges2011/ceres_minimizer.hpp"
#include "tautges2011/neighbourhoods.hpp"

namespace sparse_mocap {
namespace {

using retrieval::Neighbourhood;
using retrieval::PoseSubspace;
using tautges2011::Config;
using tautges2011::Energy;

// Energies as a reconstruction by the paper's method meets them, with where each begins.
struct Problem {
  tautges2011::EnergyTerms terms;
  Eigen::VectorXd weights;
  Energy energy;
  PoseSubspace subspace;
  Eigen::VectorXd start;
};

const MotionDatabase& swaying_database() {
  static const auto made = [] {
    std::vector<Motion> motions;
    for (unsigned seed = 0; seed < 20; ++seed)
      motions.push_back(testing::swaying_motion(testing::template_skeleton(), seed, 400, 50.0));
    return testing::database_of(motions);
  }();
  return *made;
}

const std::vector<Problem>& problems() {
  static const auto made = [] {
    const MotionDatabase& database = swaying_database();
    testing::Random random(1);
    std::vector<Problem> out;
    for (int i = 0; i < 32; ++i) {
      const Neighbourhood found = testing::retrieved_neighbourhood(database, random, 256);
      const PoseSubspace subspace = retrieval::weighted_pca(found.angles, found.weights, 0.99);
      const Eigen::VectorXd start = 0.5 * (found.angles.col(0) + subspace.mean);
      const auto terms = testing::all_terms(database, found, Config());
      out.push_back({terms, found.weights, Energy(database.skeleton(), found.weights, terms),
                     subspace, start});
    }
    return out;
  }();
  return made;
}

void energy_value_and_gradient(benchmark::State& state) {
  Eigen::VectorXd gradient;
  std::size_t i = 0;
  for (auto _ : state) {
    const Problem& problem = problems()[i++ % problems().size()];
    benchmark::DoNotOptimize(problem.energy.value_and_gradient(problem.start, gradient));
  }
}
BENCHMARK(energy_value_and_gradient)->Unit(benchmark::kMicrosecond);

void minimize_by_majorising(benchmark::State& state) {
  double energy = 0.0, iterations = 0.0;
  std::size_t i = 0;
  for (auto _ : state) {
    const Problem& problem = problems()[i++ % problems().size()];
    const auto minimum = retrieval::minimize(problem.energy, problem.subspace,
                                             std::vector<retrieval::PoseVector>{problem.start}, 50);
    energy += minimum.value;
    iterations += minimum.iterations;
  }
  state.counters["energy"] = benchmark::Counter(energy, benchmark::Counter::kAvgIterations);
  state.counters["steps"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
}
BENCHMARK(minimize_by_majorising)->Unit(benchmark::kMillisecond);

// The baselines: Ceres' L-BFGS with the same gradient, and its Levenberg-Marquardt.
void minimize_by_ceres(benchmark::State& state) {
  double energy = 0.0;
  std::size_t i = 0;
  for (auto _ : state) {
    const Problem& problem = problems()[i++ % problems().size()];
    energy += testing::ceres_minimum(problem.energy, problem.subspace, problem.start);
  }
  state.counters["energy"] = benchmark::Counter(energy, benchmark::Counter::kAvgIterations);
}
BENCHMARK(minimize_by_ceres)->Unit(benchmark::kMillisecond);

void minimize_by_ceres_lm(benchmark::State& state) {
  double energy = 0.0;
  std::size_t i = 0;
  for (auto _ : state) {
    const Problem& problem = problems()[i++ % problems().size()];
    energy +=
        testing::least_squares_minimum(swaying_database().skeleton(), problem.weights,
                                       problem.terms.kernels, problem.subspace, problem.start);
  }
  state.counters["energy"] = benchmark::Counter(energy, benchmark::Counter::kAvgIterations);
}
BENCHMARK(minimize_by_ceres_lm)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sparse_mocap
