// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/reconstruction/method.hpp"

namespace sparse_mocap {

// The methods by name; a new one is one line in registry.cpp.
std::vector<std::string_view> method_names();

// Presets of a method, the default first. Throws ConfigError for an unknown name.
std::vector<std::string_view> method_presets(std::string_view method);

// A fresh reconstruction. Clips in excluded_clips are never retrieved. Throws ConfigError.
std::unique_ptr<Method> make_method(std::string_view method, std::string_view preset,
                                    std::shared_ptr<const MotionDatabase> database,
                                    const std::vector<WornSensor>& sensors,
                                    const std::vector<int>& excluded_clips = {});

}  // namespace sparse_mocap
