// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/method.hpp"

#include "sparse_mocap/path_regression/config.hpp"
#include "sparse_mocap/path_regression/live.hpp"
#include "sparse_mocap/path_regression/whole_take.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::path_regression {

MethodEntry method() {
  MethodEntry entry;
  entry.info.name = "path_regression";
  entry.info.title = "Path regression";
  entry.info.summary =
      "The method of this project: paths through the database, and a regression from readings to "
      "poses along them.";
  entry.info.presets = presets();
  entry.info.options = options().described(live_config());
  entry.info.required_channels = Channel::specific_force;
  entry.info.optional_channels =
      Channel::gravity_direction | Channel::angular_velocity | Channel::orientation;
  entry.info.most_sensors = static_cast<int>(all_sites().size());
  entry.info.needs_database = true;
  entry.make_live = [](const MethodSettings& settings,
                       const MethodContext& context) -> std::unique_ptr<LiveMethod> {
    return std::make_unique<LiveReconstructor>(live_config(settings), context);
  };
  entry.make_whole_take = [](const MethodSettings& settings,
                             const MethodContext& context) -> std::unique_ptr<WholeTakeMethod> {
    return std::make_unique<WholeTakeReconstructor>(whole_take_config(settings), context);
  };
  return entry;
}

}  // namespace sparse_mocap::path_regression
