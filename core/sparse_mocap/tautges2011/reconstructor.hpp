// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "sparse_mocap/database/index.hpp"
#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/reconstruction/method.hpp"
#include "sparse_mocap/tautges2011/config.hpp"
#include "sparse_mocap/tautges2011/neighbourhood.hpp"
#include "sparse_mocap/tautges2011/olng.hpp"
#include "sparse_mocap/tautges2011/root_motion.hpp"

namespace sparse_mocap::tautges2011 {

// Motion reconstruction using sparse accelerometer data: Tautges, Zinke, Krueger, Baumann, Weber,
// Helten, Mueller, Seidel, Eberhardt, ACM Trans. Graph. 30 (2011).
class Reconstructor : public Method {
 public:
  // excluded_clips (indices into database.clips()) are never retrieved. Throws ConfigError.
  Reconstructor(std::shared_ptr<const MotionDatabase> database, std::vector<WornSensor> sensors,
                const Config& config, const std::vector<int>& excluded_clips = {});

  std::optional<PoseEstimate> step(const Reading& reading) override;
  std::vector<PoseEstimate> flush() override;
  int latency_frames() const override { return look_ahead_; }
  void reset() override;
  std::vector<PoseEstimate> solve(const std::vector<Reading>& take,
                                  const Progress& progress) override;

 private:
  // One frame of the take: its rows among the known ones.
  struct Window {
    const FeatureRows& readings;
    Eigen::Index begin, end, at;
  };

  Reading reading_at(const Window& window) const;
  void search(const Window& window, std::vector<Neighbour>& out) const;
  PoseEstimate estimate_online(const Window& window);
  std::vector<PoseEstimate> solve_both_ways(const std::vector<Reading>& take,
                                            const Progress& progress);
  PoseEstimate synthesize(std::vector<Path> paths, Eigen::VectorXd weights, const Window& window);
  void correct_poses(Neighbourhood& neighbours, const Window& window) const;
  Eigen::VectorXd minimize_energy(const Neighbourhood& neighbours, const Reading& reading) const;
  PoseEstimate remember(const Neighbourhood& neighbours, const Eigen::VectorXd& angles,
                        const Window& window);
  void describe_retrieval(const Neighbourhood& neighbours, const Window& window,
                          PoseEstimate& estimate) const;

  std::shared_ptr<const MotionDatabase> database_;
  std::vector<WornSensor> sensors_;
  Config config_;
  std::vector<int> excluded_clips_;
  std::vector<float> column_weights_;
  int look_ahead_ = 0;
  int reach_back_ = 0;
  FeatureRows readings_;  // of the database, 3 x sensors columns
  KnnIndex index_;
  std::vector<std::int32_t> clip_of_frame_;
  OnlineLazyNeighbourhoodGraph graph_;
  RootTracker root_;

  FeatureRows recent_;           // the last readings, oldest first
  Eigen::Index num_recent_ = 0;  // of them known
  int num_owed_ = 0;             // readings taken and not yet answered
  std::vector<Neighbour> neighbours_;

  // The last two poses of the performance: x^t, x^(t-1), q^t and what the sensors did at t.
  struct Past {
    Eigen::VectorXd angles, positions, positions_before;
    Eigen::Matrix3Xd accelerations;
  };
  std::optional<Past> past_;
};

}  // namespace sparse_mocap::tautges2011
