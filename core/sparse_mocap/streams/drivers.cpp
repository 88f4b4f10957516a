// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/streams/drivers.hpp"

#include <array>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/nearest_name.hpp"
#include "sparse_mocap/base/text_scanner.hpp"
#include "sparse_mocap/streams/slimevr.hpp"
#include "sparse_mocap/streams/text_line.hpp"
#include "sparse_mocap/streams/witmotion.hpp"
#include "sparse_mocap/streams/ximu3.hpp"
#include "sparse_mocap/streams/xsens_mt.hpp"

namespace sparse_mocap::streams {
namespace {

using Commands = std::vector<Bytes> (*)(const Options&);

struct Driver {
  std::string_view name;
  std::vector<OptionSpec> (*options)();
  std::unique_ptr<StreamParser> (*make_parser)(const Options&);
  std::unique_ptr<StreamEncoder> (*make_encoder)(const Options&, const std::vector<std::string>&);
  Commands start;
  Commands keep_alive;
};

std::vector<Bytes> nothing(const Options&) { return {}; }

template <typename Parser>
Driver driver(std::string_view name, Commands start, Commands keep_alive = nothing) {
  const auto make = [](const Options& options) -> std::unique_ptr<StreamParser> {
    return std::make_unique<Parser>(options);
  };
  return {name, Parser::options, make, Parser::make_encoder, start, keep_alive};
}

const auto& drivers() {
  static const std::array list{
      driver<xsens::Parser>("xsens_mt", xsens::Parser::start_commands),
      driver<witmotion::Parser>("witmotion", witmotion::Parser::start_commands),
      driver<witmotion::BleParser>("witmotion_ble", witmotion::BleParser::start_commands),
      driver<ximu3::Parser>("ximu3", ximu3::Parser::start_commands),
      driver<text_line::Parser>("text_line", text_line::Parser::start_commands),
      driver<slimevr::Parser>("slimevr", nothing, slimevr::Parser::keep_alive),
  };
  return list;
}

const Driver& find(std::string_view name) {
  for (const auto& driver : drivers())
    if (driver.name == name) return driver;
  const auto names = driver_names();
  throw ConfigError("unknown driver " + in_quotes(name) + "; the nearest is '" +
                    std::string(nearest_name(name, names)) + "'");
}

Options checked(const Driver& driver, const OptionMap& given) {
  Options options(driver.name, driver.options(), given);
  driver.make_parser(options);  // checks every value
  return options;
}

}  // namespace

std::vector<std::string_view> driver_names() {
  std::vector<std::string_view> names;
  for (const auto& driver : drivers()) names.push_back(driver.name);
  return names;
}

std::vector<OptionSpec> driver_options(std::string_view driver) { return find(driver).options(); }

std::unique_ptr<StreamParser> make_parser(std::string_view driver, const OptionMap& options) {
  const auto& found = find(driver);
  return found.make_parser(checked(found, options));
}

std::vector<Bytes> start_commands(std::string_view driver, const OptionMap& options) {
  const auto& found = find(driver);
  return found.start(checked(found, options));
}

std::vector<Bytes> keep_alive_commands(std::string_view driver, const OptionMap& options) {
  const auto& found = find(driver);
  return found.keep_alive(checked(found, options));
}

std::unique_ptr<StreamEncoder> make_encoder(std::string_view driver, const OptionMap& options,
                                            const std::vector<std::string>& sensors) {
  if (sensors.empty()) throw ConfigError("an emulator needs at least one sensor");
  const auto& found = find(driver);
  return found.make_encoder(checked(found, options), sensors);
}

}  // namespace sparse_mocap::streams
