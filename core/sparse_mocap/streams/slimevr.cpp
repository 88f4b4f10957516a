// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/streams/slimevr.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "sparse_mocap/base/text_scanner.hpp"
#include "sparse_mocap/streams/orientation.hpp"
#include "sparse_mocap/streams/slimevr_packets.hpp"

namespace sparse_mocap::streams::slimevr {
namespace {

constexpr std::size_t kHeader = 12, kLongestDatagram = 1472;
constexpr int kSilentAnswers = 3;  // without acceleration between them: it is still
constexpr std::string_view kHello = "Hey OVR =D 5";

bool is_known(std::int32_t type) {
  return (type >= 0 && type <= kHighestType) || type == kBundle || type == kCompactBundle;
}

Vec3 read_floats(const std::uint8_t* at) {
  return {read_big<float>(at), read_big<float>(at + 4), read_big<float>(at + 8)};
}

std::string mac_text(const std::uint8_t* mac) {
  std::array<char, 18> text{};
  std::snprintf(text.data(), text.size(), "%02x:%02x:%02x:%02x:%02x:%02x", mac[0], mac[1], mac[2],
                mac[3], mac[4], mac[5]);
  return text.data();
}

// As mac_text, of a MAC in any usual spelling; empty when it is none.
std::string mac_text(std::string_view written) {
  std::string text;
  for (const char c : lower_case(written)) {
    if (c == ':' || c == '-') continue;
    if (!((c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'))) return {};
    if (text.size() % 3 == 2) text += ':';
    text += c;
  }
  return text.size() == 17 ? text : std::string();
}

struct Greeting {
  std::int32_t protocol = 0;
  std::string mac;  // empty: it has none
};

// [7 x i32 board, sensors, versions][u8 length + name of the firmware][6 bytes MAC]; phones may
// leave out what comes last.
Greeting greeting_in(ByteView body) {
  constexpr std::size_t kNumbers = 28, kMac = 6;
  Greeting greeting;
  if (body.size() >= kNumbers) greeting.protocol = read_big<std::int32_t>(&body[kNumbers - 4]);
  if (body.size() <= kNumbers || body.size() < kNumbers + 1 + body[kNumbers] + kMac)
    return greeting;
  const auto mac = body.subspan(kNumbers + 1 + body[kNumbers], kMac);
  if (std::ranges::any_of(mac, [](std::uint8_t byte) { return byte != 0; }))
    greeting.mac = mac_text(mac.data());
  return greeting;
}

// How long the body of a packet must be.
std::size_t least_size(std::int32_t type) {
  switch (type) {
    case kAcceleration:
      return 12;
    case kOldRotation:
    case kOldSecondRotation:
      return 16;
    case kRotation:
      return 19;
    case kRotationAndAcceleration:
      return 15;
    case kBattery:
      return 4;
    case kSensorInfo:
      return 2;
    default:
      return 0;
  }
}

Quat read_quaternion(const std::uint8_t* at) {
  const Vec3 v = read_floats(at);
  return Quat(read_big<float>(at + 12), v[0], v[1], v[2]);
}

}  // namespace

Parser::Parser(const Options& options) : scanner_(kLongestDatagram + 2) {
  for (const auto& written : options.list("macs")) {
    const std::string mac = mac_text(std::string_view(written));
    if (mac.empty()) options.fail("macs", "a list of MACs such as 24:e6:a1:b2:c3:d4");
    allowed_.insert(mac);
  }
}

void Parser::parse(ByteView bytes) {
  // Inside a datagram any two bytes may look like a length, so a known type and a plausible packet
  // number must follow.
  const auto inspect = [](ByteView head) {
    if (head.size() < 2) return Head::more();
    const std::size_t length = read_big<std::uint16_t>(head.data());
    if (length < 4 || length > kLongestDatagram) return Head::skip();
    if (head.size() < 6) return Head::more();
    if (!is_known(read_big<std::int32_t>(&head[2]))) return Head::skip();
    if (length >= kHeader && head.size() < 10) return Head::more();
    if (length >= kHeader && read_big<std::uint32_t>(&head[6]) != 0) return Head::skip();
    return head.size() < length + 2 ? Head::more() : Head::frame(length + 2);
  };
  scanner_.feed(bytes, all_counts(), inspect,
                [&](ByteView frame) { parse_datagram(frame.subspan(2), "slimevr"); });
}

void Parser::restart() {
  scanner_.reset();
  for (auto& [mac, tracker] : trackers_) {
    tracker.last_number.reset();
    for (auto& [number, part] : tracker.parts) part.orientation.reset();
    tracker.next_flags = kAfterReset;
  }
}

void Parser::parse_datagram(ByteView datagram, std::string_view sender) {
  ++num_datagrams_;
  if (datagram.size() < kHeader || datagram.size() > kLongestDatagram) {
    ++count(datagram.size() < kHeader ? Count::malformed : Count::overruns);
    return;
  }
  const auto type = read_big<std::int32_t>(datagram.data());
  const auto number = read_big<std::int64_t>(&datagram[4]);
  const auto body = datagram.subspan(kHeader);
  if (!is_known(type) || number < 0) {
    ++count(Count::unknown_types);
    return;
  }
  if (type == kHandshake) return handle_handshake(body, sender);
  const auto mac = macs_.find(sender);
  const auto known = mac == macs_.end() ? trackers_.end() : trackers_.find(mac->second);
  if (known == trackers_.end()) {
    ++count(Count::unconfigured);
    return;
  }
  auto& tracker = known->second;
  tracker.heard = num_datagrams_;
  if (!handle_number(number, tracker)) return;
  if (type == kBundle || type == kCompactBundle)
    handle_bundle(body, type == kCompactBundle, tracker);
  else
    handle_packet(type, body, tracker);
}

bool Parser::handle_number(std::int64_t number, Tracker& tracker) {
  const auto last = tracker.last_number;
  if (last && number <= *last) {
    ++count(number == *last ? Count::repeated : Count::out_of_order);
    return false;
  }
  if (last && number > *last + 1) {
    count(Count::missing_samples) += static_cast<std::uint64_t>(number - *last - 1);
    tracker.next_flags |= kAfterGap;
  }
  tracker.last_number = number;
  return true;
}

void Parser::handle_handshake(ByteView body, std::string_view sender) {
  ++count(Count::frames);
  const Greeting greeting = greeting_in(body);
  // A phone without a MAC is known by its address, without the port, which changes.
  const std::string mac =
      !greeting.mac.empty() ? greeting.mac : std::string(sender.substr(0, sender.rfind(':')));
  if (!allowed_.empty() && !allowed_.contains(mac)) {
    ++count(Count::unknown_types);
    return set_message("tracker " + mac + " is not in the option macs");
  }
  Tracker* tracker = tracker_named(mac, sender);
  tracker->protocol = greeting.protocol;
  if (tracker->last_number) {
    ++count(Count::device_resets);
    tracker->next_flags |= kAfterReset;
  }
  tracker->last_number.reset();
  Bytes answer(64);
  answer[0] = static_cast<std::uint8_t>(kHandshake);
  std::copy(kHello.begin(), kHello.end(), answer.begin() + 1);
  reply(answer);
}

Parser::Tracker* Parser::tracker_named(const std::string& mac, std::string_view sender) {
  if (!trackers_.contains(mac) && trackers_.size() == kMostTrackers) {
    const auto silent = std::ranges::min_element(
        trackers_, {}, [](const auto& tracker) { return tracker.second.heard; });
    trackers_.erase(silent);
    ++count(Count::too_many_sensors);
  }
  std::erase_if(macs_, [&](const auto& known) {
    return known.second == mac || !trackers_.contains(known.second);
  });
  macs_[std::string(sender)] = mac;
  auto& tracker = trackers_[mac];
  tracker.name = mac;
  tracker.heard = num_datagrams_;
  return &tracker;
}

// [u16 length][i32 type][body] each; compact: [u8 length][u8 type][body].
void Parser::handle_bundle(ByteView body, bool is_compact, Tracker& tracker) {
  const std::size_t length_size = is_compact ? 1 : 2, type_size = is_compact ? 1 : 4;
  while (!body.empty()) {
    if (body.size() < length_size) break;
    const std::size_t length = is_compact ? body[0] : read_big<std::uint16_t>(body.data());
    body = body.subspan(length_size);
    if (length < type_size || length > body.size()) break;
    const auto type = is_compact ? body[0] : read_big<std::int32_t>(body.data());
    handle_packet(type, body.subspan(type_size, length - type_size), tracker);
    body = body.subspan(length);
    if (body.empty()) return;
  }
  ++count(Count::malformed);
}

void Parser::handle_packet(std::int32_t type, ByteView body, Tracker& tracker) {
  if (body.size() < least_size(type)) {
    ++count(Count::malformed);
    return;
  }
  if (type < 0 || type > kHighestType) {
    ++count(Count::unknown_types);
    return;
  }
  ++count(Count::frames);
  if (type == kAcceleration) {  // owoTrack's has no number
    handle_acceleration(body.size() > 12 ? body[12] : 0, read_floats(body.data()), tracker);
  } else if (type == kRotation && body[1] == kNormalRotation) {
    handle_rotation(body[0], read_quaternion(&body[2]), tracker);
  } else if (type == kOldRotation || type == kOldSecondRotation) {
    handle_rotation(type == kOldRotation ? 0 : 1, read_quaternion(body.data()), tracker);
  } else if (type == kRotationAndAcceleration) {
    std::array<double, 7> v;
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = read_big<std::int16_t>(&body[1 + 2 * i]);
    handle_rotation(body[0], Quat(v[3] / 32768, v[0] / 32768, v[1] / 32768, v[2] / 32768), tracker);
    handle_acceleration(body[0], Vec3(v[4], v[5], v[6]) / 128.0, tracker);
  } else if (type == kBattery) {  // volts before the level in later firmware
    handle_battery(read_big<float>(&body[body.size() < 8 ? 0 : 4]), tracker);
  } else if (type == kSensorInfo) {
    reply({0, 0, 0, static_cast<std::uint8_t>(kSensorInfo), body[0], body[1]});
  } else if (type == kHeartbeat || type == kPing) {
    handle_sign_of_life(tracker);
  }
}

void Parser::handle_rotation(int part, const Quat& rotation, Tracker& tracker) {
  if (std::abs(rotation.norm() - 1.0) < 0.1) {
    tracker.parts[part].orientation = orientation_from_z_up(rotation.normalized());
  } else {
    ++count(Count::implausible);
    tracker.parts[part].orientation.reset();
  }
}

void Parser::handle_acceleration(int number, const Vec3& linear_acceleration, Tracker& tracker) {
  auto& part = tracker.parts[number];
  part.num_silent = 0;
  if (!part.orientation) {
    ++count(Count::incomplete);
    return;
  }
  if (!linear_acceleration.allFinite()) {
    ++count(Count::implausible);
    return;
  }
  if (!has_sensor(number, part, tracker)) return;
  const Vec3& a = linear_acceleration;
  emit_sample(part, tracker.protocol < kTurnedBefore ? Vec3(a.y(), -a.x(), a.z()) : a, tracker);
}

void Parser::handle_sign_of_life(Tracker& tracker) {
  for (auto& [number, part] : tracker.parts) {
    part.num_silent = std::min(part.num_silent + 1, kSilentAnswers);
    if (part.num_silent == kSilentAnswers && part.orientation && part.sensor >= 0)
      emit_sample(part, Vec3::Zero(), tracker);
  }
}

void Parser::handle_battery(double level, Tracker& tracker) {
  tracker.battery = 100.0 * level;
  for (const auto& [number, part] : tracker.parts)
    if (part.sensor >= 0) set_battery(part.sensor, tracker.battery);
}

bool Parser::has_sensor(int number, Part& part, Tracker& tracker) {
  if (part.sensor >= 0) return true;
  const std::string id = tracker.name + (number == 0 ? "" : "/" + std::to_string(number));
  const auto& ids = sensor_ids();
  const auto known = std::ranges::find(ids, id);
  part.sensor = known != ids.end() ? static_cast<int>(known - ids.begin()) : add_sensor(id, id);
  if (part.sensor >= 0) set_battery(part.sensor, tracker.battery);
  return part.sensor >= 0;
}

void Parser::emit_sample(const Part& part, const Vec3& linear_acceleration, Tracker& tracker) {
  Sample sample;
  sample.sensor = part.sensor;
  sample.orientation = *part.orientation;
  sample.flags = tracker.next_flags;
  tracker.next_flags = 0;
  restore_gravity(sample, linear_acceleration);
  emit(sample);
}

std::vector<OptionSpec> Parser::options() {
  return {{"macs", "", "MACs of the trackers to accept, separated by commas; empty: all"}};
}

std::vector<Bytes> Parser::keep_alive(const Options&) { return {header(kHeartbeat, 0)}; }

}  // namespace sparse_mocap::streams::slimevr
