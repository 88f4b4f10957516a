// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/streams/ximu3.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/text_scanner.hpp"
#include "sparse_mocap/streams/orientation.hpp"
#include "sparse_mocap/streams/text_fields.hpp"
#include "sparse_mocap/streams/wire.hpp"

namespace sparse_mocap::streams::ximu3 {
namespace {

constexpr std::uint8_t kBinary = 0x80, kEnd = '\n', kEscape = 0xDB, kEscapedEnd = 0xDC,
                       kEscapedEscape = 0xDD;
constexpr std::uint64_t kLatest_us = std::uint64_t{1} << 53;    // 285 years
constexpr double kLargest_g = 400.0, kFastest_degps = 10000.0;  // twice what any x-IMU3 measures

// How many values a message of a type has.
struct Values {
  bool is_known = true;
  bool is_used = true;  // here
  std::size_t least = 0, most = 0;

  bool has(std::size_t count) const { return count == least || count == most; }
};

// Linear and earth acceleration came with a quaternion before them in earlier firmware.
Values values_of(char id) {
  switch (id) {
    case 'I':
      return {true, true, 6, 6};
    case 'Q':
      return {true, true, 4, 4};
    case 'R':
      return {true, true, 9, 9};
    case 'A':
      return {true, true, 3, 3};
    case 'B':
      return {true, true, 2, 3};
    case 'L':
    case 'E':
      return {true, true, 3, 7};
    case 'M':
    case 'H':
    case 'T':
    case 'W':
    case 'S':
    case 'Y':
      return {true, false, 0, 0};
    default:
      return {false, false, 0, 0};
  }
}

// Nothing when an escape sequence is invalid.
std::optional<Bytes> unescaped(ByteView message) {
  Bytes plain;
  for (std::size_t i = 0; i < message.size(); ++i) {
    if (message[i] != kEscape) {
      plain.push_back(message[i]);
      continue;
    }
    if (++i == message.size()) return std::nullopt;
    if (message[i] != kEscapedEnd && message[i] != kEscapedEscape) return std::nullopt;
    plain.push_back(message[i] == kEscapedEnd ? kEnd : kEscape);
  }
  return plain;
}

Bytes escaped(ByteView plain) {
  Bytes message;
  for (const auto byte : plain) {
    if (byte != kEnd && byte != kEscape) {
      message.push_back(byte);
    } else {
      message.push_back(kEscape);
      message.push_back(byte == kEnd ? kEscapedEnd : kEscapedEscape);
    }
  }
  return message;
}

Eigen::Vector4d orientation_of(char id, std::span<const double> v) {
  if (id == 'A') {
    const Vec3 rad = Vec3(v[0], v[1], v[2]) * kRadiansPerDegree;
    return orientation_from_z_up(from_roll_pitch_yaw(rad[0], rad[1], rad[2]));
  }
  if (id == 'R') {
    Mat3 R;
    R << v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8];
    return orientation_from_z_up(Quat(R));
  }
  return orientation_from_z_up(Quat(v[0], v[1], v[2], v[3]));
}

class Encoder : public StreamEncoder {
 public:
  Encoder(bool is_binary, std::string name) : is_binary_(is_binary), name_(std::move(name)) {}

  std::vector<Bytes> encode(std::span<const Sample> samples) override {
    Bytes out;
    for (const auto& sample : samples) {
      const double time_s = std::isfinite(sample.time_s) ? std::max(sample.time_s, 0.0) : 0.0;
      const auto time_us = static_cast<std::uint64_t>(std::llround(time_s * 1e6));
      const Vec3 w = sample.angular_velocity / kRadiansPerDegree;
      const Vec3 f = sample.specific_force / kStandardGravity_mps2;
      append_message(out, 'I', time_us, {w[0], w[1], w[2], f[0], f[1], f[2]});
      if (!sample.has_orientation()) continue;
      const Quat q = z_up_from_orientation(sample.orientation);
      append_message(out, 'Q', time_us, {q.w(), q.x(), q.y(), q.z()});
    }
    return {out};
  }

  Bytes respond(ByteView from_host) override {
    if (text_of(from_host).find("\"ping\"") == std::string_view::npos) return {};
    Bytes out;
    append_text(
        out, nlohmann::json{{"ping", {{"interface", "USB"}, {"name", name_}, {"sn", "00000000"}}}}
                 .dump());
    append_text(out, "\r\n");
    return out;
  }

