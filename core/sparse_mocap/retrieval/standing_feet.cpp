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

}  // namespace

StandingFeet standing_feet(const MotionDatabase& database, const WeightedPaths& weighted,
                           const Eigen::Vector2d& usual_height_m) {
  StandingFeet feet;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto row = static_cast<Eigen::Index>(side);
    double standing = 0.0, height = 0.0;
    Vec3 step = Vec3::Zero();
    for (std::size_t i = 0; i < weighted.paths.size(); ++i) {
      const int frame = weighted.paths[i].frame;
      const double stands = static_cast<double>(database.contacts()(frame, row)) *
                            weighted.weights[static_cast<Eigen::Index>(i)];
      if (stands <= 0.0) continue;
      standing += stands;
      step += stands * step_into(database, frame, side);
      height += stands * (root_height(database, frame) + ankle(database, frame, side).y());
    }
    feet.certainty[row] = std::min(standing, 1.0);  // weights sum to 1 but for rounding
    feet.height_m[row] = standing > 0.0 ? height / standing : usual_height_m[row];
    if (standing > 0.0) feet.step_m[side] = step / standing;
  }
  return feet;
}

Eigen::Vector2d usual_standing_heights_m(const MotionDatabase& database) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), count = Eigen::Vector2d::Zero();
  for (int frame = 0; frame < database.num_frames(); ++frame) {
    for (std::size_t side = 0; side < 2; ++side) {
      const auto row = static_cast<Eigen::Index>(side);
      if (!(database.contacts()(frame, row) > 0.0F)) continue;
      sum[row] += root_height(database, frame) + ankle(database, frame, side).y();
      count[row] += 1.0;
    }
  }
  return sum.cwiseQuotient(count.cwiseMax(1.0));
}

// A logistic function; its coefficients are set by hand, on HDM05 motions with simulated sensors.
double standing_certainty(double vote, double change_mps2) {
  if (std::isnan(change_mps2)) return vote;
  const double p = std::clamp(vote, 0.01, 0.99);
  const double logit = 0.6 * std::log(p / (1.0 - p)) + 1.2 - 0.65 * change_mps2;
  return 1.0 / (1.0 + std::exp(-logit));
}

}  // namespace sparse_mocap::retrieval
