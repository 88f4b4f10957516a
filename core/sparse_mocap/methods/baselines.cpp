// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/methods/baselines.hpp"

#include <algorithm>

#include "sparse_mocap/database/index.hpp"
#include "sparse_mocap/tautges2011/features.hpp"
#include "sparse_mocap/tautges2011/neighbourhood.hpp"
#include "sparse_mocap/tautges2011/olng.hpp"

namespace sparse_mocap {
namespace {

constexpr int kPlaybackNeighbours = 4096;

std::vector<bool> used_frames(const MotionDatabase& database,
                              const std::vector<int>& excluded_clips) {
  std::vector<bool> is_used(static_cast<std::size_t>(database.num_frames()), true);
  for (const Clip& clip : database.clips())
    if (clip.tempo != 1.0)
      std::fill(is_used.begin() + clip.begin, is_used.begin() + clip.end, false);
  for (const int clip : excluded_clips) {
    const Clip& excluded = database.clips().at(static_cast<std::size_t>(clip));
    std::fill(is_used.begin() + excluded.begin, is_used.begin() + excluded.end, false);
  }
  return is_used;
}

// The features of a take and of a database, alike, and the search over the latter.
class WindowSearch {
 public:
  WindowSearch(const MotionDatabase& database, const std::vector<WornSensor>& sensors,
               const std::vector<Reading>& take, tautges2011::FeatureLayout layout,
               const std::vector<int>& excluded_clips)
      : layout_(std::move(layout)),
        weights_(3 * sensors.size(), 1.0F),
        take_(static_cast<Eigen::Index>(take.size()),
              static_cast<Eigen::Index>(3 * sensors.size())),
        index_(tautges2011::database_features(
                   database, tautges2011::database_readings(database, sensors), layout_, weights_),
               used_frames(database, excluded_clips)) {
    for (std::size_t t = 0; t < take.size(); ++t)
      take_.row(static_cast<Eigen::Index>(t)) = take[t].reshaped().transpose().cast<float>();
  }

  void search(Eigen::Index t, int k, std::vector<Neighbour>& out) const {
    std::vector<float> feature(static_cast<std::size_t>(index_.num_dimensions()));
    tautges2011::feature_at(take_, 0, take_.rows(), t, layout_, weights_, feature);
    index_.search(feature, k, out);
  }

 private:
  tautges2011::FeatureLayout layout_;
  std::vector<float> weights_;
  FeatureRows take_;
  KnnIndex index_;
};

}  // namespace

std::vector<int> playback_best_path(const MotionDatabase& database,
                                    const std::vector<WornSensor>& sensors,
                                    const std::vector<Reading>& take,
                                    const std::vector<int>& excluded_clips) {
  const WindowSearch search(database, sensors, take, {}, excluded_clips);
  std::vector<std::int32_t> clips;
  for (int n = 0; n < database.num_frames(); ++n) clips.push_back(database.clip_index(n));
  tautges2011::OnlineLazyNeighbourhoodGraph graph(std::move(clips), {});
  std::vector<int> frames;
  std::vector<Neighbour> neighbours;
  for (std::size_t t = 0; t < take.size(); ++t) {
    search.search(static_cast<Eigen::Index>(t), kPlaybackNeighbours, neighbours);
    graph.extend(neighbours);
    frames.push_back(tautges2011::best_paths(graph.paths(), 1).front().frame);
  }
  return frames;
}

std::vector<int> nearest_windows(const MotionDatabase& database,
                                 const std::vector<WornSensor>& sensors,
                                 const std::vector<Reading>& take, int window,
                                 const std::vector<int>& excluded_clips) {
  tautges2011::FeatureLayout layout;
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
  const auto is_used = used_frames(database, excluded_clips);
  std::vector<int> frames;
  for (Eigen::Index t = 0; t < positions.cols(); ++t) {
    const Eigen::VectorXf pose = positions.col(t).cast<float>();
    const Eigen::VectorXf squared =
        (database.positions().rowwise() - pose.transpose()).rowwise().squaredNorm();
    int best = -1;
    for (int n = 0; n < database.num_frames(); ++n)
      if (is_used[static_cast<std::size_t>(n)] && (best < 0 || squared[n] < squared[best]))
        best = n;
    frames.push_back(best);
  }
  return frames;
}

}  // namespace sparse_mocap
