// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "sparse_mocap/streams/options.hpp"
#include "sparse_mocap/streams/stream_parser.hpp"

namespace sparse_mocap::streams {

// The devices' protocols by name: xsens_mt, witmotion, witmotion_ble, ximu3, text_line, slimevr.
// A new one is one line in drivers.cpp. All functions throw ConfigError for an unknown driver or
// option (naming the nearest) and for values outside their range.
std::vector<std::string_view> driver_names();
std::vector<OptionSpec> driver_options(std::string_view driver);

std::unique_ptr<StreamParser> make_parser(std::string_view driver, const OptionMap& options = {});

// The commands that make the device stream, to be sent in this order.
std::vector<Bytes> start_commands(std::string_view driver, const OptionMap& options = {});
// What must be sent every second so that the device keeps streaming; usually nothing.
std::vector<Bytes> keep_alive_commands(std::string_view driver, const OptionMap& options = {});

// Throws ConfigError also when the driver cannot have that many sensors.
std::unique_ptr<StreamEncoder> make_encoder(std::string_view driver, const OptionMap& options,
                                            const std::vector<std::string>& sensors);

}  // namespace sparse_mocap::streams
