// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/readings/channel_names.hpp"

#include <string>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap {

const std::vector<Channel>& all_channels() {
  static const std::vector<Channel> channels{Channel::specific_force, Channel::angular_velocity,
                                             Channel::gravity_direction, Channel::orientation,
                                             Channel::position};
  return channels;
}

std::string_view name_of(Channel channel) {
  switch (channel) {
    case Channel::specific_force:
      return "specific_force";
    case Channel::angular_velocity:
      return "angular_velocity";
    case Channel::gravity_direction:
      return "gravity_direction";
    case Channel::orientation:
      return "orientation";
    case Channel::position:
      return "position";
  }
  return "";
}

Channel find_channel(std::string_view name) {
  std::string known;
  for (const Channel channel : all_channels()) {
    if (name_of(channel) == name) return channel;
    known += (known.empty() ? "" : ", ") + std::string(name_of(channel));
  }
  throw ConfigError("unknown channel '" + std::string(name) + "'; known are " + known);
}

std::vector<std::string_view> names_of(Channels channels) {
  std::vector<std::string_view> names;
  for (const Channel channel : all_channels())
    if (channels.has(channel)) names.push_back(name_of(channel));
  return names;
}

}  // namespace sparse_mocap
