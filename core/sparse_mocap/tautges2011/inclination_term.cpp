// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/inclination_term.hpp"

#include "sparse_mocap/motion/standard_skeleton.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::tautges2011 {
namespace {

bool is_on_limb(const Site& site) {
  using namespace standard_joint;
  return site.carrier != root && site.carrier != thorax && site.carrier != head;
}

}  // namespace

KernelTerm inclination_term(const Skeleton& skeleton, const Reading& reading,
                            const std::vector<WornSensor>& sensors, double weight,
                            Eigen::Index num_paths) {
  KernelTerm term{{Compared::rises, {}}, weight, 2.0, {}};
  std::vector<double> rises;
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    const Site& site = all_sites()[static_cast<std::size_t>(sensors[s].site)];
    const Vec3 up = reading.col(static_cast<Eigen::Index>(s));
    if (sensors[s].quantity != Quantity::up || !is_on_limb(site) || !(up.norm() > 0.0)) continue;
    // A sensor on a limb has its x axis along it, away from the body.
    rises.push_back(up.normalized().x() * skeleton.joint(site.carrier).bone.norm());
    term.space.joints.push_back(site.carrier);
  }
  if (rises.empty()) term.weight = 0.0;
  const auto count = static_cast<Eigen::Index>(rises.size());
  term.targets = Eigen::Map<const Eigen::VectorXd>(rises.data(), count).replicate(1, num_paths);
  return term;
}

}  // namespace sparse_mocap::tautges2011
