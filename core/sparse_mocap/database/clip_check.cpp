// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/clip_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "sparse_mocap/retargeting/bone_positions.hpp"
#include "sparse_mocap/retargeting/limb_errors.hpp"
#include "sparse_mocap/retargeting/source_motion.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;

constexpr int kMostFrames = 200;  // that are looked at for postures and limbs
constexpr double kGravity_mps2 = 9.81;

std::string text_of(const char* format, double a, double b = 0.0) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), format, a, b);
  return text.data();
}

int step_through(const Motion& motion) { return std::max(1, motion.num_frames() / kMostFrames); }

// The value below which a share of the values lies.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

void check_limbs(const Motion& source, const SkeletonMapping& mapping, const Motion& mapped,
                 const ClipLimits& limits, std::vector<ClipFault>& faults) {
  const LimbErrors errors = limb_errors(source, mapping, mapped, step_through(mapped));
  const auto worst = std::max_element(errors.mean_rad.begin(), errors.mean_rad.end());
  const double strayed_deg = *worst / kRadiansPerDegree;
  if (strayed_deg < limits.strayed_deg) return;
  const auto bone = kLimbBones[static_cast<std::size_t>(worst - errors.mean_rad.begin())];
  std::string text(standard_joint_names()[bone]);
  text += text_of(
      " strays from the file's by %.0f degrees on average; map its joints by hand, see "
      "inspect --save-mapping",
      strayed_deg);
  faults.push_back({std::move(text), strayed_deg / limits.strayed_deg,
                    strayed_deg > limits.refused_strayed_deg});
}

// Lying, head below hips, sides that are mixed up: each in every frame.
void check_posture(const Motion& file, const SkeletonMapping& mapping, int lead,
                   const ClipLimits& limits, std::vector<ClipFault>& faults) {
  constexpr int kPoses = 10;  // a file of fewer frames holds poses, which may be anything
  const Motion source = without_collapsed_offsets(file);
  if (source.num_frames() - lead < kPoses) return;
  double most_upright = -1.0, least_crossed = 1.0;
  for (int t = lead; t < source.num_frames(); t += step_through(source)) {
    const auto bones = bone_positions(source.skeleton, mapping.joints, source.transforms(t));
    most_upright = std::max(most_upright, (mapping.R_world_file * bones.up).normalized().dot(kUp));
    least_crossed = std::min(least_crossed,
                             -bones.left_hips.normalized().dot(bones.left_shoulders.normalized()));
  }
  constexpr double kCrossed = 0.5;
  if (least_crossed > kCrossed)
    faults.push_back(
        {"the left arm is on the side of the right leg in every frame; map the sides "
         "by hand, see inspect --save-mapping",
         3.0, true});
  if (most_upright < -limits.upright)
    faults.push_back(
        {"stands on its head in every frame; choose the axis that is up, see --up", 3.0, true});
  else if (most_upright < limits.upright)
    faults.push_back(
        {"lies in every frame; if it should stand, choose the axis that is up, see --up", 1.0,
         false});
}

// A person in the air falls with 1 g and nobody pulls a trunk down much faster: a motion that does
// was read at too high a rate, or in the wrong unit.
void check_speeds(const Motion& mapped, const ClipLimits& limits, std::vector<ClipFault>& faults) {
  constexpr double kRate_hz = 25.0, kRare = 0.01;
  const Motion motion = resampled(mapped, kRate_hz);
  std::vector<std::array<Vec3, 3>> points;  // the middle of the trunk, the wrists
  for (int t = 0; t < motion.num_frames(); ++t) {
    const JointTransforms pose = motion.transforms(t);
    points.push_back(
        {0.5 * (pose.pivot[root] + pose.end[thorax]), pose.end[lradius], pose.end[rradius]});
  }
  std::vector<double> falling, trunk, wrists;
  for (std::size_t t = 1; t < points.size(); ++t) {
    const auto speed = [&](std::size_t k) {
      return (points[t][k] - points[t - 1][k]).norm() * kRate_hz;
    };
    trunk.push_back(speed(0));
    wrists.push_back(std::max(speed(1), speed(2)));
    if (t + 1 < points.size())
      falling.push_back(-(points[t + 1][0] - 2.0 * points[t][0] + points[t - 1][0]).y() * kRate_hz *
                        kRate_hz / kGravity_mps2);
  }
  const double falling_g = quantile(std::move(falling), 1.0 - kRare);
  const double trunk_mps = quantile(std::move(trunk), 1.0 - kRare);
  const double wrist_mps = quantile(std::move(wrists), 1.0 - kRare);
  const double rate_hz = 1.0 / mapped.frame_time_s;
  if (falling_g > limits.falling_g)
    faults.push_back(
        {text_of("falls with %.1f times gravity at %.4g Hz; check the rate, see --rate "
                 "and the column rate_hz",
                 falling_g, rate_hz),
         falling_g / limits.falling_g, false});
  if (trunk_mps > limits.trunk_mps || wrist_mps > limits.wrist_mps)
    faults.push_back(
        {text_of("moves faster than a person: trunk %.0f m/s, wrist %.0f m/s; check the "
                 "rate and the unit, see --rate and --unit",
                 trunk_mps, wrist_mps),
         std::max(trunk_mps / limits.trunk_mps, wrist_mps / limits.wrist_mps), false});
}

}  // namespace

std::vector<ClipFault> check_clip(const Motion& source, const SkeletonMapping& mapping,
                                  const Motion& mapped, const ClipLimits& limits) {
  std::vector<ClipFault> faults;
  if (mapped.num_frames() == 0) return faults;
  check_limbs(source, mapping, mapped, limits, faults);
  check_posture(source, mapping, source.num_frames() - mapped.num_frames(), limits, faults);
  check_speeds(mapped, limits, faults);
  std::stable_sort(faults.begin(), faults.end(),
                   [](const ClipFault& a, const ClipFault& b) { return a.severity > b.severity; });
  return faults;
}

}  // namespace sparse_mocap
