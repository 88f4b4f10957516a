// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/streams/xsens_data.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "sparse_mocap/streams/orientation.hpp"
#include "sparse_mocap/streams/wire.hpp"

namespace sparse_mocap::streams::xsens {
namespace {

enum Precision : unsigned { kFloat32 = 0, kFixed12_20 = 1, kFixed16_32 = 2, kFloat64 = 3 };
enum class World { east_north_up, north_east_down, north_west_up };

constexpr std::array<std::size_t, 4> kWidths{4, 4, 6, 8};

double read_value(const std::uint8_t* at, Precision precision) {
  switch (precision) {
    case kFloat32:
      return read_big<float>(at);
    case kFixed12_20:
      return read_big<std::int32_t>(at) / 1048576.0;
    case kFixed16_32:  // the fraction comes first
      return read_big<std::int16_t>(at + 4) + read_big<std::uint32_t>(at) / 4294967296.0;
    case kFloat64:
      break;
  }
  return read_big<double>(at);
}

// Reads values one after the other.
class Reader {
 public:
  explicit Reader(ByteView data) : rest_(data) {}

  Eigen::VectorXd values(int num, Precision precision) {
    Eigen::VectorXd values(num);
    for (double& value : values) value = read_value(read_bytes(kWidths[precision]), precision);
    return values;
  }
  const std::uint8_t* read_bytes(std::size_t size) {
    const auto* at = rest_.data();
    rest_ = rest_.subspan(size);
    return at;
  }