 private:
  void append_message(Bytes& out, char id, std::uint64_t time_us,
                      std::initializer_list<double> values) const {
    Bytes plain;
    if (is_binary_) {
      plain.push_back(static_cast<std::uint8_t>(id + kBinary));
      append_little(plain, time_us);
      for (const double v : values)
        append_little(plain, std::isfinite(v) ? static_cast<float>(v) : 0.0f);
      plain = escaped(plain);
    } else {
      append_text(plain, std::string{id, ','} + std::to_string(time_us));
      for (const double v : values) {
        plain.push_back(',');
        append_number(plain, v, 6);
      }
      plain.push_back('\r');
    }
    plain.push_back(kEnd);
    out.insert(out.end(), plain.begin(), plain.end());
  }

  bool is_binary_;
  std::string name_;
};

}  // namespace

Parser::Parser(const Options& options) : name_(options.text("name")) {
  options.choice("format", {"ascii", "binary"});
}

void Parser::parse(ByteView bytes) {
  lines_.feed(bytes, all_counts(), [&](ByteView line) { handle(line, '\0'); });
}

void Parser::restart() {
  lines_.reset();
  for (auto& [channel, device] : devices_) {
    const int sensor = device.sensor;
    device = Device();
    device.sensor = sensor;
    device.next_flags = kAfterReset;
  }
}

void Parser::handle(ByteView message, char channel) {
  if (message.empty()) return;
  if (message[0] == '^') {
    if (channel == '\0' && message.size() > 2 && message[1] > ' ' && message[1] <= '~')
      return handle(message.subspan(2), static_cast<char>(message[1]));
    ++count(Count::malformed);
    return;
  }
  auto& device = devices_[channel];
  if (device.name.empty())
    device.name = channel == '\0' ? name_ : name_ + "_" + std::string(1, channel);
  if (message[0] >= kBinary)
    handle_binary(message, device);
  else if (message[0] == '{')
    handle_reply(text_of(message), device);
  else
    handle_text(message, device);
}

void Parser::handle_text(ByteView message, Device& device) {
  const auto fields = split_fields(text_of(message), ',');
  const char id = fields[0].size() == 1 ? fields[0][0] : '\0';
  if (id == 'N' || id == 'F') {
    count(Count::device_errors) += id == 'F' ? 1 : 0;
    ++count(Count::frames);
    const auto text = text_of(message);
    return set_message(text.substr(std::min(text.find(',', 2), text.size() - 1) + 1));
  }
  const Values expected = values_of(id);
  if (!expected.is_known) {
    ++count(Count::unknown_types);
    return;
  }
  std::uint64_t time_us = 0;
  bool is_good = fields.size() > 2 && (!expected.is_used || expected.has(fields.size() - 2));
  std::vector<double> values(is_good && expected.is_used ? fields.size() - 2 : 0);
  if (is_good) {
    const auto text = fields[1];
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), time_us);
    is_good = error == std::errc() && end == text.data() + text.size() && time_us < kLatest_us;
  }
  for (std::size_t i = 0; is_good && i < values.size(); ++i)
    is_good = parse_number(fields[i + 2], values[i]) == NumberStatus::ok;
  if (!is_good) {
    ++count(Count::malformed);
    return;
  }
  handle_values(id, time_us, values, device);
}

void Parser::handle_binary(ByteView message, Device& device) {
  const char id = static_cast<char>(message[0] - kBinary);
  const Values expected = values_of(id);
  const bool is_text = id == 'N' || id == 'F';
  if (is_text || (expected.is_known && !expected.is_used)) {
    ++count(Count::frames);
    count(Count::device_errors) += id == 'F' ? 1 : 0;
    if (is_text && message.size() > 9) set_message(text_of(message.subspan(9)));
    return;
  }
  if (!expected.is_known) {
    ++count(Count::unknown_types);
    return;
  }
  const auto plain = unescaped(message);
  const std::size_t size = plain ? plain->size() : 0;
  if (size < 9 || size % 4 != 1 || !expected.has((size - 9) / 4) ||
      read_little<std::uint64_t>(&(*plain)[1]) >= kLatest_us) {
    ++count(Count::malformed);
    return;
  }
  std::vector<double> values;
  for (std::size_t at = 9; at < size; at += 4) values.push_back(read_little<float>(&(*plain)[at]));
  handle_values(id, read_little<std::uint64_t>(&(*plain)[1]), values, device);
}

