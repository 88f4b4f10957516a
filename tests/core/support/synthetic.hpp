// SPDX-License-Identifier: GPL-3.0-or-later
//
// Made-up bodies, movements and databases that tests and benchmarks share.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sparse_mocap/database/database_content.hpp"
#include "sparse_mocap/motion/motion.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"
#include "sparse_mocap/readings/reading.hpp"
#include "support/random.hpp"

namespace sparse_mocap::testing {

Skeleton template_skeleton();

// A motion of a standard skeleton that stands still in rest pose, its root at height_m.
Motion resting_motion(const Skeleton& skeleton, int frames, double rate_hz, double height_m = 0.9);

// A smooth movement of all joints while the body walks and turns; seeds differ in pace and pose.
Motion swaying_motion(const Skeleton& skeleton, unsigned seed, int frames, double rate_hz);

// The database of motions on one standard skeleton, as the builder would make it, and its bytes.
DatabaseContent content_of(const std::vector<Motion>& motions, double rate_hz);
// Changes the rows of a clip as if its motion had given others.
template <typename Change>
void change_rows(DatabaseContent& content, std::size_t clip, const Change& change) {
  DatabaseRows rows = unpacked(content.clip_rows[clip]);
  change(rows);
  content.clip_rows[clip] = packed(rows);
}

std::shared_ptr<const MotionDatabase> database_of(const DatabaseContent& content);
std::shared_ptr<const MotionDatabase> database_of(const std::vector<Motion>& motions,
                                                  double rate_hz = 25.0);

// left_wrist, right_wrist, left_ankle, right_ankle at the ends of their bones.
std::vector<Sensor> paper_sensors();

// What the database's own virtual sensors read in one of its clips, which begins at the origin: the
// sensors' channels.
std::vector<Reading> readings_of(const MotionDatabase& database, int clip,
                                 const std::vector<Sensor>& sensors);

}  // namespace sparse_mocap::testing
