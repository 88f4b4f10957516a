// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/contacts.hpp"

#include <algorithm>
#include <array>

#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap {
namespace {

constexpr double kHighestStand_m = 0.06;
constexpr double kFastestStand_mps = 0.5;

}  // namespace

Eigen::Matrix2Xd foot_contacts(const Motion& motion) {
  using namespace standard_joint;
  const int n = motion.num_frames();
  Eigen::Matrix2Xd contacts = Eigen::Matrix2Xd::Zero(2, n);
  std::array<Eigen::Matrix3Xd, 2> ankle{Eigen::Matrix3Xd(3, n), Eigen::Matrix3Xd(3, n)};
  for (int t = 0; t < n; ++t) {
    const JointTransforms at = motion.transforms(t);
    ankle[0].col(t) = at.end[ltibia];
    ankle[1].col(t) = at.end[rtibia];
  }
  for (Eigen::Index side = 0; side < 2; ++side) {
    const auto& path = ankle[static_cast<std::size_t>(side)];
    const double lowest = path.row(1).minCoeff();
    for (int t = 0; t < n; ++t) {
      const int before = std::max(t - 1, 0);
      const int after = std::min(t + 1, n - 1);
      const double elapsed_s = std::max(after - before, 1) * motion.frame_time_s;
      const double speed = (path.col(after) - path.col(before)).norm() / elapsed_s;
      const bool stands = path(1, t) < lowest + kHighestStand_m && speed < kFastestStand_mps;
      contacts(side, t) = stands ? 1.0 : 0.0;
    }
  }
  return contacts;
}

}  // namespace sparse_mocap