// {"ping":{"interface":"USB","name":"Right Foot","sn":"64F619FB"}} names the device.
void Parser::handle_reply(std::string_view text, Device& device) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded()) {
    ++count(Count::malformed);
    return;
  }
  ++count(Count::frames);
  const auto ping = json.find("ping");
  if (ping == json.end() || !ping->is_object()) return;
  const auto name = ping->find("name"), serial = ping->find("sn");
  if (name == ping->end() || serial == ping->end() || !name->is_string() || !serial->is_string())
    return;
  device.serial = serial->get<std::string>();
  device.name = name->get<std::string>() + " " + device.serial;
  if (device.sensor >= 0) rename_sensor(device.sensor, device.name, device.serial);
}

void Parser::handle_values(char id, std::uint64_t time_us, std::span<const double> values,
                           Device& device) {
  if (!std::ranges::all_of(values, [](double v) { return std::isfinite(v); })) {
    ++count(Count::implausible);
    return;
  }
  ++count(Count::frames);
  if (id == 'I') return handle_inertial(time_us, values, device);
  if (id == 'B') {
    if (device.sensor >= 0) set_battery(device.sensor, values[0]);
    return;
  }
  const bool has_orientation = (id != 'L' && id != 'E') || values.size() == 7;
  if (has_orientation && !values.empty())
    handle_orientation(time_us, orientation_of(id, values), device);
}

void Parser::handle_inertial(std::uint64_t time_us, std::span<const double> v, Device& device) {
  if (device.pending) {
    device.is_orientation_due = false;
    finish(device);
  }
  const Vec3 turn(v[0], v[1], v[2]), force(v[3], v[4], v[5]);
  if (turn.cwiseAbs().maxCoeff() > kFastest_degps || force.cwiseAbs().maxCoeff() > kLargest_g) {
    ++count(Count::implausible);
    return;
  }
  const auto step = device.clock.unwrap(time_us);
  if (step.is_repeated) {
    ++count(Count::repeated);
    return;
  }
  if (step.is_restarted) {
    ++count(Count::device_resets);
    device.next_flags |= kAfterReset;
  }
  if (device.sensor < 0) device.sensor = add_sensor(device.name, device.serial);
  if (device.sensor < 0) return;
  Sample sample;
  sample.sensor = device.sensor;
  sample.time_s = step.time_s;
  sample.angular_velocity = turn * kRadiansPerDegree;
  sample.specific_force = force * kStandardGravity_mps2;
  sample.flags = std::exchange(device.next_flags, 0u);
  device.inertial_us = time_us;
  device.pending = sample;
  const bool is_here = device.orientation_us == time_us && device.orientation.allFinite();
  if (is_here) device.pending->orientation = device.orientation;
  if (is_here || !device.is_orientation_due) finish(device);
}

void Parser::handle_orientation(std::uint64_t time_us, const Eigen::Vector4d& value,
                                Device& device) {
  device.orientation_us = time_us;
  device.orientation = value;
  if (time_us != device.inertial_us || device.sensor < 0) return;
  device.is_orientation_due = true;
  if (!device.pending) return;
  device.pending->orientation = value;
  finish(device);
}

void Parser::finish(Device& device) {
  emit(*device.pending);
  device.pending.reset();
}

std::vector<OptionSpec> Parser::options() {
  return {{"name", "ximu3", "name of the sensor until it sends its own"},
          {"format", "ascii",
           "format requested from the device and sent by the emulator: ascii or "
           "binary (both are always understood)"}};
}

std::vector<Bytes> Parser::start_commands(const Options& options) {
  const bool is_binary = options.choice("format", {"ascii", "binary"}) == 1;
  std::vector<Bytes> commands;
  for (const std::string_view text :
       {std::string_view("{\"ping\":null}\n"),
        is_binary ? std::string_view("{\"binary_mode_enabled\":true}\n")
                  : std::string_view("{\"binary_mode_enabled\":false}\n"),
        std::string_view("{\"apply\":null}\n")})
    commands.emplace_back(text.begin(), text.end());
  return commands;
}

std::unique_ptr<StreamEncoder> Parser::make_encoder(const Options& options,
                                                    const std::vector<std::string>& sensors) {
  if (sensors.size() != 1)
    throw ConfigError("driver ximu3 emulates one sensor, not " + std::to_string(sensors.size()));
  return std::make_unique<Encoder>(options.choice("format", {"ascii", "binary"}) == 1, sensors[0]);
}

}  // namespace sparse_mocap::streams::ximu3
