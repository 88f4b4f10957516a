// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/frame_target.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "sparse_mocap/motion/standard_skeleton.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::path_regression {
namespace {

bool is_on_limb(const Site& site) {
  using namespace standard_joint;
  return site.carrier != root && site.carrier != upperback && site.carrier != thorax &&
         site.carrier != head;
}

double doubt(double agreement) { return 1.0 / std::max(agreement, 1e-6) - 1.0; }

}  // namespace

FrameTarget blended(const FrameTarget& a, const FrameTarget& b, double share,
                    double wide_spread_m) {
  const auto between = [share](const auto& from, const auto& to) {
    return std::decay_t<decltype(from)>(from + share * (to - from));
  };
  FrameTarget out = a;
  out.points = between(a.points, b.points);
  const Eigen::Index ends = a.points.size() / 4;
  const double mean_square =
      3.0 * (b.points - a.points).head(ends).squaredNorm() / static_cast<double>(ends);
  out.agreement = 1.0 / (1.0 + between(doubt(a.agreement), doubt(b.agreement)) +
                         share * (1.0 - share) * mean_square / (wide_spread_m * wide_spread_m));
  if (a.step.size() == b.step.size()) out.step = between(a.step, b.step);
  out.root.velocity_mps = between(a.root.velocity_mps, b.root.velocity_mps);
  out.root.yaw_rate_radps = between(a.root.yaw_rate_radps, b.root.yaw_rate_radps);
  out.root.height_m = between(a.root.height_m, b.root.height_m);
  out.root.contacts = between(a.root.contacts, b.root.contacts);
  out.feet.certainty = between(a.feet.certainty, b.feet.certainty);
  out.feet.height_m = between(a.feet.height_m, b.feet.height_m);
  for (std::size_t side : {0U, 1U})
    out.feet.step_m[side] = between(a.feet.step_m[side], b.feet.step_m[side]);
  return out;
}

void even_agreements(std::span<FrameTarget> targets, std::size_t reach) {
  std::vector<double> doubts;
  for (const auto& target : targets) doubts.push_back(doubt(target.agreement));
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const std::size_t begin = t - std::min(t, reach);
    const std::size_t end = std::min(targets.size(), t + reach + 1);
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += doubts[i];
    targets[t].agreement = 1.0 / (1.0 + sum / static_cast<double>(end - begin));
  }
}

double evened_agreement(double agreement, double before) {
  constexpr double kNew = 0.4;  // share of the frame itself
  return 1.0 / (1.0 + kNew * doubt(agreement) + (1.0 - kNew) * doubt(before));
}

Eigen::VectorXd pose_points(const JointTransforms& pose, double lever_m) {
  Eigen::VectorXd points;
  put_pose_points(pose, lever_m, points);
  return points;
}

void put_pose_points(const JointTransforms& pose, double lever_m, Eigen::VectorXd& points) {
  const auto n = static_cast<Eigen::Index>(pose.end.size());
  points.resize(12 * n);
  for (Eigen::Index j = 0; j < n; ++j) {
    points.segment<3>(3 * j) = pose.end[static_cast<std::size_t>(j)];
    points.segment<9>(3 * n + 9 * j) =
        lever_m * pose.R_world_joint[static_cast<std::size_t>(j)].reshaped();
  }
}

InclinationTarget inclination_target(const Skeleton& skeleton, const Reading& reading,
                                     std::span<const retrieval::Signal> signals) {
  InclinationTarget target;
  put_inclination_target(skeleton, reading, signals, target);
  return target;
}

void put_inclination_target(const Skeleton& skeleton, const Reading& reading,
                            std::span<const retrieval::Signal> signals, InclinationTarget& target) {
  target.joints.clear();
  target.rises_m.clear();
  for (const auto& signal : signals) {
    const Site& site = all_sites()[static_cast<std::size_t>(signal.site)];
    if (signal.channel != Channel::gravity_direction || !is_on_limb(site)) continue;
    const Vec3 up = reading.gravity_direction.col(signal.sensor);
    if (!(up.norm() > 0.0)) continue;
    // A sensor on a limb has its x axis along it, away from the body.
    target.rises_m.push_back(up.normalized().x() * skeleton.joint(site.carrier).bone.norm());
    target.joints.push_back(site.carrier);
  }
}

std::vector<TurningTarget> turning_targets(const Reading& reading,
                                           std::span<const retrieval::Signal> signals) {
  std::vector<TurningTarget> targets;
  put_turning_targets(reading, signals, targets);
  return targets;
}

void put_turning_targets(const Reading& reading, std::span<const retrieval::Signal> signals,
                         std::vector<TurningTarget>& targets) {
  targets.clear();
  for (const auto& signal : signals) {
    if (signal.channel != Channel::gravity_direction) continue;
    const Vec3 up = reading.gravity_direction.col(signal.sensor);
    const double rate_radps = up.normalized().dot(reading.angular_velocity.col(signal.sensor));
    if (std::isfinite(rate_radps))
      targets.push_back(
          {all_sites()[static_cast<std::size_t>(signal.site)].orientation, rate_radps});
  }
}

}  // namespace sparse_mocap::path_regression
