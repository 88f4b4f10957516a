// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "sparse_mocap/path_regression/frame_solver.hpp"
#include "sparse_mocap/path_regression/oriented_limbs.hpp"
#include "sparse_mocap/path_regression/take_fit.hpp"
#include "sparse_mocap/retrieval/olng.hpp"

namespace sparse_mocap::path_regression {

// Live quality: each pose follows its reading after the few that retrieval looks ahead.
class LiveReconstructor : public LiveMethod {
 public:
  // Throws ConfigError.
  LiveReconstructor(const Config& config, const MethodContext& context);

  const Skeleton& skeleton() const override { return solver_.database().skeleton(); }
  double rate_hz() const override { return solver_.database().rate_hz(); }
  double latency_s() const override { return solver_.look_ahead() / rate_hz(); }
  double history_s() const override { return solver_.reach_back() / rate_hz(); }

  std::optional<PoseEstimate> step(const Reading& reading) override;
  bool step_into(const Reading& reading, PoseEstimate& estimate) override;
  std::vector<PoseEstimate> flush() override;
  void reset() override;

 private:
  void solve_next(PoseEstimate& estimate);
  void add_frame();

  FrameSolver solver_;
  TurningOf turning_;
  TakeFit fit_;
  // The last frames, as many as a fit looks back, and the targets they had.
  std::vector<FittedFrame> frames_;
  std::vector<FrameTarget> targets_;
  retrieval::OnlineLazyNeighbourhoodGraph graph_;
  retrieval::FeatureRows recent_;  // signals of the last readings, oldest first
  Eigen::Index num_recent_ = 0;    // of them known
  std::vector<Reading> waiting_;   // for their poses: the first num_waiting_
  std::size_t num_waiting_ = 0;
  std::vector<retrieval::Neighbour> neighbours_;
  RetrievedFrame retrieved_;
};

}  // namespace sparse_mocap::path_regression
