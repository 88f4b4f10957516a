// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/streams/witmotion.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/streams/orientation.hpp"
#include "sparse_mocap/streams/wire.hpp"

namespace sparse_mocap::streams::witmotion {
namespace {

constexpr std::uint8_t kHeader = 0x55;
constexpr std::size_t kSize = 11, kBleSize = 20;
constexpr std::uint8_t kBleData = 0x61, kBleReply = 0x71;
constexpr double kFullScale = 32768.0;
constexpr double kGyroscopeRange_radps = 2000.0 * kRadiansPerDegree;
constexpr int kTime = 0x50, kForce = 0x51, kTurn = 0x52, kAngles = 0x53, kField = 0x54,
              kQuaternion = 0x59;
constexpr int kLowestType = 0x50, kHighestType = 0x5F;

std::uint8_t sum_of(ByteView bytes) {
  return static_cast<std::uint8_t>(std::accumulate(bytes.begin(), bytes.end(), 0u));
}

// Three numbers in units of the range.
Vec3 read_vector(const std::uint8_t* at, double range) {
  Vec3 v;
  for (int i = 0; i < 3; ++i) v[i] = read_little<std::int16_t>(at + 2 * i) / kFullScale * range;
  return v;
}

bool is_at_end(const std::uint8_t* at) {
  return std::ranges::any_of(std::array{0, 2, 4}, [&](int i) {
    const int value = read_little<std::int16_t>(at + i);
    return value == 32767 || value == -32768;
  });
}

Eigen::Vector4d from_angles(const std::uint8_t* at) {
  const Vec3 rad = read_vector(at, kPi);
  return orientation_from_z_up(from_roll_pitch_yaw(rad[0], rad[1], rad[2]));
}

std::int16_t scaled(double value, double range) {
  if (!std::isfinite(value)) return 0;
  return static_cast<std::int16_t>(
      std::clamp(std::round(value / range * kFullScale), -32768.0, 32767.0));
}

void append_vector(Bytes& out, const Vec3& v, double range) {
  for (const double x : v) append_little(out, scaled(x, range));
}

// roll, pitch, yaw in rad
Vec3 angles_of(const Sample& sample) {
  if (!sample.has_orientation()) return Vec3::Zero();
  const Mat3 R = z_up_from_orientation(sample.orientation).toRotationMatrix();
  return {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
          std::atan2(R(1, 0), R(0, 0))};
}

void require_one(std::string_view driver, const std::vector<std::string>& sensors) {
  if (sensors.size() != 1)
    throw ConfigError("driver " + std::string(driver) + " emulates one sensor, not " +
                      std::to_string(sensors.size()));
}

Bytes command(std::uint8_t reg, unsigned value) {
  return {0xFF, 0xAA, reg, static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8)};
}

unsigned rate_code(const Options& options) {
  const int index = options.choice("rate_hz", {"10", "20", "50", "100", "200"});
  return std::array{0x06u, 0x07u, 0x08u, 0x09u, 0x0Bu}[static_cast<std::size_t>(index)];
}

class Encoder : public StreamEncoder {
 public:
  explicit Encoder(double range_mps2) : range_mps2_(range_mps2) {}

  std::vector<Bytes> encode(std::span<const Sample> samples) override {
    Bytes out;
    for (const auto& sample : samples) {
      if (std::isfinite(sample.time_s)) append_frame(out, kTime, time(sample.time_s));
      append_frame(out, kForce, vector(sample.specific_force, range_mps2_));
      append_frame(out, kTurn, vector(sample.angular_velocity, kGyroscopeRange_radps));
      if (sample.has_orientation()) append_frame(out, kQuaternion, quaternion(sample));
    }
    return {out};
  }

 private:
  static Bytes vector(const Vec3& v, double range) {
    Bytes data;
    append_vector(data, v, range);
    return data;
  }

  static Bytes quaternion(const Sample& sample) {
    const Quat q = z_up_from_orientation(sample.orientation);
    Bytes data;
    for (const double x : {q.w(), q.x(), q.y(), q.z()}) append_little(data, scaled(x, 1.0));
    return data;
  }

