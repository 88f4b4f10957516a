// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap {

// How the performer stands still: arms hanging with the palms at the thighs, or stretched out to
// the sides with the palms down; legs straight, feet forward.
enum class StandingPose { arms_down, t_pose };

// Throws ConfigError naming the known poses.
StandingPose find_standing_pose(std::string_view name);
const std::vector<std::string_view>& standing_pose_names();

// The direction against gravity in a site's axes while the performer stands so; unit.
Vec3 up_while_standing(const Site& site, StandingPose pose);

// How one guided movement turns one site.
struct GuidedTurn {
  std::string_view site;
  Vec3 axis;  // unit, site axes: from hanging down (trunk: upright) the sensor first turns about it
  // The position along the site's bone that stays where it is, as 0 is the bone's pivot and 1 its
  // end (below 0: further up the limb); none when nothing does.
  std::optional<double> still_position;
};

// A movement that the performer is asked to make about five times, starting from standing.
struct GuidedMovement {
  std::string_view name;
  std::string_view instruction;
  std::vector<GuidedTurn> turns;
};

const std::vector<GuidedMovement>& guided_movements();

// Throws ConfigError naming the known movements.
const GuidedMovement& find_guided_movement(std::string_view name);

// How the movement turns the site; nullptr when it does not.
const GuidedTurn* turn_of(const GuidedMovement& movement, std::string_view site);

}  // namespace sparse_mocap
