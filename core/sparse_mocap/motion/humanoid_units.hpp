// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "sparse_mocap/motion/humanoid_rest.hpp"

namespace sparse_mocap {

// The factor that gives legs (m) a human length, 1 when they have one already; what was guessed
// goes to warnings. Throws MappingError when no usual unit does.
double guessed_unit_scale(double leg_m, std::vector<std::string>& warnings);

// Turns the file's world into one with y up, as posture at rest and movement tell; what was guessed
// goes to warnings.
Mat3 guessed_world(const Motion& source, const SourceJoints& joints, const RestPosture& rest,
                   std::vector<std::string>& warnings);

// The motion without tracks that draw a joint into its parent: their exporters (MakeHuman) write
// position channels relative to the OFFSET. num_dropped (may be null): how many there were.
Motion with_sound_offsets(const Motion& source, int* num_dropped = nullptr);

// How many frames stand before the movement: exporters put a rest pose or a T-pose there.
int num_leading_rest_frames(const Motion& motion);

}  // namespace sparse_mocap