  // Time since 2000, which the device sends as a date.
  static Bytes time(double time_s) {
    using namespace std::chrono;
    const auto at = milliseconds(std::llround(std::max(time_s, 0.0) * 1000.0));
    const auto days = floor<std::chrono::days>(at);
    const year_month_day date(sys_days(year(2000) / 1 / 1) + days);
    const hh_mm_ss clock(at - days);
    Bytes data{static_cast<std::uint8_t>(static_cast<int>(date.year()) - 2000),
               static_cast<std::uint8_t>(static_cast<unsigned>(date.month())),
               static_cast<std::uint8_t>(static_cast<unsigned>(date.day())),
               static_cast<std::uint8_t>(clock.hours().count()),
               static_cast<std::uint8_t>(clock.minutes().count()),
               static_cast<std::uint8_t>(clock.seconds().count())};
    append_little(data, static_cast<std::uint16_t>(clock.subseconds().count()));
    return data;
  }

  static void append_frame(Bytes& out, int type, Bytes data) {
    data.resize(8);
    data.insert(data.begin(), {kHeader, static_cast<std::uint8_t>(type)});
    data.push_back(sum_of(data));
    out.insert(out.end(), data.begin(), data.end());
  }

  double range_mps2_;
};

class BleEncoder : public StreamEncoder {
 public:
  explicit BleEncoder(double range_mps2) : range_mps2_(range_mps2) {}

  std::vector<Bytes> encode(std::span<const Sample> samples) override {
    std::vector<Bytes> frames;
    for (const auto& sample : samples) {
      Bytes frame{kHeader, kBleData};
      append_vector(frame, sample.specific_force, range_mps2_);
      append_vector(frame, sample.angular_velocity, kGyroscopeRange_radps);
      append_vector(frame, angles_of(sample), kPi);
      frames.push_back(frame);
    }
    return frames;
  }

 private:
  double range_mps2_;
};

double range_of(const Options& options) {
  return options.number("range_g", 1.0, 1000.0) * kStandardGravity_mps2;
}

}  // namespace

Parser::Parser(const Options& options)
    : range_mps2_(range_of(options)),
      is_scalar_first_(options.choice("quaternion_order", {"wxyz", "xyzw"}) == 0),
      name_(options.text("name")) {
  rate_code(options);
}

void Parser::parse(ByteView bytes) {
  const auto inspect = [&](ByteView head) {
    if (head[0] != kHeader) return Head::skip();
    if (head.size() < kSize) return Head::more();
    if (sum_of(head.first(kSize - 1)) == head[kSize - 1]) return Head::frame(kSize);
    ++count(Count::bad_checksums);
    return Head::skip();
  };
  scanner_.feed(bytes, all_counts(), inspect, [&](ByteView frame) { handle(frame); });
}

void Parser::interrupt() {
  scanner_.reset();
  sample_ = Sample();
  type_ = 0;
  is_repeated_ = is_finished_ = false;
}

void Parser::restart() {
  interrupt();
  clock_ = TickClock(64, 1e-3);
  last_types_ = {};
  next_flags_ = kAfterReset;
}

void Parser::handle(ByteView frame) {
  const int type = frame[1];
  const auto* data = &frame[2];
  if (type < kLowestType || type >= kHighestType) {
    ++count(Count::unknown_types);
    return;
  }
  ++count(Count::frames);
  if (type <= type_) {
    if (!is_finished_) finish();
    last_types_ = {last_types_[1], type_};
    sample_ = Sample();
    is_repeated_ = is_finished_ = false;
  }
  type_ = type;
  if (type == kTime) handle_time(data);
  if (type == kForce) sample_.specific_force = read_vector(data, range_mps2_);
  if (type == kTurn) sample_.angular_velocity = read_vector(data, kGyroscopeRange_radps);
  if ((type == kForce || type == kTurn) && is_at_end(data)) sample_.flags |= kClipped;
  if (type == kAngles) sample_.orientation = from_angles(data);
  if (type == kField) sample_.magnetic_field = read_vector(data, kFullScale);
  if (type == kQuaternion) {
    std::array<double, 4> q;
    for (std::size_t i = 0; i < 4; ++i) q[i] = read_little<std::int16_t>(data + 2 * i) / kFullScale;
    sample_.orientation = orientation_from_z_up(is_scalar_first_ ? Quat(q[0], q[1], q[2], q[3])
                                                                 : Quat(q[3], q[0], q[1], q[2]));
  }
  // As soon as the last frame of a cycle has arrived.
  if (type >= std::ranges::max(last_types_) && last_types_[1] != 0 && !is_finished_) finish();
}

