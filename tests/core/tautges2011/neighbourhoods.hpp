// SPDX-License-Identifier: GPL-3.0-or-later
//
// Neighbourhoods as retrieval gives them, and the energies that they make.
#pragma once

#include <algorithm>
#include <vector>

#include "sparse_mocap/retrieval/neighbourhood.hpp"
#include "sparse_mocap/retrieval/signals.hpp"
#include "sparse_mocap/tautges2011/energy_model.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::testing {

inline std::vector<retrieval::Signal> paper_signals() {
  return retrieval::compared_signals(paper_sensors(), false);
}

// Every quantity drawn at random, so that no two of them can be confused.
inline retrieval::Neighbourhood random_neighbourhood(Random& random, Eigen::Index paths) {
  retrieval::Neighbourhood out;
  out.weights = random.column(paths, 1.0).array().abs() + 0.01;
  out.weights /= out.weights.sum();
  out.angles = random.matrix(kNumStandardAngles, paths, 1.0);
  out.positions = random.matrix(3 * kNumStandardJoints, paths, 1.0);
  return out;
}

inline tautges2011::PathDerivatives random_derivatives(Random& random, Eigen::Index paths) {
  return {random.matrix(3 * kNumStandardJoints, paths, 10.0),
          random.matrix(3 * kNumStandardJoints, paths, 200.0),
          random.matrix(3 * kNumStandardJoints, paths, 10.0)};
}

// What a reconstruction would meet at some frame: paths that end near there and in other clips.
inline retrieval::Neighbourhood retrieved_neighbourhood(const MotionDatabase& database,
                                                        Random& random, int num_paths) {
  const int num_clips = static_cast<int>(database.clips().size());
  std::vector<retrieval::Path> paths;
  std::vector<int> clips(3);
  for (auto& clip : clips) clip = random.below(num_clips);
  for (int i = 0; i < num_paths; ++i) {
    const Clip& clip =
        database
            .clips()[static_cast<std::size_t>(clips[static_cast<std::size_t>(random.below(3))])];
    const int stretch = std::min(12, clip.num_frames());
    const int begin = clip.begin + (clip.num_frames() - stretch) / 2;
    paths.push_back({begin + random.below(stretch), random.in(0.0, 10.0), 1, -1});
  }
  paths = retrieval::best_paths(paths, num_paths);
  auto weights = retrieval::linear_weights(paths);
  return retrieval::gather(database, std::move(paths), std::move(weights), nullptr);
}

// All terms as a reconstruction forms them, the last two poses being frames nearby.
inline tautges2011::EnergyTerms all_terms(const MotionDatabase& database,
                                          const retrieval::Neighbourhood& found,
                                          const tautges2011::Config& config) {
  const int frame = found.paths.back().frame;
  const Clip& clip = retrieval::clip_at(database, frame);
  const auto row = [&](int n) -> Eigen::VectorXd {
    return database.positions().row(std::max(n, clip.begin)).transpose().cast<double>();
  };
  const std::optional<tautges2011::Past> past{
      {found.angles.col(0), row(frame - 1), row(frame - 2), Eigen::Matrix3Xd::Constant(3, 4, 2.0)}};
  const auto derivatives = tautges2011::path_derivatives(database, found.paths);
  const auto signals = paper_signals();
  tautges2011::EnergyTerms terms;
  tautges2011::make_energy_model(config)->put_terms(
      {found, derivatives, past, signals, database.frame_time_s()}, terms);
  return terms;
}

}  // namespace sparse_mocap::testing
