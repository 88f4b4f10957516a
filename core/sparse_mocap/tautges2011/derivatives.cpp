// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/derivatives.hpp"

#include <algorithm>

#include "sparse_mocap/retrieval/neighbourhood.hpp"

namespace sparse_mocap::tautges2011 {

void kinematics_at(const MotionDatabase& database, int frame, Eigen::Ref<Eigen::VectorXd> velocity,
                   Eigen::Ref<Eigen::VectorXd> acceleration) {
  const Clip& clip = retrieval::clip_at(database, frame);
  const double dt = database.frame_time_s();
  if (clip.num_frames() < 3) {
    velocity.setZero();
    acceleration.setZero();
    return;
  }
  const int centre = std::clamp(frame, clip.begin + 1, clip.end - 2);
  const auto row = [&](int n) { return database.positions().row(n).transpose().cast<double>(); };
  velocity = (row(centre + 1) - row(centre - 1)) / (2.0 * dt);
  acceleration = (row(centre + 1) - 2.0 * row(centre) + row(centre - 1)) / (dt * dt);
}

PathDerivatives path_derivatives(const MotionDatabase& database,
                                 std::span<const retrieval::Path> paths) {
  PathDerivatives out;
  put_path_derivatives(database, paths, out);
  return out;
}

void put_path_derivatives(const MotionDatabase& database, std::span<const retrieval::Path> paths,
                          PathDerivatives& out) {
  const Eigen::Index dimensions = database.positions().cols();
  const auto n = static_cast<Eigen::Index>(paths.size());
  for (auto* matrix : {&out.velocities, &out.accelerations, &out.velocities_before})
    matrix->resize(dimensions, n);
  static thread_local Eigen::VectorXd unused;
  unused.resize(dimensions);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& path = paths[static_cast<std::size_t>(i)];
    const Clip& clip = retrieval::clip_at(database, path.frame);
    kinematics_at(database, path.frame, out.velocities.col(i), out.accelerations.col(i));
    const int before =
        path.previous_frame >= 0 ? path.previous_frame : std::max(path.frame - 1, clip.begin);
    kinematics_at(database, before, out.velocities_before.col(i), unused);
  }
}

}  // namespace sparse_mocap::tautges2011
