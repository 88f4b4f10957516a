// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sparse_mocap/base/mapped_file.hpp"
#include "sparse_mocap/database/clip.hpp"
#include "sparse_mocap/database/database_metadata.hpp"
#include "sparse_mocap/database/rows_view.hpp"
#include "sparse_mocap/database/safetensors.hpp"
#include "sparse_mocap/database/sections.hpp"
#include "sparse_mocap/motion/skeleton.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap {

struct Model;

// Columns of root_motion.
namespace root_motion_column {
inline constexpr int velocity_left = 0;     // m/s, in the heading frame
inline constexpr int velocity_forward = 1;  // m/s, in the heading frame
inline constexpr int yaw_rate = 2;          // rad/s
inline constexpr int height = 3;            // m, root above the floor
inline constexpr int count = 4;
}  // namespace root_motion_column

// What the sensors of one site read, in their own axes; three columns each. Of the channels that a
// clip's take has (Clip::take) it is what real sensors measured, at both ends of the bone alike.
struct SiteRows {
  ScaledRows specific_force_pivot;  // m/s^2
  ScaledRows specific_force_end;    // m/s^2
  ScaledRows angular_velocity;      // rad/s
  ScaledRows gravity_direction;     // unit vectors against gravity; "up" in the file
  // R_heading_sensor, w x y z, where Clip::take has it; zero elsewhere. No rows where no clip has.
  ScaledRows orientation{};
};

// The knowledge base of Tautges et al. 2011, section 3, read-only: for each frame the pose, the
// joints' positions and what every virtual sensor reads. Immutable, so any number of threads may
// use one. Views live as long as the database.
class MotionDatabase {
 public:
  // Checks the whole file before use. Throws FormatError.
  static std::shared_ptr<const MotionDatabase> open(const std::filesystem::path& path);
  // The same on bytes that are (or will be) such a file; path is for messages.
  static std::shared_ptr<const MotionDatabase> from_bytes(std::shared_ptr<const Bytes> bytes,
                                                          const std::filesystem::path& path);

  int num_frames() const { return static_cast<int>(clip_of_row_.size()); }
  double rate_hz() const { return metadata_.rate_hz; }
  double frame_time_s() const { return 1.0 / metadata_.rate_hz; }
  const Skeleton& skeleton() const { return metadata_.skeleton; }
  const std::vector<Clip>& clips() const { return metadata_.clips; }
  const SourceRecord& sources() const { return metadata_.sources; }
  const std::vector<std::string>& site_names() const { return metadata_.site_names; }
  const std::filesystem::path& path() const { return path_; }
  const std::string& build_info() const { return metadata_.build_info; }  // JSON

  const ScaledRows& angles() const { return angles_; }           // rad, root without heading
  const ScaledRows& positions() const { return positions_; }     // m, heading frame, 3 x joints
  const FloatRows& root_motion() const { return root_motion_; }  // see root_motion_column
  const RowsView<std::uint8_t>& contacts() const { return contacts_; }  // left, right: 0 or 1
  // Rotation vectors of feet, toes and hands in their parents (rad), in the order of
  // extremity::Index, where Clip::has_extremity; zero elsewhere. No rows where no clip has any.
  const ScaledRows& extremities() const { return extremities_; }
  // What the sensors of a site read; index in site_names.
  const SiteRows& site(std::size_t index) const { return sites_[index]; }
  int clip_index(int frame) const { return clip_of_row_[static_cast<std::size_t>(frame)]; }

  // Tells these rows, their clips and skeleton from all others: XXH3, 16 hexadecimal digits.
  const std::string& rows_hash() const { return rows_hash_; }

  // What methods learned and keep here, sorted by the methods' names.
  const std::vector<std::string>& model_names() const { return model_names_; }
  // The model of a method. Throws FormatError when there is none or it is not sound.
  Model model(const std::string& method) const;
  // Throws FormatError when there is none.
  void require_model(const std::string& method) const;

  // The optional part of the file with this name, null when there is none, or it was made from
  // other rows than those that are there.
  const Section* section(const std::string& name) const;

  // What the file holds beside all this: models, sections, and whatever other programs or later
  // versions put there. Views of bytes().
  const SafetensorsView& further() const { return further_; }
  // The file, or what one of an older version was turned into.
  const std::shared_ptr<const Bytes>& bytes() const { return bytes_; }

 private:
  MotionDatabase() = default;
  friend class DatabaseReader;

  std::shared_ptr<const Bytes> bytes_;
  std::filesystem::path path_;
  DatabaseMetadata metadata_;
  std::vector<std::int32_t> clip_of_row_;
  ScaledRows angles_, positions_, extremities_;
  FloatRows root_motion_{nullptr, 0, 0};
  RowsView<std::uint8_t> contacts_{nullptr, 0, 0};
  std::vector<SiteRows> sites_;
  std::string rows_hash_;
  std::vector<std::string> model_names_;
  SafetensorsView further_;
  std::map<std::string, Section> sections_;
};

}  // namespace sparse_mocap
