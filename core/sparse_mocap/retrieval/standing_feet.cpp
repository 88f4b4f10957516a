// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/standing_feet.hpp"

#include <algorithm>
#include <cmath>

#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap::retrieval {
namespace {

constexpr std::array kAnkles{standard_joint::ltibia, standard_joint::rtibia};

// Where an ankle is from the root, heading frame.
Vec3 ankle(const MotionDatabase& database, int frame, std::size_t side) {
  return database.positions()
      .row(frame)
      .segment<3>(3 * static_cast<Eigen::Index>(kAnkles[side]))
      .transpose()
      .cast<double>();
}

double root_height(const MotionDatabase& database, int frame) {
  return static_cast<double>(database.root_motion()(frame, root_motion_column::height));
}

// How an ankle moves into a frame, in the heading frame of the frame before.
Vec3 step_into(const MotionDatabase& database, int frame, std::size_t side) {
  using namespace root_motion_column;
  const Clip& clip = clip_at(database, frame);
  const int into = std::max(frame, std::min(clip.begin + 1, clip.end - 1));
  const int from = std::max(into - 1, clip.begin);
  const Eigen::RowVector4d rates = database.root_motion().row(into).cast<double>();
  const double dt_s = database.frame_time_s();
  const Vec3 root_step(rates[velocity_left] * dt_s,
                       root_height(database, into) - root_height(database, from),
                       rates[velocity_forward] * dt_s);
  return root_step + yaw_rotation(rates[yaw_rate] * dt_s) * ankle(database, into, side) -
         ankle(database, from, side);
}

double ankle_height(const MotionDatabase& database, int frame, std::size_t side) {
  return root_height(database, frame) + ankle(database, frame, side).y();
}

bool stands(const MotionDatabase& database, int frame, std::size_t side) {
  return database.contacts()(frame, static_cast<Eigen::Index>(side)) > 0.0F;
}

// How high ankles stand in a clip while the body is upright: nearly the lowest, for heels rise
// before a foot leaves the floor. NaN where they never do.
double standing_height(const MotionDatabase& database, const Clip& clip) {
  constexpr double kUpright = 0.6;       // of the legs' length
  constexpr double kNearlyLowest = 0.2;  // of the heights
  double leg_m = 0.0;
  for (const auto joint : {standard_joint::lfemur, standard_joint::ltibia})
    leg_m += database.skeleton().joint(joint).bone.norm();
  std::vector<double> heights;
  for (int frame = clip.begin; frame < clip.end; ++frame)
    for (std::size_t side = 0; side < 2; ++side)
      if (stands(database, frame, side) && -ankle(database, frame, side).y() > kUpright * leg_m)
        heights.push_back(ankle_height(database, frame, side));
  if (heights.empty()) return std::nan("");
  const auto at = heights.begin() + static_cast<std::ptrdiff_t>(
                                        kNearlyLowest * static_cast<double>(heights.size() - 1));
  std::nth_element(heights.begin(), at, heights.end());
  return *at;
}

}  // namespace

StandingHeights::StandingHeights(const MotionDatabase& database) {
  double total = 0.0;
  int known = 0;
  for (const Clip& clip : database.clips()) {
    excess_m_.push_back(standing_height(database, clip));
    if (std::isnan(excess_m_.back())) continue;
    total += excess_m_.back();
    ++known;
  }
  for (double& excess : excess_m_) excess = std::isnan(excess) ? 0.0 : excess - total / known;
  Eigen::Vector2d count = Eigen::Vector2d::Zero();
  for (int frame = 0; frame < database.num_frames(); ++frame) {
    for (std::size_t side = 0; side < 2; ++side) {
      if (!stands(database, frame, side)) continue;
      usual_m_[static_cast<Eigen::Index>(side)] +=
          ankle_height(database, frame, side) - excess_m(database.clip_index(frame));
      count[static_cast<Eigen::Index>(side)] += 1.0;
    }
  }
  usual_m_ = usual_m_.cwiseQuotient(count.cwiseMax(1.0));
}

double root_height_m(const MotionDatabase& database, const WeightedPaths& weighted,
                     const StandingHeights& heights) {
  double height = 0.0;
  for (std::size_t i = 0; i < weighted.paths.size(); ++i) {
    const int frame = weighted.paths[i].frame;
    height += weighted.weights[static_cast<Eigen::Index>(i)] *
              (root_height(database, frame) - heights.excess_m(database.clip_index(frame)));
  }
  return height;
}

StandingFeet standing_feet(const MotionDatabase& database, const WeightedPaths& weighted,
                           const StandingHeights& heights) {
  StandingFeet feet;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto row = static_cast<Eigen::Index>(side);
    double standing = 0.0, height = 0.0;
    Vec3 step = Vec3::Zero();
    for (std::size_t i = 0; i < weighted.paths.size(); ++i) {
      const int frame = weighted.paths[i].frame;
      const double weight = weighted.weights[static_cast<Eigen::Index>(i)];
      if (!stands(database, frame, side) || weight <= 0.0) continue;
      standing += weight;
      step += weight * step_into(database, frame, side);
      height += weight * (ankle_height(database, frame, side) -
                          heights.excess_m(database.clip_index(frame)));
    }
    feet.certainty[row] = std::min(standing, 1.0);  // weights sum to 1 but for rounding
    feet.height_m[row] = standing > 0.0 ? height / standing : heights.usual_m()[row];
    if (standing > 0.0) feet.step_m[side] = step / standing;
  }
  return feet;
}

// A logistic function; its coefficients are set by hand, on HDM05 motions with simulated sensors.
double standing_certainty(double vote, double change_mps2) {
  if (std::isnan(change_mps2)) return vote;
  const double p = std::clamp(vote, 0.01, 0.99);
  const double logit = 0.6 * std::log(p / (1.0 - p)) + 1.2 - 0.65 * change_mps2;
  return 1.0 / (1.0 + std::exp(-logit));
}

}  // namespace sparse_mocap::retrieval
