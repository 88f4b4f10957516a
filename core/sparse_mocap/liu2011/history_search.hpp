// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sparse_mocap/liu2011/motion_examples.hpp"
#include "sparse_mocap/liu2011/worn_sensors.hpp"
#include "sparse_mocap/retrieval/knn_index.hpp"

namespace sparse_mocap::liu2011 {

// What histories are compared by.
struct SearchWeights {
  int num_poses = 3;  // m
  // What a sensor's distance in the pose that follows counts beside them; 0: it does not. A unit of
  // distance is a radian of one joint. The paper compares histories alone.
  double position_per_m = 0.0;
  double orientation = 0.0;
};

// The K closest motion examples of Liu et al. 2011, section 5: frames of the database whose last m
// poses are nearest to the last m that were synthesised and, if wanted, whose own pose puts the
// sensors nearest to where they are measured.
//
// Histories are compared on the principal axes that hold kVariance of their variance; the search
// there is exact. In place of the paper's graph of neighbours a sample of the rows says how far to
// look: the frames that follow the neighbours of the frame before say it less tightly.
class HistorySearch {
 public:
  static constexpr double kVariance = 0.995;

  // is_searched: one flag a frame, the same for all of a clip.
  HistorySearch(const MotionExamples& examples, std::vector<WornSensor> worn,
                const SearchWeights& weights, const std::vector<bool>& is_searched);

  // history: the last m poses, the newest first, and what the sensors say, both in the newest's
  // heading frame. Neighbours' rows are frames of the database: the ones that follow the histories.
  void search(std::span<const BodyPose> history, std::span<const Observation> observed, int k,
              std::vector<retrieval::Neighbour>& out) const;

  int num_rows() const { return index_->num_rows(); }

 private:
  Eigen::VectorXd example_vector(int frame) const;
  void put_clip(const Clip& clip, retrieval::FeatureRows& rows) const;
  void put_sensors(std::span<const Observation> observed, float* out) const;
  void find_axes(const std::vector<bool>& is_searched);
  void lay_out_sensors();

  const MotionExamples& examples_;
  // Where in a row a sensor's position (3) and x and z axes (6) are, from the first sensor's on;
  // negative: not compared.
  struct SensorColumns {
    Eigen::Index position = -1, axes = -1;
  };

  std::vector<WornSensor> worn_;
  SearchWeights weights_;
  std::vector<SensorColumns> sensor_columns_;
  Eigen::Index num_sensor_columns_ = 0;
  MotionExamples::Reference reference_;  // the database's mean pose
  Eigen::VectorXd mean_;
  Eigen::MatrixXd axes_;  // of the histories' vectors
  std::optional<retrieval::KnnIndex> index_;
};

}  // namespace sparse_mocap::liu2011
