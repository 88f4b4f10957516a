// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/invariants.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <string_view>

namespace sparse_mocap::testing {
namespace {

constexpr double kLongest_m = 1.01e6;  // of anything that a file may state, and sums of a few
constexpr double kExact = 1e-9;

// Collects what does not hold.
class Checks {
 public:
  void require(bool holds, const std::string& what) {
    if (!holds) violations_.push_back(what);
  }
  Violations take() { return std::move(violations_); }

 private:
  Violations violations_;
};

bool is_place(const Vec3& v) { return v.allFinite() && v.cwiseAbs().maxCoeff() < kLongest_m; }

bool is_frame(const Mat3& R) {
  return R.allFinite() && (R * R.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < kExact &&
         R.determinant() > 0.0;
}

// By the table of well-formed byte sequences of the Unicode standard (table 3-7).
bool is_utf8(std::string_view text) {
  const auto at = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const auto within = [&](std::size_t i, unsigned low, unsigned high) {
    return at(i) >= low && at(i) <= high;
  };
  for (std::size_t i = 0; i < text.size();) {
    const unsigned lead = at(i);
    std::size_t length = 0;
    if (lead > 0 && lead < 0x80) length = 1;
    if (within(i, 0xC2, 0xDF) && within(i + 1, 0x80, 0xBF)) length = 2;
    const unsigned low = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
    const unsigned high = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
    const bool second = within(i + 1, low, high) && within(i + 2, 0x80, 0xBF);
    if (within(i, 0xE0, 0xEF) && second) length = 3;
    if (within(i, 0xF0, 0xF4) && second && within(i + 3, 0x80, 0xBF)) length = 4;
    if (length == 0) return false;
    i += length;
  }
  return true;
}

void check_joint(const Skeleton& skeleton, int index, std::set<std::string>& names,
                 Checks& checks) {
  const Joint& joint = skeleton.joint(index);
  const std::string which = "joint " + std::to_string(index) + ": ";
  checks.require(!joint.name.empty() && is_utf8(joint.name), which + "its name is not text");
  checks.require(names.insert(joint.name).second, which + "its name is another joint's");
  checks.require(index == 0 ? joint.parent == -1 : joint.parent >= 0 && joint.parent < index,
                 which + "its parent does not precede it");
  checks.require(is_place(joint.offset_parent) && is_place(joint.bone),
                 which + "a length is not finite or absurd");
  checks.require(is_frame(joint.R_joint_axes), which + "its axes are not a right-handed frame");
  std::set<Axis> axes(joint.axes.begin(), joint.axes.end());
  checks.require(axes.size() == joint.axes.size(), which + "it turns twice about an axis");
}

void append(Violations& all, Violations more) {
  for (auto& line : more) all.push_back(std::move(line));
}

}  // namespace

Violations check_skeleton(const Skeleton& skeleton) {
  Checks checks;
  std::set<std::string> names;
  int num_angles = 0;
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    check_joint(skeleton, j, names, checks);
    checks.require(skeleton.angle_begin(j) == num_angles, "the angles are not one after another");
    num_angles += static_cast<int>(skeleton.joint(j).axes.size());
  }
  checks.require(skeleton.num_joints() > 0, "there are no joints");
  checks.require(skeleton.num_angles() == num_angles, "the angles are miscounted");
  return checks.take();
}

Violations check_motion(const Motion& motion) {
  auto violations = check_skeleton(motion.skeleton);
  Checks checks;
  const auto frames = motion.root_positions.size();
  const auto joints = static_cast<std::size_t>(motion.skeleton.num_joints());
  checks.require(motion.frame_time_s >= 1e-4 * (1.0 - kExact) && motion.frame_time_s <= 1.0,
                 "the frame time is out of range");
  checks.require(motion.rotations.size() == frames * joints,
                 "there is not one rotation a frame and joint");
  checks.require(std::ranges::all_of(motion.root_positions, is_place), "the root is nowhere");
  const auto is_unit = [](const Quat& q) { return std::abs(q.norm() - 1.0) < kExact; };
  checks.require(std::ranges::all_of(motion.rotations, is_unit), "a quaternion is not of length 1");
  std::set<int> moving;
  for (const auto& track : motion.offset_tracks) {
    checks.require(track.joint > 0 && track.joint < motion.skeleton.num_joints(),
                   "an offset track is of no joint, or of the root");
    checks.require(moving.insert(track.joint).second, "a joint has two offset tracks");
    checks.require(track.offset_parent.size() == frames, "an offset track is not one row a frame");
    checks.require(std::ranges::all_of(track.offset_parent, is_place), "a joint moves nowhere");
  }
  append(violations, checks.take());
  if (!violations.empty() || frames == 0) return violations;
  for (const int frame : {0, motion.num_frames() - 1}) {
    const auto pose = motion.transforms(frame);
    for (std::size_t j = 0; j < joints; ++j)
      checks.require(
          pose.pivot[j].allFinite() && pose.end[j].allFinite() && pose.R_world_joint[j].allFinite(),
          "a joint is nowhere in frame " + std::to_string(frame));
  }
  return checks.take();
}

Violations check_database(const MotionDatabase& database) {
  auto violations = check_skeleton(database.skeleton());
  Checks checks;
  const auto frames = static_cast<Eigen::Index>(database.num_frames());
  checks.require(frames > 0, "there are no frames");
  checks.require(database.rate_hz() >= 1.0 && database.rate_hz() <= 1000.0, "the rate is odd");
  checks.require(!database.site_names().empty(), "there are no sites");
  const auto check_rows = [&](const char* name, const auto& rows, Eigen::Index columns) {
    checks.require(rows.rows() == frames && rows.cols() == columns,
                   std::string(name) + " has another size");
  };
  const auto check_scaled = [&](const char* name, const ScaledRows& rows, Eigen::Index columns) {
    check_rows(name, rows, columns);
    checks.require(rows.all().allFinite(), std::string(name) + " has a value that is not finite");
  };
  check_scaled("angles", database.angles(), database.skeleton().num_angles());
  check_scaled("positions", database.positions(), 3 * database.skeleton().num_joints());
  check_rows("root_motion", database.root_motion(), root_motion_column::count);
  checks.require(database.root_motion().allFinite(), "root_motion has a value that is not finite");
  check_rows("contacts", database.contacts(), 2);
  checks.require((database.contacts().array() <= 1).all(), "a contact is neither 0 nor 1");
  for (std::size_t s = 0; s < database.site_names().size(); ++s) {
    const SiteRows& site = database.site(s);
    check_scaled("specific_force_pivot", site.specific_force_pivot, 3);
    check_scaled("specific_force_end", site.specific_force_end, 3);
    check_scaled("angular_velocity", site.angular_velocity, 3);
    check_scaled("up", site.gravity_direction, 3);
    const Eigen::ArrayXf lengths = site.gravity_direction.all().rowwise().norm();
    checks.require(((lengths - 1.0F).abs() < 2e-3F).all(), "a direction has not unit length");
    if (site.orientation.rows() == 0) continue;
    check_scaled("orientation", site.orientation, 4);
    const Eigen::ArrayXf turns = site.orientation.all().rowwise().norm();
    checks.require((turns == 0.0F || (turns - 1.0F).abs() < 2e-3F).all(),
                   "an orientation has not unit length");
  }
  int frame = 0;
  for (std::size_t c = 0; c < database.clips().size(); ++c) {
    const Clip& clip = database.clips()[c];
    checks.require(clip.begin == frame && clip.end > clip.begin, "the clips leave a gap");
    checks.require(std::isfinite(clip.tempo) && clip.tempo > 0.0, "a clip's tempo is not positive");
    for (; frame < std::min(clip.end, database.num_frames()); ++frame)
      checks.require(database.clip_index(frame) == static_cast<int>(c), "a frame is of no clip");
  }
  checks.require(frame == database.num_frames(), "the clips do not cover the frames");
  append(violations, checks.take());
  return violations;
}

std::string joined(const Violations& violations) {
  std::string line;
  for (const auto& violation : violations) line += (line.empty() ? "" : "; ") + violation;
  return line;
}

}  // namespace sparse_mocap::testing
