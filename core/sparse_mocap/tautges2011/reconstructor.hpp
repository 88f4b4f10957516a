// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "sparse_mocap/reconstruction/method_info.hpp"
#include "sparse_mocap/reconstruction/pose_follower.hpp"
#include "sparse_mocap/retrieval/knn_index.hpp"
#include "sparse_mocap/retrieval/olng.hpp"
#include "sparse_mocap/retrieval/pose_minimizer.hpp"
#include "sparse_mocap/retrieval/root_motion.hpp"
#include "sparse_mocap/retrieval/signals.hpp"
#include "sparse_mocap/tautges2011/config.hpp"
#include "sparse_mocap/tautges2011/energy_model.hpp"

namespace sparse_mocap::tautges2011 {

// Motion reconstruction using sparse accelerometer data: Tautges, Zinke, Krueger, Baumann, Weber,
// Helten, Mueller, Seidel, Eberhardt, ACM Trans. Graph. 30 (2011).
//
// The paper and nothing else, but for Config::scales_with_database and Config::follow_s.
class Reconstructor : public LiveMethod {
 public:
  // Throws ConfigError.
  Reconstructor(const Config& config, const MethodContext& context);

  const Skeleton& skeleton() const override { return database_->skeleton(); }
  double rate_hz() const override { return database_->rate_hz(); }
  double latency_s() const override { return 0.0; }
  double history_s() const override { return config_.window_readings / rate_hz(); }

  std::optional<PoseEstimate> step(const Reading& reading) override;
  bool step_into(const Reading& reading, PoseEstimate& estimate) override;
  std::vector<PoseEstimate> flush() override;
  void reset() override;

 private:
  void put_energy();
  retrieval::Minimum best_pose() const;
  void remember(const Reading& reading, const retrieval::PoseVector& angles);
  void put_pose(double time_s, const retrieval::RootRates& rates, PoseEstimate& estimate);

  std::shared_ptr<const MotionDatabase> database_;
  std::vector<retrieval::Signal> signals_;
  Eigen::Index num_sensors_ = 0;
  retrieval::FeatureRows signal_rows_;  // alpha_n of the database, section 3
  retrieval::KnnIndex index_;
  Config config_;
  std::unique_ptr<const EnergyModel> energy_model_;
  retrieval::OnlineLazyNeighbourhoodGraph graph_;
  retrieval::RootTracker root_;
  Eigen::RowVectorXf alpha_;                   // of the reading
  std::vector<retrieval::Neighbour> nearest_;  // S^(t+1)
  retrieval::Neighbourhood neighbours_;
  PathDerivatives derivatives_;
  Energy energy_;
  retrieval::PoseSubspace subspace_;
  JointTransforms pose_;
  std::optional<Past> past_;
  PoseFollower follower_;
};

}  // namespace sparse_mocap::tautges2011
