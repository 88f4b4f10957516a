// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

namespace sparse_mocap::eom2014 {

// The parts of locomotion that are told apart (Eom et al. 2014, section 5.4 and figure 4): a step
// lasts from when its foot leaves the floor until the other one does; both feet that leave the
// floor at once jump; standing is before the first step, after the last, and between jumps.
enum class Phase : int { standing, left_step, right_step, jump };
inline constexpr int kNumPhases = 4;

std::string_view name_of(Phase phase);

// The phase of each frame, from which feet stand (2 x frames, as foot_contacts). Stands and swings
// of less than 0.1 s are overlooked.
std::vector<Phase> phases_of(const Eigen::Matrix2Xd& contacts, double rate_hz);

// How often a foot leaves the floor.
int num_steps(const Eigen::Matrix2Xd& contacts, double rate_hz);

}  // namespace sparse_mocap::eom2014
