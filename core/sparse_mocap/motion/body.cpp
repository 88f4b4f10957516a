// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/body.hpp"

#include <array>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;

constexpr double kAnkleOfHeight = 0.039;
constexpr double kLeast_m = 0.5, kMost_m = 2.5, kLongestBone_m = 1.0, kShortestLimb_m = 0.01;

void check_height(double height_m, const std::string& what) {
  constexpr double kRounding_m = 1e-9;
  if (height_m >= kLeast_m - kRounding_m && height_m <= kMost_m + kRounding_m) return;
  throw ConfigError(what + " must be between 0.5 and 2.5 m, got " + std::to_string(height_m));
}

}  // namespace

double standing_height_m(const StandardBones& bones) {
  double above_hips = 0.0;
  for (const auto joint : {lowerback, upperback, thorax, lowerneck, upperneck, head})
    above_hips += bones[joint].y();
  const double below_root = -0.5 * (bones[lhipjoint].y() + bones[rhipjoint].y());
  return (leg_length_m(bones) + below_root + above_hips) / (1.0 - kAnkleOfHeight);
}

Body body_of_height(double height_m) {
  check_height(height_m, "the height");
  Body body{"", template_bones()};
  const double scale = height_m / standing_height_m(body.bones);
  for (auto& bone : body.bones) bone *= scale;
  return body;
}

void check_body(const Body& body) {
  for (std::size_t j = 0; j < body.bones.size(); ++j)
    if (!(body.bones[j].norm() <= kLongestBone_m))
      throw ConfigError("the bone '" + std::string(standard_joint_names()[j]) +
                        "' must be at most 1 m long, got " + std::to_string(body.bones[j].norm()));
  for (const auto joint : {lfemur, ltibia, rfemur, rtibia, lhumerus, lradius, rhumerus, rradius})
    if (body.bones[joint].norm() < kShortestLimb_m)
      throw ConfigError("the bone '" + std::string(standard_joint_names()[joint]) +
                        "' has no length");
  check_height(standing_height_m(body.bones), "the height that the bones come to");
}

}  // namespace sparse_mocap
