// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/sites.hpp"

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;

// The sensor's axes from its x axis and the direction of z, both in rest pose, where every joint's
// frame is parallel to the world.
Mat3 mounting(const Vec3& x, const Vec3& towards_z) {
  Mat3 R;
  R.col(0) = x.normalized();
  R.col(1) = towards_z.cross(R.col(0)).normalized();
  R.col(2) = R.col(0).cross(R.col(1));
  return R;
}

Mat3 limb(Index carrier, const Vec3& towards_z) {
  return mounting(template_bones()[carrier], towards_z);
}

}  // namespace

const std::vector<Site>& all_sites() {
  static const Vec3 up = Vec3::UnitY(), forward = Vec3::UnitZ();
  static const std::vector<Site> sites{
      {"left_wrist", lwrist, lradius, limb(lradius, up)},
      {"right_wrist", rwrist, rradius, limb(rradius, up)},
      {"left_ankle", ltibia, ltibia, limb(ltibia, forward)},
      {"right_ankle", rtibia, rtibia, limb(rtibia, forward)},
      {"head", head, head, mounting(up, forward)},
      {"chest", thorax, thorax, mounting(up, forward)},
      {"pelvis", root, root, mounting(up, forward)},
      {"left_upper_arm", lhumerus, lhumerus, limb(lhumerus, up)},
      {"right_upper_arm", rhumerus, rhumerus, limb(rhumerus, up)},
      {"left_thigh", lfemur, lfemur, limb(lfemur, forward)},
      {"right_thigh", rfemur, rfemur, limb(rfemur, forward)},
      {"left_hand", lwrist, lwrist, limb(lwrist, up)},
      {"right_hand", rwrist, rwrist, limb(rwrist, up)},
      {"torso", upperback, upperback, mounting(up, forward)},
  };
  return sites;
}

int find_site(std::string_view name) {
  const auto& sites = all_sites();
  std::string known;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (sites[i].name == name) return static_cast<int>(i);
    known += (i == 0 ? "" : ", ") + std::string(sites[i].name);
  }
  throw ConfigError("unknown sensor '" + std::string(name) + "'; known are " + known);
}

const std::vector<int>& paper_sites() {
  static const std::vector<int> sites{0, 1, 2, 3};
  return sites;
}

}  // namespace sparse_mocap
