// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "sparse_mocap/path_regression/frame_solver.hpp"
#include "sparse_mocap/path_regression/sensor_headings.hpp"
#include "sparse_mocap/path_regression/sensor_turning.hpp"
#include "sparse_mocap/path_regression/take_fit.hpp"
#include "sparse_mocap/retrieval/olng.hpp"

namespace sparse_mocap::path_regression {

// Live quality: each pose waits for the few readings that retrieval looks ahead, and for as many
// more as lag_s allows; while it waits it is fitted anew with each pose after it.
class LiveReconstructor : public LiveMethod {
 public:
  // Throws ConfigError.
  LiveReconstructor(const Config& config, const MethodContext& context);

  const Skeleton& skeleton() const override { return solver_.database().skeleton(); }
  double rate_hz() const override { return solver_.database().rate_hz(); }
  double latency_s() const override { return num_late() / rate_hz(); }
  double history_s() const override { return solver_.reach_back() / rate_hz(); }

  std::optional<PoseEstimate> step(const Reading& reading) override;
  bool step_into(const Reading& reading, PoseEstimate& estimate) override;
  std::vector<PoseEstimate> flush() override;
  void reset() override;

 private:
  // What an estimate has beside its fitted pose.
  struct Fitted {
    double time_s = 0.0;
    Diagnostics diagnostics;
    ExtremityVote extremities;
  };

  double num_late() const { return solver_.look_ahead() + static_cast<double>(num_held_); }
  void put_signals_of(const Reading& reading);
  void solve_next();
  void add_frame();
  void put_fitted(std::size_t at, PoseEstimate& estimate);

  FrameSolver solver_;
  TurningOf turning_;
  SensorHeadings headings_;
  TakeFit fit_;
  // The last frames: those held back, and before them as many as a fit looks back.
  std::vector<FittedFrame> frames_;
  std::vector<FrameTarget> targets_;
  std::vector<Fitted> fitted_;
  retrieval::OnlineLazyNeighbourhoodGraph graph_;
  retrieval::FeatureRows recent_;  // signals of the last readings, oldest first
  Eigen::Index num_recent_ = 0;    // of them known
  std::vector<Reading> waiting_;   // for their poses: the first num_waiting_
  std::size_t num_waiting_ = 0;
  std::vector<retrieval::Neighbour> neighbours_;
  RetrievedFrame retrieved_;
  std::vector<HeadingHint> heading_hints_;
  Reading turned_;
  std::size_t num_held_;
};

}  // namespace sparse_mocap::path_regression
