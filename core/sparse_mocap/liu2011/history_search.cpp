// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/history_search.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "sparse_mocap/liu2011/local_dynamic_model.hpp"

namespace sparse_mocap::liu2011 {
namespace {

constexpr int kMostSampledFrames = 4000;

}  // namespace

HistorySearch::HistorySearch(const MotionExamples& examples, std::vector<WornSensor> worn,
                             const SearchWeights& weights, const std::vector<bool>& is_searched)
    : examples_(examples),
      worn_(std::move(worn)),
      weights_(weights),
      reference_(examples.reference(examples.mean())) {
  lay_out_sensors();
  find_axes(is_searched);
  retrieval::FeatureRows rows =
      retrieval::FeatureRows::Zero(examples.num_frames(), axes_.cols() + num_sensor_columns_);
  for (const Clip& clip : examples.database().clips())
    if (is_searched[static_cast<std::size_t>(clip.begin)]) put_clip(clip, rows);
  index_.emplace(std::move(rows), is_searched);
}

// The rows of a clip's frames. What does not depend on where a pose is placed is found once, though
// each pose is in several histories.
void HistorySearch::put_clip(const Clip& clip, retrieval::FeatureRows& rows) const {
  const Eigen::Index num_axes = axes_.cols(), num_root = examples_.num_root_freedoms();
  const Eigen::Index num_joints = num_freedoms(examples_.body()) - num_root;
  Eigen::MatrixXd joints(num_joints, clip.num_frames());
  for (int frame = clip.begin; frame < clip.end; ++frame)
    examples_.put_joints(frame, reference_, joints.col(frame - clip.begin).data());
  Eigen::VectorXd vector(mean_.size());
  for (int frame = clip.begin; frame < clip.end; ++frame) {
    Eigen::Index begin = 0;
    for (const auto& place : examples_.history(frame, weights_.num_poses)) {
      examples_.put_root(place, reference_, vector.data() + begin);
      vector.segment(begin + num_root, num_joints) = joints.col(place.frame - clip.begin);
      begin += num_root + num_joints;
    }
    rows.row(frame).head(num_axes) =
        (axes_.transpose() * (vector - mean_)).transpose().cast<float>();
    if (num_sensor_columns_ > 0)
      put_sensors(sensors_of(examples_.body(), worn_, examples_.next(frame)),
                  rows.row(frame).data() + num_axes);
  }
}

void HistorySearch::search(std::span<const BodyPose> history, std::span<const Observation> observed,
                           int k, std::vector<retrieval::Neighbour>& out) const {
  const Eigen::Index num_axes = axes_.cols();
  Eigen::VectorXf query(num_axes + num_sensor_columns_);
  const Eigen::VectorXd vector = pose_vectors(examples_.body(), examples_.mean(), history);
  query.head(num_axes) = (axes_.transpose() * (vector - mean_)).cast<float>();
  if (num_sensor_columns_ > 0) put_sensors(observed, query.data() + num_axes);
  index_->search({query.data(), static_cast<std::size_t>(query.size())}, k, out);
}

// The poses before a frame one after another, about the database's mean pose.
Eigen::VectorXd HistorySearch::example_vector(int frame) const {
  return examples_.vectors(examples_.history(frame, weights_.num_poses), reference_);
}

void HistorySearch::lay_out_sensors() {
  for (const WornSensor& worn : worn_) {
    SensorColumns columns;
    if (weights_.position_per_m > 0.0 && worn.channels.has(Channel::position)) {
      columns.position = num_sensor_columns_;
      num_sensor_columns_ += 3;
    }
    if (weights_.orientation > 0.0 && worn.channels.has(Channel::orientation)) {
      columns.axes = num_sensor_columns_;
      num_sensor_columns_ += 6;
    }
    sensor_columns_.push_back(columns);
  }
}

// NaN for what a sensor does not say.
void HistorySearch::put_sensors(std::span<const Observation> observed, float* out) const {
  Eigen::Map<Eigen::VectorXf> all(out, num_sensor_columns_);
  all.setConstant(std::numeric_limits<float>::quiet_NaN());
  for (const Observation& one : observed) {
    const auto& columns = sensor_columns_[static_cast<std::size_t>(one.worn.sensor)];
    const Mat3& R = one.measured.R_frame_sensor;
    if (one.has_position && columns.position >= 0)
      all.segment<3>(columns.position) =
          (weights_.position_per_m * one.measured.position).cast<float>();
    if (!one.has_orientation || columns.axes < 0) continue;
    all.segment<3>(columns.axes) = (weights_.orientation * R.col(0)).cast<float>();
    all.segment<3>(columns.axes + 3) = (weights_.orientation * R.col(2)).cast<float>();
  }
}

void HistorySearch::find_axes(const std::vector<bool>& is_searched) {
  const auto count = std::count(is_searched.begin(), is_searched.end(), true);
  const auto stride = std::max<std::ptrdiff_t>(1, count / kMostSampledFrames);
  std::vector<Eigen::VectorXd> sampled;
  std::ptrdiff_t seen = 0;
  for (int frame = 0; frame < examples_.num_frames(); ++frame)
    if (is_searched[static_cast<std::size_t>(frame)] && seen++ % stride == 0)
      sampled.push_back(example_vector(frame));
  mean_ = Eigen::VectorXd::Zero(sampled.front().size());
  for (const auto& vector : sampled) mean_ += vector / static_cast<double>(sampled.size());
  Eigen::MatrixXd centred(mean_.size(), static_cast<Eigen::Index>(sampled.size()));
  for (std::size_t i = 0; i < sampled.size(); ++i)
    centred.col(static_cast<Eigen::Index>(i)) = sampled[i] - mean_;
  axes_ = leading_pairs(centred, kVariance).vectors;
}

}  // namespace sparse_mocap::liu2011
