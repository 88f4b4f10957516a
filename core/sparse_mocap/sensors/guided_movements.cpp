// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/guided_movements.hpp"

#include <algorithm>
#include <string>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap {
namespace {

bool is_on_trunk(const Site& site) {
  using namespace standard_joint;
  return site.carrier == head || site.carrier == thorax || site.carrier == upperback ||
         site.carrier == root;
}

bool is_on_arm(const Site& site) {
  using namespace standard_joint;
  return site.carrier == lradius || site.carrier == rradius || site.carrier == lhumerus ||
         site.carrier == rhumerus || site.carrier == lwrist || site.carrier == rwrist;
}

// Where the shoulder is, seen along the forearm of a straight arm.
double shoulder_place() {
  const auto& bones = template_bones();
  return -bones[standard_joint::lhumerus].norm() / bones[standard_joint::lradius].norm();
}

std::vector<GuidedMovement> make_movements() {
  // Sites' axes on hanging limbs: x down; z to the outside at the arms, forward at the legs.
  const Vec3 y = Vec3::UnitY(), z = Vec3::UnitZ();
  const double shoulder = shoulder_place();
  return {
      {"bend_elbows",
       "upper arms still at the sides, thumbs forward: bend both elbows and stretch them",
       {{"left_wrist", -z, 0.0}, {"right_wrist", z, 0.0}}},
      {"raise_arms",
       "arms straight, palms facing each other: raise both forward and lower them",
       {{"left_wrist", -z, shoulder},
        {"right_wrist", z, shoulder},
        {"left_upper_arm", -z, 0.0},
        {"right_upper_arm", z, 0.0}}},
      {"spread_arms",
       "arms straight, palms down: raise both to the sides and lower them",
       {{"left_wrist", -y, shoulder},
        {"right_wrist", -y, shoulder},
        {"left_upper_arm", -y, 0.0},
        {"right_upper_arm", -y, 0.0}}},
      {"squat",
       "feet still, knees forward: squat and rise",
       {{"left_ankle", y, 1.0},
        {"right_ankle", y, 1.0},
        {"left_thigh", -y, std::nullopt},
        {"right_thigh", -y, std::nullopt}}},
      {"bend_knees",
       "thighs still: bend one knee backwards and stretch it, then the other",
       {{"left_ankle", y, 0.0}, {"right_ankle", y, 0.0}}},
      {"walk",
       "walk straight ahead",
       {{"left_ankle", y, std::nullopt}, {"right_ankle", y, std::nullopt}}},
      {"bow",
       "bow from the hips with the back straight and rise",
       {{"head", -y, std::nullopt}, {"chest", -y, std::nullopt}, {"pelvis", -y, std::nullopt}}},
  };
}

template <typename Names>
std::string listed(const Names& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

}  // namespace

const std::vector<std::string_view>& standing_pose_names() {
  static const std::vector<std::string_view> names{"arms_down", "t_pose"};
  return names;
}

StandingPose find_standing_pose(std::string_view name) {
  if (name == "arms_down") return StandingPose::arms_down;
  if (name == "t_pose") return StandingPose::t_pose;
  throw ConfigError("unknown standing pose '" + std::string(name) + "'; known are " +
                    listed(standing_pose_names()));
}

Vec3 up_while_standing(const Site& site, StandingPose pose) {
  if (is_on_trunk(site)) return Vec3::UnitX();
  if (is_on_arm(site) && pose == StandingPose::t_pose) return Vec3::UnitZ();
  return -Vec3::UnitX();
}

const std::vector<GuidedMovement>& guided_movements() {
  static const std::vector<GuidedMovement> movements = make_movements();
  return movements;
}

const GuidedMovement& find_guided_movement(std::string_view name) {
  std::vector<std::string_view> names;
  for (const auto& movement : guided_movements()) {
    if (movement.name == name) return movement;
    names.push_back(movement.name);
  }
  throw ConfigError("unknown movement '" + std::string(name) + "'; known are " + listed(names));
}

const GuidedTurn* turn_of(const GuidedMovement& movement, std::string_view site) {
  const auto found = std::find_if(movement.turns.begin(), movement.turns.end(),
                                  [&](const GuidedTurn& turn) { return turn.site == site; });
  return found == movement.turns.end() ? nullptr : &*found;
}

}  // namespace sparse_mocap
