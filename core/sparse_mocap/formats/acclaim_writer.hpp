// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "sparse_mocap/motion/motion.hpp"

namespace sparse_mocap {

// Writes any motion as Acclaim: amc_path, and beside it the skeleton under the same name with .asf.
// Units as in the files of HDM05 and CMU: inches / 0.45 and degrees.
//
// A skeleton read from Acclaim comes back as it was: bones, axes and degrees of freedom. Otherwise:
// - The root is called "root", as the format wants it; a bone of the root becomes the fixed bone
//   "root_bone".
// - Each joint is a bone. One without a length of its own, as BVH has them, reaches to its first
//   child that lies elsewhere. What offset then remains between a joint and the end of its parent's
//   bone, which Acclaim does not know, becomes a fixed bone before the joint, "<joint>_offset".
//   The joints' pivots stay where they are.
// - A joint that moves (an offset track) has tx ty tz as well; many readers ignore those.
// - A joint that turns otherwise than its axes allow has rx ry rz.
// - Names get '_' for what separates words in the format, and a number where only case tells them
//   apart.
//
// Each of the two files is replaced atomically, the skeleton first. Throws FormatError, before
// anything is written, when the motion has no joint, a frame time outside 0.0001 to 1 s, a rotation
// or a length that is not finite, or a length beyond 100 km; std::filesystem_error when writing
// fails.
void write_acclaim(const std::filesystem::path& amc_path, const Motion& motion);

}  // namespace sparse_mocap
