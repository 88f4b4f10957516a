// SPDX-License-Identifier: GPL-3.0-or-later
#include "fuzz/streams.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "sparse_mocap/streams/drivers.hpp"

namespace sparse_mocap::fuzz {
namespace {

using namespace streams;

bool is_absent_or_within(const Eigen::Ref<const Eigen::VectorXd>& value, double limit) {
  return value.array().isNaN().all() || (value.allFinite() && value.cwiseAbs().maxCoeff() <= limit);
}

std::string fault_of(const std::vector<Sample>& samples, std::size_t num_sensors,
                     bool has_one_clock) {
  std::map<int, double> newest;
  for (const auto& sample : samples) {
    if (sample.sensor < 0 || sample.sensor >= static_cast<int>(num_sensors))
      return "no such sensor";
    if (!is_absent_or_within(sample.specific_force, 1e4)) return "specific force";
    if (!is_absent_or_within(sample.angular_velocity, 1e3)) return "angular velocity";
    if (!is_absent_or_within(sample.orientation, 1.0 + 1e-12)) return "orientation";
    if (std::isnan(sample.time_s) || !has_one_clock) continue;
    const auto [last, is_first] = newest.try_emplace(sample.sensor, sample.time_s);
    if (!is_first && sample.time_s < last->second) return "time goes back";
    last->second = sample.time_s;
  }
  return "";
}

bool same(const Sample& a, const Sample& b) {
  return a.sensor == b.sensor && a.counter == b.counter && a.flags == b.flags &&
         (a.time_s == b.time_s || (std::isnan(a.time_s) && std::isnan(b.time_s))) &&
         ((a.specific_force - b.specific_force).norm() == 0.0 ||
          a.specific_force.array().isNaN().all());
}

}  // namespace

const std::vector<StreamSetting>& stream_settings() {
  static const std::vector<StreamSetting> settings{
      {"xsens_mt", {}},
      {"xsens_mt", {{"output_mode", "0x0006"}, {"output_settings", "1"}}},
      {"witmotion", {}},
      {"witmotion_ble", {}},
      {"ximu3", {}},
      {"text_line", {{"columns", "time,ax,ay,az,gx,gy,gz,qw,qx,qy,qz"}}},
      {"text_line", {{"columns", "header"}}},
      {"slimevr", {}},
  };
  return settings;
}

std::string try_streams(std::string_view input) {
  if (input.size() < 2) return "";
  const auto byte = [&](std::size_t at) { return static_cast<std::uint8_t>(input[at]); };
  const auto& setting = stream_settings()[byte(0) % stream_settings().size()];
  const std::size_t piece = 1 + byte(1);
  const ByteView bytes(reinterpret_cast<const std::uint8_t*>(input.data()) + 2, input.size() - 2);
  const auto whole = make_parser(setting.driver, setting.options);
  std::vector<Sample> samples, again;
  whole->feed(bytes, samples);
  const bool has_one_clock = setting.driver != "xsens_mt";
  auto fault = fault_of(samples, whole->sensor_names().size(), has_one_clock);
  if (!fault.empty()) return setting.driver + ": " + fault;
  const auto cut = make_parser(setting.driver, setting.options);
  for (std::size_t at = 0; at < bytes.size(); at += piece)
    cut->feed(bytes.subspan(at, std::min(piece, bytes.size() - at)), again);
  if (cut->counters() != whole->counters()) return setting.driver + ": counters by pieces differ";
  if (!std::ranges::equal(samples, again, same))
    return setting.driver + ": samples by pieces differ";
  return "";
}

}  // namespace sparse_mocap::fuzz
