// SPDX-License-Identifier: GPL-3.0-or-later
//
// The sending side: what a host sends to start an MT, and what an MT would send.
#include <cmath>
#include <memory>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/streams/orientation.hpp"
#include "sparse_mocap/streams/wire.hpp"
#include "sparse_mocap/streams/xsens_mt.hpp"

namespace sparse_mocap::streams::xsens {
namespace {

constexpr Layout kDefaultLayout{kModeCalibrated | kModeOrientation, kSettingsCounter};
constexpr std::uint32_t kFirstDevice = 0x00300001, kMaster = 0x00200000;

template <typename T>
Bytes big(std::initializer_list<T> values) {
  Bytes bytes;
  for (const T value : values) append_big(bytes, value);
  return bytes;
}

Layout layout_of(const Options& options) {
  if (options.is_empty("output_mode")) return kDefaultLayout;
  return {static_cast<unsigned>(options.integer("output_mode", 1, 0xFFFF)),
          static_cast<unsigned>(options.integer("output_settings", 0, 0x7FFFFFFF))};
}

std::uint16_t period_of(const Options& options) {
  const double ticks = std::round(115200.0 / options.number("rate_hz", 1.0, 2000.0));
  return static_cast<std::uint16_t>(std::min(ticks, 65535.0));
}

void append_vector(Bytes& out, const Vec3& v) {
  for (const double x : v) append_big(out, std::isfinite(x) ? static_cast<float>(x) : 0.0f);
}

void append_orientation(Bytes& out, const Sample& sample) {
  const Quat q =
      sample.has_orientation() ? z_up_from_orientation(sample.orientation) : Quat::Identity();
  for (const double x : {q.w(), q.x(), q.y(), q.z()}) append_big(out, static_cast<float>(x));
}

void append_field(Bytes& out, std::uint16_t type, ByteView data) {
  append_big(out, type);
  out.push_back(static_cast<std::uint8_t>(data.size()));
  out.insert(out.end(), data.begin(), data.end());
}

// An MTi that sends MTData2, or an MT or an Xbus Master with several that send MTData.
class Encoder : public StreamEncoder {
 public:
  Encoder(const Options& options, const std::vector<std::string>& sensors)
      : num_sensors_(sensors.size()),
        is_data2_(options.choice("output", {"mtdata2", "mtdata"}) == 0 && sensors.size() == 1),
        period_(period_of(options)),
        tick_s_(options.number("tick_us", 0.1, 1e6) * 1e-6) {
    if (!options.is_empty("output_mode"))
      throw ConfigError(
          "the emulator of driver xsens_mt sends only calibrated data and "
          "quaternion; leave output_mode and output_settings empty");
  }

  // A device that sends MTData describes its layout before the first message.
  std::vector<Bytes> hello() override {
    if (is_data2_) return {seal(kMasterBus, kWakeUp)};
    return {seal(kMasterBus, kWakeUp), seal(kMasterBus, kConfiguration, configuration())};
  }

  std::vector<Bytes> encode(std::span<const Sample> samples) override {
    if (samples.empty()) return {};
    return {is_data2_ ? data2(samples[0]) : data(samples)};
  }

  Bytes respond(ByteView from_host) override {
    Bytes answers;
    scanner_.feed(
        from_host, counters_, [&](ByteView head) { return inspect(head, counters_); },
        [&](ByteView frame) {
          const auto answer = answer_to(open(frame));
          answers.insert(answers.end(), answer.begin(), answer.end());
        });
    return answers;
  }

 private:
  bool is_bus() const { return num_sensors_ > 1; }

  Bytes data2(const Sample& sample) {
    Bytes body;
    append_field(body, 0x1020, big({static_cast<std::uint16_t>(counter_of(sample))}));
    append_field(body, 0x1060,
                 big({static_cast<std::uint32_t>(
                     static_cast<std::int64_t>(std::llround(time_of(sample) / tick_s_)))}));
    Bytes part;
    append_orientation(part, sample);
    if (sample.has_orientation()) append_field(body, 0x2010, part);
    part.clear();
    append_vector(part, sample.specific_force);
    append_field(body, 0x4020, part);
    part.clear();
    append_vector(part, sample.angular_velocity);
    if (sample.angular_velocity.allFinite()) append_field(body, 0x8020, part);
    return seal(kMasterBus, kData2, body);
  }

  Bytes data(std::span<const Sample> samples) {
    const auto counter = static_cast<std::uint16_t>(counter_of(samples[0]));
    Bytes body;
    if (is_bus()) append_big(body, counter);
    for (std::size_t i = 0; i < num_sensors_; ++i) {
      Sample sample;
      for (const auto& each : samples)
        if (each.sensor == static_cast<int>(i)) sample = each;
      append_vector(body, sample.specific_force);
      append_vector(body, sample.angular_velocity);
      append_vector(body, sample.magnetic_field);
      append_orientation(body, sample);
    }
    if (!is_bus()) append_big(body, counter);
    return seal(kMasterBus, kData, body);
  }

