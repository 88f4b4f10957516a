// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "sparse_mocap/database/clip.hpp"

namespace sparse_mocap {

// What describes a clip, and a kind of source skeleton, as JSON; texts need not be UTF-8. Reading
// throws nlohmann::json::exception where something is missing or of another type.
nlohmann::json clip_json(const Clip& clip);
Clip clip_from(const nlohmann::json& entry);

nlohmann::json source_skeleton_json(const SourceSkeleton& skeleton);
SourceSkeleton source_skeleton_from(const nlohmann::json& entry);

}  // namespace sparse_mocap
