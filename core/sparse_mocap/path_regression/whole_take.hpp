// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "sparse_mocap/path_regression/frame_solver.hpp"
#include "sparse_mocap/path_regression/pose_modes.hpp"
#include "sparse_mocap/path_regression/sensor_turning.hpp"

namespace sparse_mocap::path_regression {

// Best quality: paths that know what comes after a frame too, and a smooth take. Uses all
// processors, or as many threads as the context says; the result does not depend on them.
//
// Alternatives are asked for by the option of that name. Where retrieved poses that are unlike the
// take's own weigh enough for long enough, such a part is retrieved from them alone and fitted anew
// together with what is around it. Elsewhere an alternative has the take's own poses.
class WholeTakeReconstructor : public WholeTakeMethod {
 public:
  // Throws ConfigError.
  WholeTakeReconstructor(const Config& config, const MethodContext& context)
      : solver_(config, context),
        turning_(context.sensors, config.use_own_headings),
        num_threads_(context.num_threads) {}

  const Skeleton& skeleton() const override { return solver_.database().skeleton(); }
  double rate_hz() const override { return solver_.database().rate_hz(); }

  std::vector<PoseEstimate> solve(const std::vector<Reading>& take,
                                  const Progress& progress) override;
  std::vector<Alternative> alternatives() const override { return alternatives_; }

 private:
  struct SearchedTake;
  struct RetrievedTake;
  struct Part;
  struct FittedPart;
  using Known = std::vector<std::vector<Eigen::VectorXf>>;  // poses of each frame, see modes_of

  std::vector<Reading> turned(const std::vector<Reading>& measured);
  std::vector<PoseEstimate> solved(std::vector<Reading> readings, const Progress& progress);
  SearchedTake searched(std::vector<Reading> take, const Progress& progress) const;
  RetrievedTake retrieved(const SearchedTake& take, const Progress& progress) const;
  void fit(std::vector<FittedFrame>& frames, const RetrievedTake& retrieved,
           const Progress& progress) const;
  std::vector<PoseEstimate> estimates(const SearchedTake& take, RetrievedTake retrieved,
                                      const std::vector<FittedFrame>& frames) const;

  void find_alternatives(const SearchedTake& take, const RetrievedTake& first,
                         const std::vector<FittedFrame>& frames, const Progress& progress);
  std::vector<Part> parts_elsewhere(const SearchedTake& take, const Known& known,
                                    const Progress& progress) const;
  RetrievedTake retrieved_part(const SearchedTake& take, const Known& known,
                               const Part& part) const;
  FittedPart fitted_part(const Part& part, const RetrievedTake& retrieved,
                         const RetrievedTake& first, const std::vector<FittedFrame>& frames,
                         const Progress& progress) const;
  bool moves_as_asked(const std::vector<FittedFrame>& frames,
                      const std::vector<FrameTarget>& targets) const;
  double distance_m(const Part& part, const FittedPart& fitted, const Known& known) const;
  Eigen::VectorXf positions_of(const FittedFrame& frame) const;

  FrameSolver solver_;
  TurningOf turning_;
  int num_threads_;
  std::vector<Alternative> alternatives_;
};

}  // namespace sparse_mocap::path_regression