  std::int64_t counter_of(const Sample& sample) {
    next_counter_ = sample.counter >= 0 ? sample.counter : next_counter_;
    return next_counter_++;
  }
  double time_of(const Sample& sample) const {
    return std::isfinite(sample.time_s) ? sample.time_s
                                        : static_cast<double>(next_counter_) * period_ / 115200.0;
  }

  Bytes answer_to(const Message& message) const {
    const auto id = static_cast<std::uint8_t>(message.id + 1);
    switch (message.id) {
      case kReqDeviceId:
        return seal(message.bus, id, big({is_bus() ? kMaster : kFirstDevice}));
      case kReqConfiguration:
        return seal(message.bus, id, configuration());
      case kInitBus: {
        Bytes ids;
        for (std::uint32_t i = 0; i < num_sensors_; ++i) append_big(ids, kFirstDevice + i);
        return seal(message.bus, id, ids);
      }
      case kWakeUpAck:
        return {};
      default:
        return message.id % 2 == 0 ? seal(message.bus, id) : Bytes{};
    }
  }

  Bytes configuration() const {
    Bytes body;
    append_big(body, is_bus() ? kMaster : kFirstDevice);
    append_big(body, period_);
    body.resize(96);
    append_big(body, static_cast<std::uint16_t>(num_sensors_));
    Layout layout = kDefaultLayout;
    if (is_bus()) layout.settings &= ~kSettingsCounter;
    for (std::uint32_t i = 0; i < num_sensors_; ++i) {
      append_big(body, kFirstDevice + i);
      append_big(body, static_cast<std::uint16_t>(layout.length()));
      append_big(body, static_cast<std::uint16_t>(layout.mode));
      append_big(body, static_cast<std::uint32_t>(layout.settings));
      body.resize(body.size() + 8);
    }
    return body;
  }

  std::size_t num_sensors_;
  bool is_data2_;
  std::uint16_t period_;
  double tick_s_;
  std::int64_t next_counter_ = 0;
  FrameScanner scanner_{kLongestFrame};
  Counters counters_;
};

}  // namespace

std::vector<OptionSpec> Parser::options() {
  return {
      {"output", "mtdata2",
       "format requested from the device: mtdata2, or mtdata (MTx, Xbus Master)"},
      {"rate_hz", "100", "samples a second"},
      {"num_sensors", "1", "number of MTs on the Xbus Master to configure"},
      {"tick_us", "100", "length of SampleTimeFine's ticks in microseconds: 100, or 1 for DOT"},
      {"output_mode", "", "layout of MTData if the device does not report it, such as 0x0006"},
      {"output_settings", "",
       "layout of MTData if the device does not report it, such as 0x00000001"},
  };
}

std::vector<Bytes> Parser::start_commands(const Options& options) {
  const auto rate = static_cast<std::uint16_t>(options.number("rate_hz", 1.0, 2000.0));
  const int num = options.integer("num_sensors", 1, 32);
  std::vector<Bytes> commands{seal(kMasterBus, kGoToConfig), seal(kMasterBus, kReqDeviceId)};
  if (options.choice("output", {"mtdata2", "mtdata"}) == 0) {
    const Bytes outputs = big<std::uint16_t>(
        {0x1020, 0xFFFF, 0x1060, 0xFFFF, 0x2010, rate, 0x4020, rate, 0x8020, rate, 0xE020, 0xFFFF});
    commands.push_back(seal(kMasterBus, kSetOutputConfiguration, outputs));
  } else {
    const Layout layout = layout_of(options);
    if (num > 1) commands.push_back(seal(kMasterBus, kInitBus));
    commands.push_back(seal(kMasterBus, kSetPeriod, big({period_of(options)})));
    for (int i = 1; i <= num; ++i) {
      const auto bus = num == 1 ? kMasterBus : static_cast<std::uint8_t>(i);
      commands.push_back(seal(bus, kSetOutputMode, big({static_cast<std::uint16_t>(layout.mode)})));
      commands.push_back(
          seal(bus, kSetOutputSettings, big({static_cast<std::uint32_t>(layout.settings)})));
    }
    commands.push_back(seal(kMasterBus, kReqConfiguration));
  }
  commands.push_back(seal(kMasterBus, kGoToMeasurement));
  return commands;
}

std::unique_ptr<StreamEncoder> Parser::make_encoder(const Options& options,
                                                    const std::vector<std::string>& sensors) {
  return std::make_unique<Encoder>(options, sensors);
}

}  // namespace sparse_mocap::streams::xsens
