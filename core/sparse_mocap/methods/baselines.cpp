// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/methods/baselines.hpp"

#include <algorithm>
#include <ctime>
#include <deque>

#include "sparse_mocap/retrieval/features.hpp"
#include "sparse_mocap/retrieval/knn_index.hpp"
#include "sparse_mocap/retrieval/neighbourhood.hpp"
#include "sparse_mocap/retrieval/olng.hpp"
#include "sparse_mocap/retrieval/signals.hpp"

namespace sparse_mocap {

using namespace retrieval;

namespace {

constexpr int kPlaybackNeighbours = 4096;

// What work takes of the process's processor time.
template <typename Work>
double processor_seconds(const Work& work) {
  const std::clock_t begin = std::clock();
  work();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

// The features of a take and of a database, alike, and the search over the latter.
class WindowSearch {
 public:
  WindowSearch(const MotionDatabase& database, const std::vector<Sensor>& sensors,
               const std::vector<Reading>& take, FeatureLayout layout,
               const std::vector<int>& excluded_clips)
      : layout_(std::move(layout)),
        signals_(compared_signals(sensors, false)),
        weights_(3 * signals_.size(), 1.0F),
        take_(static_cast<Eigen::Index>(take.size()),
              static_cast<Eigen::Index>(3 * signals_.size())),
        index_(database_features(database, database_signals(database, signals_), layout_, weights_),
               searched_frames(database, false, excluded_clips)) {
    for (std::size_t t = 0; t < take.size(); ++t)
      take_.row(static_cast<Eigen::Index>(t)) = signal_row(take[t], signals_);
  }

  void search(Eigen::Index t, int k, std::vector<Neighbour>& out) const {
    std::vector<float> feature(static_cast<std::size_t>(index_.num_dimensions()));
    feature_at({take_, 0, take_.rows(), t}, layout_, weights_, feature);
    index_.search(feature, k, out);
  }

 private:
  FeatureLayout layout_;
  std::vector<Signal> signals_;
  std::vector<float> weights_;
  FeatureRows take_;
  KnnIndex index_;
};

}  // namespace

std::vector<int> playback_best_path(const MotionDatabase& database,
                                    const std::vector<Sensor>& sensors,
                                    const std::vector<Reading>& take,
                                    const std::vector<int>& excluded_clips) {
  const WindowSearch search(database, sensors, take, {}, excluded_clips);
  OnlineLazyNeighbourhoodGraph graph(clips_of_frames(database), {});
  std::vector<int> frames;
  std::vector<Neighbour> neighbours;
  for (std::size_t t = 0; t < take.size(); ++t) {
    search.search(static_cast<Eigen::Index>(t), kPlaybackNeighbours, neighbours);
    graph.extend(neighbours);
    frames.push_back(best_paths(graph.paths(), 1).front().frame);
  }
  return frames;
}

std::vector<int> nearest_windows(const MotionDatabase& database, const std::vector<Sensor>& sensors,
                                 const std::vector<Reading>& take, int window,
                                 const std::vector<int>& excluded_clips) {
  FeatureLayout layout;
  layout.parts.clear();
  for (int back = 0; back < window; ++back) layout.parts.push_back({{-back, 1.0}});
  const WindowSearch search(database, sensors, take, layout, excluded_clips);
  std::vector<int> frames;
  std::vector<Neighbour> nearest;
  for (std::size_t t = 0; t < take.size(); ++t) {
    search.search(static_cast<Eigen::Index>(t), 1, nearest);
    frames.push_back(nearest.front().row);
  }
  return frames;
}

std::vector<int> nearest_poses(const MotionDatabase& database, const Eigen::MatrixXd& positions,
                               const std::vector<int>& excluded_clips) {
  const auto is_searched = searched_frames(database, false, excluded_clips);
  std::vector<int> frames;
  for (Eigen::Index t = 0; t < positions.cols(); ++t) {
    const Eigen::VectorXf pose = positions.col(t).cast<float>();
    int best = -1;
    float least = 0.0F;
    for (int n = 0; n < database.num_frames(); ++n) {
      if (!is_searched[static_cast<std::size_t>(n)]) continue;
      const float squared = (database.positions().row(n) - pose.transpose()).squaredNorm();
      if (best >= 0 && squared >= least) continue;
      best = n;
      least = squared;
    }
    frames.push_back(best);
  }
  return frames;
}

GraphTimes graph_times(const MotionDatabase& database, const std::vector<Sensor>& sensors,
                       const std::vector<Reading>& take, int window,
                       const std::vector<int>& excluded_clips) {
  const WindowSearch search(database, sensors, take, {}, excluded_clips);
  const OlngConfig config{1.0, 1.0, window, true};
  OnlineLazyNeighbourhoodGraph online(clips_of_frames(database), config);
  OnlineLazyNeighbourhoodGraph anew = online;
  std::deque<std::vector<Neighbour>> columns;
  GraphTimes times;
  for (std::size_t t = 0; t < take.size(); ++t) {
    columns.emplace_back();
    search.search(static_cast<Eigen::Index>(t), kPlaybackNeighbours, columns.back());
    if (columns.size() > static_cast<std::size_t>(window)) columns.pop_front();
    times.online_s += processor_seconds([&] { online.extend(columns.back()); });
    times.anew_s += processor_seconds([&] {
      anew.reset();
      for (const auto& column : columns) anew.extend(column);
    });
    if (best_paths(online.paths(), 1).front().frame == best_paths(anew.paths(), 1).front().frame)
      times.same += 1.0;
  }
  const auto count = static_cast<double>(take.size());
  return {times.online_s / count, times.anew_s / count, times.same / count};
}

}  // namespace sparse_mocap
