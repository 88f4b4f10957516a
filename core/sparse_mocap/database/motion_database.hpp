// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sparse_mocap/base/mapped_file.hpp"
#include "sparse_mocap/database/clip.hpp"
#include "sparse_mocap/database/rows_view.hpp"
#include "sparse_mocap/database/safetensors.hpp"
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

  int num_frames() const { return static_cast<int>(angles_.rows()); }
  double rate_hz() const { return rate_hz_; }
  double frame_time_s() const { return 1.0 / rate_hz_; }
  const Skeleton& skeleton() const { return skeleton_; }
  const std::vector<Clip>& clips() const { return clips_; }
  const SourceRecord& sources() const { return sources_; }
  const std::vector<std::string>& site_names() const { return site_names_; }
  const std::filesystem::path& path() const { return path_; }
  const std::string& build_info() const { return build_info_; }  // JSON

  const FloatRows& angles() const { return angles_; }            // rad, root without heading
  const FloatRows& positions() const { return positions_; }      // m, heading frame, 3 x joints
  const FloatRows& root_motion() const { return root_motion_; }  // see root_motion_column
  const FloatRows& contacts() const { return contacts_; }        // left, right: 0 or 1
  // Three columns a site, in the order of site_names.
  const FloatRows& specific_force_pivot() const { return specific_force_pivot_; }  // m/s^2
  const FloatRows& specific_force_end() const { return specific_force_end_; }      // m/s^2
  const FloatRows& angular_velocity() const { return angular_velocity_; }          // rad/s
  // Unit vectors against gravity (up), in the sensor's axes; the array "up" of the file.
  const FloatRows& gravity_direction() const { return gravity_direction_; }
  int clip_index(int frame) const { return clip_index_(frame, 0); }

  // What methods learned and keep here, sorted by the methods' names.
  const std::vector<std::string>& model_names() const { return model_names_; }
  // The model of a method. Throws FormatError when there is none or it is not sound.
  Model model(const std::string& method) const;
  // Throws FormatError when there is none.
  void require_model(const std::string& method) const;

  // What the file holds beside all this: models, and whatever other programs or later versions put
  // there. Views of bytes().
  const SafetensorsView& further() const { return further_; }
  const std::shared_ptr<const Bytes>& bytes() const { return bytes_; }

 private:
  MotionDatabase() = default;
  friend class DatabaseReader;

  std::shared_ptr<const Bytes> bytes_;
  std::filesystem::path path_;
  double rate_hz_ = 0.0;
  Skeleton skeleton_;
  std::vector<Clip> clips_;
  SourceRecord sources_;
  std::vector<std::string> site_names_;
  std::string build_info_;
  FloatRows angles_{nullptr, 0, 0};
  FloatRows positions_{nullptr, 0, 0};
  FloatRows root_motion_{nullptr, 0, 0};
  FloatRows contacts_{nullptr, 0, 0};
  FloatRows specific_force_pivot_{nullptr, 0, 0};
  FloatRows specific_force_end_{nullptr, 0, 0};
  FloatRows angular_velocity_{nullptr, 0, 0};
  FloatRows gravity_direction_{nullptr, 0, 0};
  RowsView<std::int32_t> clip_index_{nullptr, 0, 0};
  std::vector<std::string> model_names_;
  SafetensorsView further_;
};

}  // namespace sparse_mocap