 private:
  ByteView rest_;
};

Eigen::Vector4d in_project_world(const Quat& q, World world) {
  return world == World::north_east_down ? orientation_from_z_down(q) : orientation_from_z_up(q);
}

Quat from_quaternion(const Eigen::VectorXd& v) { return {v[0], v[1], v[2], v[3]}; }

Quat from_euler_deg(const Eigen::VectorXd& v) {
  const Vec3 rad = v * kRadiansPerDegree;
  return from_roll_pitch_yaw(rad[0], rad[1], rad[2]);
}

// Column after column, as MT Manager's text names them (Mat[1][1], Mat[2][1], ...).
Quat from_matrix(const Eigen::VectorXd& v) { return Quat(Mat3(Eigen::Map<const Mat3>(v.data()))); }

// A free acceleration is given in the world that the orientation refers to.
void finish(Measured& measured, World world) {
  auto& sample = measured.sample;
  if (sample.has_specific_force() || !sample.has_orientation() ||
      !measured.free_acceleration.allFinite())
    return;
  Sample unturned;
  unturned.orientation = in_project_world(Quat::Identity(), world);
  const Quat R_project_device = rotation_of(unturned);
  restore_gravity(
      sample, rotation_of(sample).conjugate() * (R_project_device * measured.free_acceleration));
}

// The layout of an MTData2 type, without its bits for world and precision; 0 values: not numbers.
struct Field {
  unsigned type;
  int num_values;
};

constexpr unsigned kPacketCounter = 0x1020, kSampleTimeFine = 0x1060, kQuaternion = 0x2010,
                   kMatrix = 0x2020, kEuler = 0x2030, kAcceleration = 0x4020,
                   kFreeAcceleration = 0x4030, kRateOfTurn = 0x8020, kMagneticField = 0xC020,
                   kStatusWord = 0xE020;
constexpr std::array kMotionFields{
    Field{kQuaternion, 4},    Field{kMatrix, 9},           Field{kEuler, 3},
    Field{kAcceleration, 3},  Field{kFreeAcceleration, 3}, Field{kRateOfTurn, 3},
    Field{kMagneticField, 3},
};
// Known but not used: temperature, times, pressure, increments, position, velocity, GNSS,
// raw data, status.
constexpr std::array<unsigned, 26> kUnusedTypes{
    0x0810, 0x1010, 0x1030, 0x1040, 0x1050, 0x1070, 0x1080, 0x3010, 0x4010,
    0x4040, 0x5010, 0x5020, 0x5030, 0x5040, 0x7010, 0x7020, 0x8030, 0x8040,
    0xA010, 0xA020, 0xC010, 0xD010, 0xE010, 0xE030, 0xE040, 0x4050};
constexpr std::uint32_t kClipFlags = 0x3F00;  // of the status word: accelerometer and gyroscope

bool handle_numbers(Measured& out, unsigned type, const Eigen::VectorXd& v, World world) {
  auto& sample = out.sample;
  switch (type) {
    case kQuaternion:
      sample.orientation = in_project_world(from_quaternion(v), world);
      break;
    case kMatrix:
      sample.orientation = in_project_world(from_matrix(v), world);
      break;
    case kEuler:
      sample.orientation = in_project_world(from_euler_deg(v), world);
      break;
    case kAcceleration:
      sample.specific_force = v;
      break;
    case kFreeAcceleration:
      out.free_acceleration = v;
      break;
    case kRateOfTurn:
      sample.angular_velocity = v;
      break;
    default:
      sample.magnetic_field = v;
  }
  return v.allFinite();
}

// Whether the field is valid for its type. Types that are not used are skipped.
bool handle_field(Measured& out, unsigned id, ByteView data, World world) {
  const unsigned type = id & 0xFFF0u;
  for (const auto& field : kMotionFields) {
    if (field.type != type) continue;
    const auto precision = static_cast<Precision>(id & 3u);
    if (data.size() != kWidths[precision] * static_cast<std::size_t>(field.num_values))
      return false;
    return handle_numbers(out, type, Reader(data).values(field.num_values, precision), world);
  }
  if (type == kPacketCounter) {
    if (data.size() != 2) return false;
    out.counter = read_big<std::uint16_t>(data.data());
  } else if (type == kSampleTimeFine) {
    if (data.size() != 4) return false;
    out.time_fine = read_big<std::uint32_t>(data.data());
  } else if (type == kStatusWord) {
    if (data.size() != 4) return false;
    if (read_big<std::uint32_t>(data.data()) & kClipFlags) out.sample.flags |= kClipped;
  } else if (std::ranges::find(kUnusedTypes, type) == kUnusedTypes.end()) {
    ++out.num_unknown;
  }
  return true;
}

World world_of(unsigned id) {
  const unsigned bits = id & 0xCu;
  return bits == 0x4 ? World::north_east_down
                     : (bits == 0x8 ? World::north_west_up : World::east_north_up);
}

constexpr unsigned kModeTemperature = 0x0001, kModeAuxiliary = 0x0008, kModePosition = 0x0010,
                   kModeVelocity = 0x0020, kModeStatus = 0x0800, kModeRawGps = 0x1000,
                   kModeRaw = 0x4000;
constexpr unsigned kSettingsUtc = 0x0002, kSettingsEuler = 0x0004, kSettingsMatrix = 0x0008,
                   kSettingsNoForce = 0x0010, kSettingsNoTurn = 0x0020, kSettingsNoField = 0x0040,
                   kSettingsNoAux1 = 0x0400, kSettingsNoAux2 = 0x0800,
                   kSettingsNorthEastDown = 0x80000000;

Precision precision_of(unsigned settings) { return static_cast<Precision>((settings >> 8) & 3u); }

int num_orientation_values(unsigned settings) {
  return settings & kSettingsEuler ? 3 : (settings & kSettingsMatrix ? 9 : 4);
}

// Bytes before the calibrated data, and of all numbers; what follows is in length().
std::size_t raw_length(unsigned mode) {
  return (mode & kModeRaw ? 20u : 0u) + (mode & kModeRawGps ? 44u : 0u);
}

void handle_calibrated(Sample& sample, Reader& reader, const Layout& layout) {
  const auto precision = precision_of(layout.settings);
  if (!(layout.settings & kSettingsNoForce)) sample.specific_force = reader.values(3, precision);
  if (!(layout.settings & kSettingsNoTurn)) sample.angular_velocity = reader.values(3, precision);
  if (!(layout.settings & kSettingsNoField)) sample.magnetic_field = reader.values(3, precision);
}

}  // namespace

std::optional<Measured> read_data2(ByteView data) {
  Measured out;
  World world = World::east_north_up;
  while (!data.empty()) {
    if (data.size() < 3) return std::nullopt;
    const unsigned id = read_big<std::uint16_t>(data.data());
    const std::size_t size = data[2];
    if (data.size() < 3 + size) return std::nullopt;
    if ((id & 0xF800u) == 0x2000u || (id & 0xFFF0u) == kFreeAcceleration) world = world_of(id);
    if (!handle_field(out, id, data.subspan(3, size), world_of(id))) return std::nullopt;
    data = data.subspan(3 + size);
  }
  finish(out, world);
  return out;
}

std::size_t Layout::length() const {
  const std::size_t width = kWidths[precision_of(settings)];
  std::size_t values = mode & kModeTemperature ? 1u : 0u, bytes = raw_length(mode);
  if (mode & kModeCalibrated)
    for (const unsigned absent : {kSettingsNoForce, kSettingsNoTurn, kSettingsNoField})
      values += settings & absent ? 0u : 3u;
  if (mode & kModeOrientation) values += static_cast<std::size_t>(num_orientation_values(settings));
  if (mode & kModePosition) values += 3;
  if (mode & kModeVelocity) values += 3;
  if (mode & kModeAuxiliary)
    for (const unsigned absent : {kSettingsNoAux1, kSettingsNoAux2})
      bytes += settings & absent ? 0u : 2u;
  if (mode & kModeStatus) bytes += 1;
  if (settings & kSettingsCounter) bytes += 2;
  if (settings & kSettingsUtc) bytes += 12;
  return values * width + bytes;
}

std::optional<Measured> read_data(ByteView block, const Layout& layout) {
  if (block.size() != layout.length()) return std::nullopt;
  Measured out;
  Reader reader(block);
  const auto precision = precision_of(layout.settings);
  reader.read_bytes(raw_length(layout.mode));
  if (layout.mode & kModeTemperature) reader.values(1, precision);
  if (layout.mode & kModeCalibrated) handle_calibrated(out.sample, reader, layout);
  if (layout.mode & kModeOrientation) {
    const auto v = reader.values(num_orientation_values(layout.settings), precision);
    const Quat q =
        v.size() == 4 ? from_quaternion(v) : (v.size() == 3 ? from_euler_deg(v) : from_matrix(v));
    out.sample.orientation =
        in_project_world(q, layout.settings & kSettingsNorthEastDown ? World::north_east_down
                                                                     : World::north_west_up);
  }
  if (layout.settings & kSettingsCounter) {
    const std::size_t after = layout.settings & kSettingsUtc ? 12 : 0;
    out.counter = read_big<std::uint16_t>(block.data() + block.size() - after - 2);
  }
  return out;
}

}  // namespace sparse_mocap::streams::xsens
