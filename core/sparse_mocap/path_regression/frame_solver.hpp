// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sparse_mocap/path_regression/config.hpp"
#include "sparse_mocap/path_regression/frame_target.hpp"
#include "sparse_mocap/path_regression/sensor_headings.hpp"
#include "sparse_mocap/reconstruction/method_info.hpp"
#include "sparse_mocap/retrieval/features.hpp"
#include "sparse_mocap/retrieval/knn_index.hpp"
#include "sparse_mocap/retrieval/neighbourhood.hpp"
#include "sparse_mocap/retrieval/signals.hpp"

namespace sparse_mocap::path_regression {

// A frame as far as it is known from the database.
struct RetrievedFrame {
  FrameTarget target;
  Diagnostics diagnostics;
  ExtremityVote extremities;
  // R_heading_sensor of the retrieved poses' mean, one a sensor; see put_posed_sensors().
  std::vector<Mat3> posed_sensors;
};

// What live and whole-take reconstruction do alike with a frame: search the database, and gather
// what the paths that lead there say of the pose.
class FrameSolver {
 public:
  // Throws ConfigError.
  FrameSolver(const Config& config, const MethodContext& context);

  const MotionDatabase& database() const { return *database_; }
  const Config& config() const { return config_; }
  const std::vector<retrieval::Signal>& signals() const { return signals_; }
  Eigen::Index num_sensors() const { return num_sensors_; }
  int look_ahead() const;  // frames
  int reach_back() const;  // frames
  // What is to be known of the headings of its sensors' orientations.
  const HeadingSettings& headings() const { return headings_; }
  bool has_headings() const;  // any
  bool has_own_headings() const;

  // The database frames whose features are nearest to those of the window's row.
  void search(const retrieval::SignalWindow& window, std::vector<retrieval::Neighbour>& out) const;
  // What paths, all of which end in neighbours of the window's row, and the reading ask for, in the
  // memory of an earlier frame.
  void retrieve(const std::vector<retrieval::Path>& paths, const retrieval::SignalWindow& window,
                const Reading& reading, RetrievedFrame& frame) const;
  // The poses that paths lead to: one column a path, 3 a joint, m, heading frame.
  Eigen::MatrixXf positions(const std::vector<retrieval::Path>& paths) const;

  // Of that only where the poses have the sensors.
  void retrieve_posed_sensors(const std::vector<retrieval::Path>& paths,
                              const retrieval::SignalWindow& window,
                              std::vector<Mat3>& posed_sensors) const;

 private:
  void put_weights(const std::vector<retrieval::Path>& paths, const retrieval::SignalWindow& window,
                   retrieval::WeightedPaths& weighted, Eigen::VectorXd& weights) const;
  void put_regressed(const retrieval::WeightedPaths& weighted,
                     const retrieval::SignalWindow& window, Eigen::VectorXd& weights) const;
  retrieval::StandingFeet feet(const retrieval::WeightedPaths& weighted,
                               const retrieval::SignalWindow& window) const;
  void put_points(const std::vector<retrieval::Path>& paths, const Eigen::VectorXd& weights,
                  const retrieval::SignalWindow& window, RetrievedFrame& frame) const;
  void put_mean_points(const std::vector<retrieval::Path>& paths, const Eigen::VectorXd& weights,
                       Eigen::VectorXd& now, Eigen::VectorXd& before) const;

  std::uint64_t number_;  // no other one has the same
  std::shared_ptr<const MotionDatabase> database_;
  std::vector<retrieval::Signal> signals_;
  Eigen::Index num_sensors_ = 0;
  std::vector<float> column_weights_;
  retrieval::FeatureLayout features_, regression_features_;
  retrieval::FeatureRows signal_rows_;  // of the database
  retrieval::KnnIndex index_;
  std::vector<float> distance_factors_;  // of the clips; empty: all alike
  Config config_;
  HeadingSettings headings_;
  retrieval::StandingHeights standing_heights_;
};

}  // namespace sparse_mocap::path_regression