void Parser::handle_time(const std::uint8_t* data) {
  using namespace std::chrono;
  const year_month_day date(year(2000 + data[0]), month(data[1]), day(data[2]));
  if (!date.ok()) return;  // the clock was never set; arrival times are used instead
  const auto since = sys_days(date) - sys_days(year(2000) / 1 / 1);
  const std::int64_t ms = ((since.count() * 24LL + data[3]) * 60 + data[4]) * 60'000 +
                          data[5] * 1000 + read_little<std::uint16_t>(data + 6);
  const auto step = clock_.unwrap(static_cast<std::uint64_t>(ms));
  sample_.time_s = step.time_s;
  is_repeated_ = step.is_repeated;
  if (step.is_restarted) {
    ++count(Count::device_resets);
    next_flags_ |= kAfterReset;
  }
}

void Parser::finish() {
  is_finished_ = true;
  if (type_ == 0) return;
  if (is_repeated_ || !sample_.has_specific_force()) {
    ++count(is_repeated_ ? Count::repeated : Count::incomplete);
    return;
  }
  if (sensor_names().empty()) add_sensor(name_);
  sample_.flags |= std::exchange(next_flags_, 0u);
  emit(sample_);
}

BleParser::BleParser(const Options& options)
    : range_mps2_(range_of(options)), name_(options.text("name")) {
  rate_code(options);
}

void BleParser::parse(ByteView bytes) {
  scanner_.feed(
      bytes, all_counts(), [&](ByteView head) { return inspect(head); },
      [&](ByteView frame) { handle(frame); });
}

void BleParser::interrupt() {
  scanner_.reset();
  is_locked_ = false;
}

void BleParser::restart() {
  interrupt();
  next_flags_ = kAfterReset;
}

Head BleParser::inspect(ByteView head) {
  const auto is_header = [&](std::size_t at) {
    return head[at] == kHeader && (head[at + 1] == kBleData || head[at + 1] == kBleReply);
  };
  if (head.size() < 2 && head[0] == kHeader) return Head::more();
  if (head[0] != kHeader || !is_header(0)) {
    is_locked_ = false;
    return Head::skip();
  }
  if (head.size() < (is_locked_ ? kBleSize : kBleSize + 2)) return Head::more();
  if (!is_locked_ && !is_header(kBleSize)) return Head::skip();
  is_locked_ = true;
  return Head::frame(kBleSize);
}

void BleParser::handle(ByteView frame) {
  ++count(Count::frames);
  if (frame[1] != kBleData) return;
  Sample sample;
  sample.specific_force = read_vector(&frame[2], range_mps2_);
  sample.angular_velocity = read_vector(&frame[8], kGyroscopeRange_radps);
  sample.orientation = from_angles(&frame[14]);
  if (is_at_end(&frame[2]) || is_at_end(&frame[8])) sample.flags |= kClipped;
  if (sensor_names().empty()) add_sensor(name_);
  sample.flags |= std::exchange(next_flags_, 0u);
  emit(sample);
}

std::vector<OptionSpec> Parser::options() {
  return {{"name", "witmotion", "name of the sensor"},
          {"rate_hz", "100", "samples a second: 10, 20, 50, 100 or 200 (10 at 9600 baud)"},
          {"range_g", "16", "full scale of the accelerometer in g"},
          {"quaternion_order", "wxyz", "order of the quaternion's numbers: wxyz or xyzw"}};
}

// Unlock, choose what is sent (time, accelerometer, gyroscope, quaternion), choose the rate.
std::vector<Bytes> Parser::start_commands(const Options& options) {
  return {command(0x69, 0xB588), command(0x02, 0x0207), command(0x03, rate_code(options))};
}

std::unique_ptr<StreamEncoder> Parser::make_encoder(const Options& options,
                                                    const std::vector<std::string>& sensors) {
  require_one("witmotion", sensors);
  return std::make_unique<Encoder>(range_of(options));
}

std::vector<OptionSpec> BleParser::options() {
  return {{"name", "witmotion", "name of the sensor"},
          {"rate_hz", "100", "samples a second: 10, 20, 50, 100 or 200"},
          {"range_g", "16", "full scale of the accelerometer in g"}};
}

std::vector<Bytes> BleParser::start_commands(const Options& options) {
  return {command(0x69, 0xB588), command(0x03, rate_code(options))};
}

std::unique_ptr<StreamEncoder> BleParser::make_encoder(const Options& options,
                                                       const std::vector<std::string>& sensors) {
  require_one("witmotion_ble", sensors);
  return std::make_unique<BleEncoder>(range_of(options));
}

}  // namespace sparse_mocap::streams::witmotion
