// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/streams/stream_parser.hpp"

#include <cmath>
#include <utility>

#include "sparse_mocap/base/text_scanner.hpp"

namespace sparse_mocap::streams {
namespace {

constexpr double kLargestForce_mps2 = 1e4;  // as in a take file
constexpr double kFastestTurn_radps = 1e3;
constexpr double kMostOffUnit = 0.1;
constexpr std::size_t kLongestText = 200;
constexpr std::size_t kMostReplies = 64;

// Absent as a whole, or finite and within the limit as a whole.
bool is_plausible(const Vec3& value, double limit) {
  return value.array().isNaN().all() || (value.allFinite() && value.cwiseAbs().maxCoeff() <= limit);
}

bool is_plausible(const Sample& sample) {
  const bool turns = sample.orientation.array().isNaN().all() ||
                     std::abs(sample.orientation.norm() - 1.0) <= kMostOffUnit;
  return turns && is_plausible(sample.specific_force, kLargestForce_mps2) &&
         is_plausible(sample.angular_velocity, kFastestTurn_radps);
}

// Devices' texts are shown in terminals and user interfaces.
std::string printable(std::string_view text) {
  std::string clean;
  for (const char c : text.substr(0, kLongestText)) clean += (c >= ' ' && c <= '~') ? c : '?';
  return clean;
}

}  // namespace

void StreamParser::feed(ByteView bytes, std::vector<Sample>& samples) {
  samples_ = &samples;
  parse(bytes);
  samples_ = nullptr;
}

void StreamParser::feed_datagram(ByteView datagram, std::string_view sender,
                                 std::vector<Sample>& samples) {
  samples_ = &samples;
  parse_datagram(datagram, sender);
  samples_ = nullptr;
}

void StreamParser::parse_datagram(ByteView datagram, std::string_view) { parse(datagram); }

void StreamParser::reset() {
  replies_.clear();
  restart();
}

std::vector<Bytes> StreamParser::pop_replies() { return std::exchange(replies_, {}); }

int StreamParser::add_sensor(const std::string& name, const std::string& id) {
  if (sensor_names_.size() == kMostSensors) {
    ++count(Count::too_many_sensors);
    return -1;
  }
  sensor_names_.push_back(printable(name));
  sensor_ids_.push_back(printable(id));
  sensor_batteries_.push_back(kAbsent);
  return static_cast<int>(sensor_names_.size()) - 1;
}

void StreamParser::rename_sensor(int sensor, const std::string& name, const std::string& id) {
  sensor_names_[static_cast<std::size_t>(sensor)] = printable(name);
  sensor_ids_[static_cast<std::size_t>(sensor)] = printable(id);
}

void StreamParser::set_battery(int sensor, double percent) {
  if (percent >= 0.0 && percent <= 100.0)
    sensor_batteries_[static_cast<std::size_t>(sensor)] = percent;
}

void StreamParser::emit(const Sample& sample) {
  if (!is_plausible(sample)) {
    ++count(Count::implausible);
    return;
  }
  ++count(Count::samples);
  samples_->push_back(sample);
  if (sample.has_orientation()) samples_->back().orientation.normalize();
}

void StreamParser::set_message(std::string_view message) { last_message_ = printable(message); }

void StreamParser::reply(Bytes bytes) {
  if (replies_.size() < kMostReplies) replies_.push_back(std::move(bytes));
}

}  // namespace sparse_mocap::streams
