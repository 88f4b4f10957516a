// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/streams/slimevr.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sparse_mocap/streams/orientation.hpp"
#include "sparse_mocap/streams/wire.hpp"

namespace sparse_mocap::streams::slimevr {
namespace {

enum Type : std::int32_t {
  kHeartbeat = 0,
  kHandshake = 3,
  kAcceleration = 4,
  kPing = 10,
  kRotation = 17,
  kRotationAndAcceleration = 23,
  kBundle = 100,
  kCompactBundle = 101,
};
constexpr std::int32_t kHighestType = 30;  // of the others, such as battery and signal strength
constexpr std::size_t kHeader = 12, kLongestDatagram = 1472, kMostTrackers = 32;
constexpr std::uint8_t kNormalRotation = 1;
constexpr std::string_view kHello = "Hey OVR =D 5";

bool is_known(std::int32_t type) {
  return (type >= 0 && type <= kHighestType) || type == kBundle || type == kCompactBundle;
}

Vec3 read_floats(const std::uint8_t* at) {
  return {read_big<float>(at), read_big<float>(at + 4), read_big<float>(at + 8)};
}

Bytes header(std::int32_t type, std::int64_t number) {
  Bytes packet;
  append_big(packet, type);
  append_big(packet, number);
  return packet;
}

float finite_float(double value) { return std::isfinite(value) ? static_cast<float>(value) : 0.0f; }

// One tracker with several sensors.
class Encoder : public StreamEncoder {
 public:
  std::vector<Bytes> hello() override {
    Bytes packet = header(kHandshake, 0);
    for (int i = 0; i < 6; ++i) append_big(packet, std::int32_t{0});
    append_big(packet, std::int32_t{19});  // version of the protocol
    packet.push_back(0);                   // no firmware name
    packet.insert(packet.end(), {0x02, 0, 0, 0, 0, 0x01});
    return {packet};
  }

  std::vector<Bytes> encode(std::span<const Sample> samples) override {
    std::vector<Bytes> datagrams;
    for (const auto& sample : samples) {
      Sample upright = sample;
      if (!sample.has_orientation()) upright.orientation = orientation_from_z_up(Quat::Identity());
      datagrams.push_back(rotation(upright));
      datagrams.push_back(acceleration(upright));
    }
    return datagrams;
  }

 private:
  Bytes rotation(const Sample& sample) {
    Bytes packet = header(kRotation, ++number_);
    packet.push_back(static_cast<std::uint8_t>(sample.sensor));
    packet.push_back(kNormalRotation);
    const Quat q = z_up_from_orientation(sample.orientation);
    for (const double x : {q.x(), q.y(), q.z(), q.w()}) append_big(packet, finite_float(x));
    packet.push_back(0);
    return packet;
  }

  Bytes acceleration(const Sample& sample) {
    Bytes packet = header(kAcceleration, ++number_);
    for (const double x : without_gravity(sample)) append_big(packet, finite_float(x));
    packet.push_back(static_cast<std::uint8_t>(sample.sensor));
    return packet;
  }

  std::int64_t number_ = 0;
};

}  // namespace

Parser::Parser(const Options&) : scanner_(kLongestDatagram + 2) {}

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
  for (auto& [sender, tracker] : trackers_) {
    tracker.last_number.reset();
    tracker.orientations.clear();
    tracker.next_flags = kAfterReset;
  }
}

