// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/foot_stands.hpp"

#include <algorithm>
#include <cmath>

namespace sparse_mocap {
namespace {

constexpr double kLongestGap_s = 0.08;
constexpr double kShortestStand_s = 0.12;

double eased(double share) { return share * share * (3.0 - 2.0 * share); }

bool stands_at(const Eigen::Matrix3Xd& ankle, const Eigen::VectorXd& certainty, int t,
               double ankle_height_m, double frame_time_s, const StandOptions& options) {
  const int last = static_cast<int>(ankle.cols()) - 1;
  const int before = std::max(t - 1, 0), after = std::min(t + 1, last);
  const double elapsed_s = std::max(after - before, 1) * frame_time_s;
  const double speed_mps = (ankle.col(after) - ankle.col(before)).norm() / elapsed_s;
  return certainty[t] >= options.least_certainty && speed_mps <= options.fastest_mps &&
         ankle(1, t) <= ankle_height_m + options.highest_m;
}

}  // namespace

std::vector<Stand> find_stands(const Eigen::Matrix3Xd& ankle, const Eigen::VectorXd& certainty,
                               double ankle_height_m, double frame_time_s,
                               const StandOptions& options) {
  std::vector<Stand> found;
  for (int t = 0; t < static_cast<int>(ankle.cols()); ++t) {
    if (!stands_at(ankle, certainty, t, ankle_height_m, frame_time_s, options)) continue;
    const bool continues =
        !found.empty() && (t - found.back().end) * frame_time_s < kLongestGap_s + 1e-9;
    if (continues)
      found.back().end = t + 1;
    else
      found.push_back({t, t + 1});
  }
  std::erase_if(found, [&](const Stand& stand) {
    return (stand.end - stand.begin) * frame_time_s < kShortestStand_s;
  });
  return found;
}

Eigen::Matrix3Xd stand_corrections(const Eigen::Matrix3Xd& ankle, const std::vector<Stand>& stands,
                                   double ankle_height_m) {
  Eigen::Matrix3Xd added = Eigen::Matrix3Xd::Zero(3, ankle.cols());
  for (const Stand& stand : stands) {
    const auto path = ankle.middleCols(stand.begin, stand.end - stand.begin);
    Vec3 place = path.rowwise().mean();
    place.y() = ankle_height_m;
    added.middleCols(stand.begin, stand.end - stand.begin) = (-path).colwise() + place;
  }
  const auto num_frames = static_cast<int>(ankle.cols());
  for (std::size_t i = 0; i <= stands.size() && !stands.empty(); ++i) {
    const int begin = i == 0 ? -1 : stands[i - 1].end - 1;
    const int end = i == stands.size() ? num_frames : stands[i].begin;
    const Vec3 from = i == 0 ? Vec3(added.col(end)) : Vec3(added.col(begin));
    const Vec3 to = i == stands.size() ? from : Vec3(added.col(end));
    for (int t = begin + 1; t < end; ++t)
      added.col(t) = from + eased(static_cast<double>(t - begin) / (end - begin)) * (to - from);
  }
  return added;
}

Eigen::VectorXd stand_weights(const std::vector<Stand>& stands, int num_frames,
                              double frames_to_zero) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(num_frames);
  for (const Stand& stand : stands) {
    for (int t = 0; t < num_frames; ++t) {
      const int away = std::max({stand.begin - t, t - (stand.end - 1), 0});
      if (away > frames_to_zero) continue;
      weights[t] = std::max(weights[t], eased(1.0 - away / (frames_to_zero + 1.0)));
    }
  }
  return weights;
}

}  // namespace sparse_mocap
