// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sparse_mocap/reconstruction/method_info.hpp"

namespace sparse_mocap {

// All methods, the default first: those that core/CMakeLists.txt lists.
const std::vector<MethodEntry>& methods();

// Throws ConfigError naming the known methods.
const MethodEntry& find_method(std::string_view name);

// A reconstruction of one performance, within what people can do (HumanLimits). Throws ConfigError,
// in one line that says what is missing: a method that does not work this way, a database, model or
// body that it needs, sensors that are too few, too many or without a channel that it needs,
// settings that cannot be.
std::unique_ptr<LiveMethod> make_live_method(const MethodEntry& method,
                                             const MethodSettings& settings,
                                             const MethodContext& context);
std::unique_ptr<WholeTakeMethod> make_whole_take_method(const MethodEntry& method,
                                                        const MethodSettings& settings,
                                                        const MethodContext& context);

// What a method learns from clips. Throws ConfigError for methods that learn nothing.
Model train_model(const MethodEntry& method, const MethodSettings& settings,
                  const std::vector<TrainingClip>& clips, const Progress& progress);

// The parts that training divides a clip into, such as phases of a step. Throws ConfigError for
// methods that divide none, and for a clip that cannot be used.
std::vector<Segment> segments_of_clip(const MethodEntry& method, const MethodSettings& settings,
                                      const TrainingClip& clip);

}  // namespace sparse_mocap
