// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sparse_mocap/base/text_scanner.hpp"
#include "sparse_mocap/formats/motion_file.hpp"

namespace sparse_mocap {

// Shared by the readers of motion files.

// A length or position beyond this means that the file is broken.
inline constexpr double kMaxLength_m = 1e5;

// q followed, in its own frame, by a turn about one axis: q * (axis, angle).
Quat turned_about(const Quat& q, Axis axis, double angle_rad);

// Records a warning, or counts it with the one of its kind: texts that differ only in what is
// quoted and in numbers are of one kind.
void add_warning(std::vector<ReadWarning>& warnings, const FileLocation& location,
                 const std::string& text);

// The next token as a length of a file whose unit is unit_m, in metres.
double length_m(TextScanner& scanner, std::string_view what, double unit_m);
Vec3 lengths_m(TextScanner& scanner, std::string_view what, double unit_m);

// A number with three digits, for messages.
std::string short_number(double value);

// The name with bytes that are not UTF-8 written as \x and two digits.
std::string escaped_to_utf8(std::string_view name);

// The name that stands at the token, with bytes that are not UTF-8 escaped (recorded as a warning).
// Throws FormatError when it is longer than 255 bytes.
std::string checked_name(const TextScanner& scanner, std::string_view token, std::string_view name,
                         std::vector<ReadWarning>& warnings);

enum class NameCase { counts, ignored };

// The names with a suffix (_2, _3, ...) at each repetition; distinct names stay as they are.
std::vector<std::string> unique_names(std::vector<std::string> names,
                                      NameCase name_case = NameCase::counts);

// Warns when a figure in this pose is far from human size.
void warn_about_size(const JointTransforms& pose, const FileLocation& location,
                     std::vector<ReadWarning>& warnings);

// The rotation from the given up axis to y up.
Quat rotation_to_y(Axis up);

// The same movement with lengths and world axes changed: every frame of the skeleton turns along.
void change_world(Motion& motion, double factor, const Quat& R_new_old);

// The whole text of a motion file, without the 0x1A and zero bytes that some programs put at the
// end. Throws FormatError, also for files of other formats that bear this one's name: it says which
// and what to do.
std::string read_motion_text(const std::filesystem::path& path, const ReadOptions& options);

// The largest number of frames that the options allow for num_joints joints.
int max_frames_of(int num_joints, const ReadOptions& options);

}  // namespace sparse_mocap
