// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/streams/xsens_mt.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "sparse_mocap/streams/wire.hpp"

namespace sparse_mocap::streams::xsens {
namespace {

constexpr double kPeriodTick_s = 1.0 / 115200.0;
constexpr std::size_t kConfigurationHead = 98, kConfigurationDevice = 20, kMostDevices = 32;
constexpr std::uint64_t kRequestAfter = 100;  // unreadable messages

std::string hexadecimal(std::uint32_t value) {
  std::array<char, 9> text{};
  std::snprintf(text.data(), text.size(), "%08X", static_cast<unsigned>(value));
  return text.data();
}

std::string error_text(ByteView data) {
  static const std::map<int, std::string_view> kCodes{
      {0x03, "period sent is not within valid range"},
      {0x04, "message sent is invalid"},
      {0x1E, "timer overflow"},
      {0x20, "baud rate is not within valid range"},
      {0x21, "parameter sent is invalid or not within range"},
      {0x28, "device error"}};
  if (data.empty()) return "the device reports an error";
  const auto known = kCodes.find(data[0]);
  return "the device reports error " + std::to_string(data[0]) +
         (known == kCodes.end() ? "" : ": " + std::string(known->second));
}

}  // namespace

Parser::Parser(const Options& options)
    : tick_s_(options.number("tick_us", 0.1, 1e6) * 1e-6),
      period_s_(0.0),
      configured_period_s_(1.0 / options.number("rate_hz", 1.0, 2000.0)) {
  if (options.is_empty("output_mode") != options.is_empty("output_settings"))
    options.fail(options.is_empty("output_mode") ? "output_mode" : "output_settings",
                 "set, because output_mode and output_settings belong together");
  if (!options.is_empty("output_mode"))
    configured_layout_ =
        Layout{static_cast<unsigned>(options.integer("output_mode", 1, 0xFFFF)),
               static_cast<unsigned>(options.integer("output_settings", 0, 0x7FFFFFFF))};
  options.choice("output", {"mtdata2", "mtdata"});
  configure_by_options();
}

void Parser::configure_by_options() {
  blocks_.clear();
  period_s_ = 0.0;
  bus_counter_.reset();
  if (!configured_layout_) return;
  blocks_ = {{*configured_layout_, configured_layout_->length()}};
  period_s_ = configured_period_s_;
}

void Parser::parse(ByteView bytes) {
  scanner_.feed(
      bytes, all_counts(), [&](ByteView head) { return inspect(head, all_counts()); },
      [&](ByteView frame) { handle(open(frame)); });
}

void Parser::restart() {
  scanner_.reset();
  for (auto& [address, device] : devices_) {
    device.counter = PacketCounter(16);
    device.clock = TickClock(32, tick_s_);
    device.next_flags = kAfterReset;
  }
  configure_by_options();
}

void Parser::handle(const Message& message) {
  ++count(Count::frames);
  switch (message.id) {
    case kData2:
      return handle_data2(message);
    case kData:
      return handle_data(message.data);
    case kDeviceId:
      return handle_device_id(message);
    case kConfiguration:
      return handle_configuration(message.data);
    case kWakeUp:
      ++count(Count::device_resets);
      set_message("the device restarted");
      reply(seal(kMasterBus, kWakeUpAck));
      for (auto& [address, device] : devices_) device.next_flags |= kAfterReset;
      return;
    case kError:
      ++count(Count::device_errors);
      return set_message(error_text(message.data));
    default:
      // Answers to commands have odd numbers.
      if (message.id % 2 == 0) ++count(Count::unknown_types);
  }
}

void Parser::handle_device_id(const Message& message) {
  if (message.data.size() < 4) {
    ++count(Count::malformed);
    return;
  }
  names_[message.bus] = hexadecimal(read_big<std::uint32_t>(message.data.data()));
  const auto known = devices_.find(message.bus);
  if (known != devices_.end())
    rename_sensor(known->second.sensor, names_[message.bus], names_[message.bus]);
}

void Parser::handle_configuration(ByteView data) {
  const std::size_t num =
      data.size() < kConfigurationHead ? 0 : read_big<std::uint16_t>(&data[kConfigurationHead - 2]);
  if (num == 0 || num > kMostDevices ||
      data.size() != kConfigurationHead + num * kConfigurationDevice) {
    ++count(Count::malformed);
    return;
  }
  blocks_.clear();
  std::map<std::uint32_t, int> ids;
  for (std::size_t i = 0; i < num; ++i) {
    const auto device = data.subspan(kConfigurationHead + i * kConfigurationDevice);
    const auto id = read_big<std::uint32_t>(device.data());
    if (!ids.emplace(id, 0).second || !add_block(device)) {
      set_message("the configuration of device " + hexadecimal(id) + " is not supported");
      ++count(Count::malformed);
      blocks_.clear();
      return;
    }
    const int address = num == 1 ? kMasterBus : static_cast<int>(i) + 1;
    names_[address] = hexadecimal(id);
    const auto known = devices_.find(address);
    if (known != devices_.end())
      rename_sensor(known->second.sensor, names_[address], names_[address]);
  }
  period_s_ = read_big<std::uint16_t>(&data[4]) * kPeriodTick_s;
  const bool is_bus = num > 1 || read_big<std::uint32_t>(data.data()) != ids.begin()->first;
  bus_counter_ = is_bus ? std::optional<PacketCounter>(16) : std::nullopt;
}

// Adds the block that a device of the configuration sends; false when its layout is not supported.
// Its length shows whether it ends in a counter: an Xbus Master sends one before all blocks
// instead.
bool Parser::add_block(ByteView device) {
  Layout layout{read_big<std::uint16_t>(&device[6]), read_big<std::uint32_t>(&device[8])};
  const std::size_t length = read_big<std::uint16_t>(&device[4]);
  if (layout.length() != length) layout.settings &= ~kSettingsCounter;
  blocks_.push_back({layout, length});
  return layout.length() == length && length > 0;
}

Parser::Device* Parser::device_at(int address) {
  const auto known = devices_.find(address);
  if (known != devices_.end()) return &known->second;
  const auto name = names_.find(address);
  const int sensor =
      name != names_.end()
          ? add_sensor(name->second, name->second)
          : add_sensor(address == kMasterBus ? "mt" : "mt_" + std::to_string(address));
  if (sensor < 0) return nullptr;
  return &devices_.emplace(address, Device{sensor, PacketCounter(16), TickClock(32, tick_s_), 0})
              .first->second;
}

void Parser::handle_data2(const Message& message) {
  const auto measured = read_data2(message.data);
  if (!measured) {
    ++count(Count::malformed);
    return;
  }
  count(Count::unknown_types) += measured->num_unknown;
  if (auto* device = device_at(message.bus)) handle_measured(*device, *measured);
}

void Parser::handle_data(ByteView data) {
  if (blocks_.empty()) {
    if (count(Count::unconfigured)++ % kRequestAfter == 0) request_configuration();
    return;
  }
  if (bus_counter_) return handle_bus_data(data);
  const auto measured = read_data(data, blocks_[0].layout);
  if (!measured) {
    ++count(Count::malformed);
    return set_message("the length of the data does not match the device's configuration");
  }
  if (auto* device = device_at(kMasterBus)) handle_measured(*device, *measured);
}

// A device answers this only while it is not measuring.
void Parser::request_configuration() {
  for (const auto id : {kGoToConfig, kReqConfiguration, kGoToMeasurement})
    reply(seal(kMasterBus, id));
}

void Parser::handle_bus_data(ByteView data) {
  std::size_t length = 2;
  for (const auto& block : blocks_) length += block.length;
  if (data.size() != length) {
    ++count(Count::malformed);
    return set_message("the length of the data does not match the devices' configuration");
  }
  const auto counter = read_big<std::uint16_t>(data.data());
  data = data.subspan(2);
  int address = blocks_.size() == 1 ? kMasterBus : 1;
  for (const auto& block : blocks_) {
    auto measured = read_data(data.first(block.length), block.layout);
    data = data.subspan(block.length);
    measured->counter = counter;
    if (auto* device = device_at(address++)) handle_measured(*device, *measured);
  }
}

void Parser::handle_measured(Device& device, const Measured& measured) {
  Sample sample = measured.sample;
  sample.sensor = device.sensor;
  if (measured.counter) {
    const auto step = device.counter.unwrap(*measured.counter);
    count(Count::missing_samples) += static_cast<std::uint64_t>(step.missing);
    if (step.missing > 0) device.next_flags |= kAfterGap;
    if (step.is_backwards) device.next_flags |= kAfterReset;
    if (step.is_repeated || step.is_backwards) {
      ++count(step.is_repeated ? Count::repeated : Count::out_of_order);
      return;
    }
    sample.counter = step.counter;
    if (period_s_ > 0.0) sample.time_s = static_cast<double>(step.counter) * period_s_;
  }
  // Packets with only GNSS data have separate times, which jump back and forth.
  if (!sample.has_specific_force() && !sample.has_orientation() &&
      !sample.angular_velocity.allFinite())
    return;
  if (measured.time_fine) {
    const auto step = device.clock.unwrap(*measured.time_fine);
    sample.time_s = step.time_s;
    if (step.is_restarted) device.next_flags |= kAfterReset;
    if (step.is_restarted) ++count(Count::device_resets);
    if (step.is_repeated) {
      ++count(Count::repeated);
      return;
    }
  }
  sample.flags |= device.next_flags;
  device.next_flags = 0;
  emit(sample);
}

}  // namespace sparse_mocap::streams::xsens