void Parser::parse_datagram(ByteView datagram, std::string_view sender) {
  if (datagram.size() < kHeader || datagram.size() > kLongestDatagram) {
    ++count(datagram.size() < kHeader ? Count::malformed : Count::overruns);
    return;
  }
  const auto type = read_big<std::int32_t>(datagram.data());
  const auto number = read_big<std::int64_t>(&datagram[4]);
  const bool is_bundle = type == kBundle || type == kCompactBundle;
  if (!is_known(type) || number < 0) {
    ++count(Count::unknown_types);
    return;
  }
  auto found = trackers_.find(sender);
  if (found == trackers_.end()) {
    if (trackers_.size() == kMostTrackers) {
      ++count(Count::too_many_sensors);
      return;
    }
    found = trackers_.emplace(std::string(sender), Tracker{}).first;
    found->second.name = std::string(sender);
  }
  auto& tracker = found->second;
  const auto body = datagram.subspan(kHeader);
  if (type == kHandshake) return handle_handshake(body, tracker);
  if (!handle_number(number, tracker)) return;
  if (type == kPing) reply(Bytes(datagram.begin(), datagram.end()));
  if (is_bundle)
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

// [7 x i32 board, sensors, versions][u8 length + name of the firmware][6 bytes MAC].
void Parser::handle_handshake(ByteView body, Tracker& tracker) {
  constexpr std::size_t kNumbers = 28, kMac = 6;
  ++count(Count::frames);
  if (body.size() > kNumbers && body.size() >= kNumbers + 1 + body[kNumbers] + kMac) {
    const auto* mac = &body[kNumbers + 1 + body[kNumbers]];
    std::array<char, 13> text{};
    std::snprintf(text.data(), text.size(), "%02x%02x%02x%02x%02x%02x", mac[0], mac[1], mac[2],
                  mac[3], mac[4], mac[5]);
    tracker.name = text.data();
  }
  if (tracker.last_number) {
    ++count(Count::device_resets);
    tracker.next_flags |= kAfterReset;
  }
  tracker.last_number.reset();
  Bytes answer(64);
  answer[0] = static_cast<std::uint8_t>(kHandshake);
  std::copy(kHello.begin(), kHello.end(), answer.begin() + 1);
  reply(answer);
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
  const std::size_t needed = type == kAcceleration              ? 13
                             : type == kRotation                ? 19
                             : type == kRotationAndAcceleration ? 15
                                                                : 0;
  if (body.size() < needed) {
    ++count(Count::malformed);
    return;
  }
  if (type < 0 || type > kHighestType) {
    ++count(Count::unknown_types);
    return;
  }
  ++count(Count::frames);
  if (type == kAcceleration) {
    handle_acceleration(body[12], read_floats(body.data()), tracker);
  } else if (type == kRotation && body[1] == kNormalRotation) {
    const Vec3 v = read_floats(&body[2]);
    handle_rotation(body[0], Quat(read_big<float>(&body[14]), v[0], v[1], v[2]), tracker);
  } else if (type == kRotationAndAcceleration) {
    std::array<double, 7> v;
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = read_big<std::int16_t>(&body[1 + 2 * i]);
    handle_rotation(body[0], Quat(v[3] / 32768, v[0] / 32768, v[1] / 32768, v[2] / 32768), tracker);
    handle_acceleration(body[0], Vec3(v[4], v[5], v[6]) / 128.0, tracker);
  }
}

void Parser::handle_rotation(int sensor, const Quat& rotation, Tracker& tracker) {
  if (std::abs(rotation.norm() - 1.0) < 0.1) {
    tracker.orientations[sensor] = orientation_from_z_up(rotation.normalized());
  } else {
    ++count(Count::implausible);
    tracker.orientations.erase(sensor);
  }
}

void Parser::handle_acceleration(int sensor, const Vec3& linear_acceleration, Tracker& tracker) {
  const auto orientation = tracker.orientations.find(sensor);
  if (orientation == tracker.orientations.end()) {
    ++count(Count::incomplete);
    return;
  }
  if (!linear_acceleration.allFinite()) {
    ++count(Count::implausible);
    return;
  }
  const auto known = tracker.sensors.find(sensor);
  const int index = known != tracker.sensors.end()
                        ? known->second
                        : add_sensor(tracker.name + "/" + std::to_string(sensor));
  if (index < 0) return;
  tracker.sensors[sensor] = index;
  Sample sample;
  sample.sensor = index;
  sample.orientation = orientation->second;
  sample.flags = tracker.next_flags;
  tracker.next_flags = 0;
  restore_gravity(sample, linear_acceleration);
  emit(sample);
}

std::vector<OptionSpec> Parser::options() { return {}; }

std::vector<Bytes> Parser::keep_alive(const Options&) { return {header(kHeartbeat, 0)}; }

std::unique_ptr<StreamEncoder> Parser::make_encoder(const Options&,
                                                    const std::vector<std::string>&) {
  return std::make_unique<Encoder>();
}

}  // namespace sparse_mocap::streams::slimevr
