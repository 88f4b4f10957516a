// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/methods/registry.hpp"

#include <array>
#include <string>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/tautges2011/reconstructor.hpp"

namespace sparse_mocap {
namespace {

struct Entry {
  std::string_view name;
  std::vector<std::string_view> (*presets)();
  std::unique_ptr<Method> (*make)(std::string_view preset,
                                  std::shared_ptr<const MotionDatabase> database,
                                  const std::vector<WornSensor>& sensors,
                                  const std::vector<int>& excluded_clips);
};

template <typename Reconstructor, auto preset_of>
std::unique_ptr<Method> make(std::string_view preset,
                             std::shared_ptr<const MotionDatabase> database,
                             const std::vector<WornSensor>& sensors,
                             const std::vector<int>& excluded_clips) {
  return std::make_unique<Reconstructor>(std::move(database), sensors, preset_of(preset),
                                         excluded_clips);
}

const std::vector<Entry>& entries() {
  static const std::vector<Entry> list{
      {"tautges2011", [] { return tautges2011::preset_names(); },
       make<tautges2011::Reconstructor, tautges2011::preset>},
  };
  return list;
}

const Entry& find(std::string_view method) {
  std::string known;
  for (const auto& entry : entries()) {
    if (entry.name == method) return entry;
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw ConfigError("unknown method '" + std::string(method) + "'; known are " + known);
}

}  // namespace

std::vector<std::string_view> method_names() {
  std::vector<std::string_view> names;
  for (const auto& entry : entries()) names.push_back(entry.name);
  return names;
}

std::vector<std::string_view> method_presets(std::string_view method) {
  return find(method).presets();
}

std::unique_ptr<Method> make_method(std::string_view method, std::string_view preset,
                                    std::shared_ptr<const MotionDatabase> database,
                                    const std::vector<WornSensor>& sensors,
                                    const std::vector<int>& excluded_clips) {
  return find(method).make(preset, std::move(database), sensors, excluded_clips);
}

}  // namespace sparse_mocap
