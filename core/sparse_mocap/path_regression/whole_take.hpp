// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "sparse_mocap/path_regression/frame_solver.hpp"
#include "sparse_mocap/path_regression/oriented_limbs.hpp"

namespace sparse_mocap::path_regression {

// Best quality: paths that know what comes after a frame too, and a smooth take. Uses all
// processors, or as many threads as the context says; the result does not depend on them.
class WholeTakeReconstructor : public WholeTakeMethod {
 public:
  // Throws ConfigError.
  WholeTakeReconstructor(const Config& config, const MethodContext& context)
      : solver_(config, context), turning_(context.sensors), num_threads_(context.num_threads) {}

  const Skeleton& skeleton() const override { return solver_.database().skeleton(); }
  double rate_hz() const override { return solver_.database().rate_hz(); }

  std::vector<PoseEstimate> solve(const std::vector<Reading>& take,
                                  const Progress& progress) override;

 private:
  std::vector<PoseEstimate> fitted(const std::vector<Reading>& take,
                                   std::vector<RetrievedFrame> retrieved,
                                   const Progress& progress) const;

  template <typename Result, typename Reached, typename Of>
  std::vector<Result> in_parallel(std::size_t count, const Reached& reached, const Of& of) const;

  FrameSolver solver_;
  TurningOf turning_;
  int num_threads_;
};

}  // namespace sparse_mocap::path_regression
