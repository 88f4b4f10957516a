// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "sparse_mocap/formats/motion_file.hpp"

namespace sparse_mocap {

// Reads a Biovision hierarchy file. Joint rotations follow the file's own channel order; an End
// Site becomes the bone of its joint when it is the only child, otherwise it is dropped.
// Throws FormatError with line and column.
MotionFile read_bvh(const std::filesystem::path& path, const ReadOptions& options = {});
// The same on text that is (or will be) such a file; path is for messages.
MotionFile bvh_from_text(std::string text, const std::filesystem::path& path,
                         const ReadOptions& options = {});

// Writes any motion as BVH in centimetres with ZYX channels (degrees), also one whose joints have
// bones (Acclaim): every joint is written at its pivot, bones become offsets of the children and
// End Sites. Atomic; throws std::filesystem_error.
void write_bvh(const std::filesystem::path& path, const Motion& motion);

}  // namespace sparse_mocap
