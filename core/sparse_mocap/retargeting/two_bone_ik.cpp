// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/two_bone_ik.hpp"

#include <algorithm>
#include <cmath>

namespace sparse_mocap {
namespace {

// A limb is never quite straight, so that its plane stays known.
constexpr double kLongest = 0.9995;
// Below this sine of the bend, the axis that is given counts for more than the bend's own.
constexpr double kBent = 0.05;

Mat3 frame(const Vec3& along, const Vec3& axis) {
  Mat3 R;
  R.col(0) = along;
  R.col(2) = along.cross(axis).normalized();
  R.col(1) = R.col(2).cross(along);
  return R;
}

Vec3 across(const Vec3& axis, const Vec3& along) { return axis - along * along.dot(axis); }

}  // namespace

void reach(const Vec3& target, const Vec3& aside, TwoBoneLimb& limb) {
  const Vec3 upper = limb.middle - limb.begin, lower = limb.end - limb.middle;
  const double a = upper.norm(), b = lower.norm();
  const Vec3 to_end = limb.end - limb.begin;
  if (!(a > 0.0 && b > 0.0) || to_end.norm() < 1e-9 * (a + b)) return;
  const Vec3 wanted = target - limb.begin;
  const double distance =
      std::clamp(wanted.norm(), std::abs(a - b) + 1e-6 * (a + b), kLongest * (a + b));
  if (wanted.norm() < 1e-9 * (a + b)) return;
  const Vec3 u = to_end.normalized(), v = wanted.normalized();
  const Vec3 bend = upper.cross(lower) / (a * b);
  const Vec3 axis = across(bend + std::max(0.0, kBent - bend.norm()) * aside, u).normalized();
  const Vec3 turned_axis = Quat::FromTwoVectors(u, v) * axis;
  const double cosine =
      std::clamp((a * a + distance * distance - b * b) / (2.0 * a * distance), -1.0, 1.0);
  const Vec3 forward = v.cross(turned_axis);
  const Vec3 new_upper = a * (cosine * v + std::sqrt(1.0 - cosine * cosine) * forward);
  const Vec3 new_lower = distance * v - new_upper;
  const auto turn = [&](const Vec3& from, const Vec3& to) {
    return Mat3(frame(to.normalized(), turned_axis) * frame(from.normalized(), axis).transpose());
  };
  limb.R_upper = turn(upper, new_upper) * limb.R_upper;
  limb.R_lower = turn(lower, new_lower) * limb.R_lower;
  limb.middle = limb.begin + new_upper;
  limb.end = limb.middle + new_lower;
}

}  // namespace sparse_mocap
