// SPDX-License-Identifier: GPL-3.0-or-later
//
// Neighbourhoods as retrieval gives them, and the energies that they make.
#pragma once

#include <algorithm>
#include <vector>

#include "sparse_mocap/tautges2011/control.hpp"
#include "sparse_mocap/tautges2011/prior.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::testing {

// Every quantity drawn at random, so that no two of them can be confused.
inline tautges2011::Neighbourhood random_neighbourhood(Random& random, Eigen::Index paths) {
  tautges2011::Neighbourhood out;
  out.weights = random.column(paths, 1.0).array().abs() + 0.01;
  out.weights /= out.weights.sum();
  out.angles = random.matrix(kNumStandardAngles, paths, 1.0);
  for (auto* positions : {&out.positions, &out.steps})
    *positions = random.matrix(3 * kNumStandardJoints, paths, 1.0);
  for (auto* rates : {&out.velocities, &out.velocities_before})
    *rates = random.matrix(3 * kNumStandardJoints, paths, 10.0);
  out.accelerations = random.matrix(3 * kNumStandardJoints, paths, 200.0);
  return out;
}

// What a reconstruction would meet at some frame: paths that end near there and in other clips.
inline tautges2011::Neighbourhood retrieved_neighbourhood(const MotionDatabase& database,
                                                          Random& random, int num_paths) {
  const int num_clips = static_cast<int>(database.clips().size());
  std::vector<tautges2011::Path> paths;
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
  paths = tautges2011::best_paths(paths, num_paths);
  auto weights = tautges2011::path_weights(paths, tautges2011::WeightRule::linear, 1.0);
  return tautges2011::gather(database, {}, std::move(paths), std::move(weights), nullptr);
}

// All four terms as a reconstruction forms them, the last two poses being frames nearby.
inline std::vector<tautges2011::KernelTerm> all_terms(const MotionDatabase& database,
                                                      const tautges2011::Neighbourhood& found,
                                                      const tautges2011::Config& config) {
  const int frame = found.paths.back().frame;
  const Clip& clip = database.clips()[static_cast<std::size_t>(database.clip_index(frame))];
  const Eigen::VectorXd now =
      database.positions().row(std::max(frame - 1, clip.begin)).transpose().cast<double>();
  const Eigen::VectorXd before =
      database.positions().row(std::max(frame - 2, clip.begin)).transpose().cast<double>();
  const Eigen::Matrix3Xd accelerations = Eigen::Matrix3Xd::Constant(3, 4, 2.0);
  const double dt = database.frame_time_s();
  return {tautges2011::pose_prior(found, config), tautges2011::motion_prior(found, config, now, dt),
          tautges2011::smoothness_prior(found, config, now, before, dt),
          tautges2011::control_term(found, config, now, accelerations, paper_sensors(), dt)};
}

}  // namespace sparse_mocap::testing
