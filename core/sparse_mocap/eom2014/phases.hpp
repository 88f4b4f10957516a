// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "sparse_mocap/reconstruction/method_info.hpp"

namespace sparse_mocap::eom2014 {

// The parts of locomotion that are told apart (Eom et al. 2014, section 5.4 and figure 4): a step
// lasts from when its foot leaves the floor until the other one does; both feet that leave the
// floor at once jump; standing is before the first step, after the last, and between jumps. The
// step out of standing is the start, the one into it the stop.
enum class Phase : int { standing, left_step, right_step, jump, start, stop };
inline constexpr int kNumPhases = 6;

std::string_view name_of(Phase phase);

// The phase of each frame, from which feet stand (2 x frames, as foot_contacts). Stands and swings
// of less than 0.1 s are overlooked.
std::vector<Phase> phases_of(const Eigen::Matrix2Xd& contacts, double rate_hz);

// How often a foot leaves the floor.
int num_steps(const Eigen::Matrix2Xd& contacts, double rate_hz);

// Where phases begin, as people read and change them.
std::vector<Segment> segments_of(const std::vector<Phase>& phases, double rate_hz);
// The phase of each frame. Throws ConfigError, which names the clip, for segments with other names,
// that do not begin at 0 s or are not in order.
std::vector<Phase> phases_from(const std::vector<Segment>& segments, Eigen::Index num_frames,
                               double rate_hz, const std::string& clip);

}  // namespace sparse_mocap::eom2014
