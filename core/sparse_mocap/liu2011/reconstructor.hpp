// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "sparse_mocap/liu2011/config.hpp"
#include "sparse_mocap/liu2011/heading_drift.hpp"
#include "sparse_mocap/liu2011/history_search.hpp"
#include "sparse_mocap/liu2011/motion_examples.hpp"
#include "sparse_mocap/liu2011/start.hpp"
#include "sparse_mocap/reconstruction/method_info.hpp"
#include "sparse_mocap/retrieval/signals.hpp"

namespace sparse_mocap::liu2011 {

// Realtime human motion control with a small number of inertial sensors: Liu, Wei, Chai, Ha, Rhee,
// I3D 2011.
class Reconstructor : public LiveMethod {
 public:
  // Throws ConfigError. Backward: readings come from the end of the performance.
  Reconstructor(const Config& config, const MethodContext& context,
                Direction direction = Direction::forward);

  const Skeleton& skeleton() const override { return examples_.body(); }
  double rate_hz() const override { return examples_.database().rate_hz(); }
  GaussianFilter reading_filter() const override { return {}; }
  double latency_s() const override { return 0.0; }
  double history_s() const override { return num_poses_ / rate_hz(); }

  std::optional<PoseEstimate> step(const Reading& reading) override;
  std::vector<PoseEstimate> flush() override;
  void reset() override;

 private:
  std::vector<Observation> observed_in(const HeadingFrame& frame, std::span<const BodyPose> recent,
                                       const Reading& reading) const;
  Estimate estimated(const HeadingFrame& frame, const Reading& reading);
  void restart_if_lost(const Reading& reading, HeadingFrame& frame, Estimate& estimate);
  void remember(BodyPose pose);
  PoseEstimate told(const Reading& reading, const Eigen::VectorXd& weights) const;

  std::vector<bool> is_searched_;
  MotionExamples examples_;
  Config config_;
  ControlWeights control_;
  int num_poses_;  // m
  std::vector<WornSensor> worn_;
  HistorySearch search_;
  Start start_;
  std::vector<retrieval::Signal> signals_;
  retrieval::FeatureRows signal_rows_;  // specific forces of the database
  std::vector<BodyPose> recent_;        // the last m poses, the newest first, in the world
  double yaw_rad_ = 0.0;                // of the newest
  std::vector<retrieval::Neighbour> nearest_;
  Eigen::VectorXd nearest_weights_;
  HeadingDrift drift_;
  Eigen::Matrix3Xd accelerations_;  // of the newest, in the world; empty before there is one
  bool is_off_track_ = false;
  int num_off_track_ = 0;  // frames
};

}  // namespace sparse_mocap::liu2011
