// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/streams/text_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/nearest_name.hpp"
#include "sparse_mocap/base/text_scanner.hpp"
#include "sparse_mocap/streams/orientation.hpp"
#include "sparse_mocap/streams/text_fields.hpp"

namespace sparse_mocap::streams::text_line {
namespace {

constexpr std::array<std::string_view, kNumColumns> kNames{
    "time", "sensor", "counter", "ax", "ay", "az", "gx", "gy",  "gz",
    "mx",   "my",     "mz",      "qw", "qx", "qy", "qz", "skip"};
constexpr double kWrap = 4294967296.0;
constexpr double kLatest = 9e15;  // exactly representable in a double
constexpr std::size_t kLongestName = 64;

std::optional<Column> column_named(std::string_view name) {
  const auto lower = lower_case(name);
  const auto found = std::ranges::find(kNames, lower);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<Column>(found - kNames.begin());
}

bool has(const std::vector<Column>& columns, std::initializer_list<Column> wanted) {
  return std::ranges::all_of(wanted, [&](Column c) { return std::ranges::count(columns, c) == 1; });
}

bool is_printable(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c == '\t' || (c >= ' ' && c <= '~'); });
}

bool is_needed(const std::vector<Column>& columns) {
  return has(columns, {Column::ax, Column::ay, Column::az});
}

double value_of(const ColumnValues& values, Column column) {
  return values[static_cast<std::size_t>(column)];
}

Vec3 vector_of(const ColumnValues& values, Column first) {
  const auto at = static_cast<std::size_t>(first);
  return {values[at], values[at + 1], values[at + 2]};
}

// Whether every field is valid for its column; values of absent columns are NaN.
bool read_fields(const std::vector<std::string_view>& fields, const std::vector<Column>& columns,
                 ColumnValues& values, std::string_view& name) {
  values.fill(kAbsent);
  if (fields.size() != columns.size()) return false;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto column = columns[i];
    if (column == Column::sensor) {
      name = fields[i];
      if (name.empty() || name.size() > kLongestName) return false;
    } else if (column != Column::skip) {
      auto& value = values[static_cast<std::size_t>(column)];
      if (parse_number(fields[i], value) != NumberStatus::ok) return false;
    }
  }
  return true;
}

Sample sample_of(const ColumnValues& values, const Profile& profile) {
  Sample sample;
  const Vec3 force = vector_of(values, Column::ax) * profile.force_scale;
  sample.angular_velocity = vector_of(values, Column::gx) * profile.turn_scale;
  sample.magnetic_field = vector_of(values, Column::mx);
  const Quat q(value_of(values, Column::qw), value_of(values, Column::qx),
               value_of(values, Column::qy), value_of(values, Column::qz));
  if (q.coeffs().allFinite()) sample.orientation = orientation_from_z_up(q);
  sample.specific_force = force;
  if (!profile.is_gravity_included) restore_gravity(sample, force);
  return sample;
}

class Encoder : public StreamEncoder {
 public:
  Encoder(Profile profile, std::vector<std::string> sensors)
      : profile_(std::move(profile)), sensors_(std::move(sensors)) {
    is_header_sent_ = profile_.columns.empty();
    if (is_header_sent_)
      profile_.columns = {Column::time, Column::sensor, Column::ax, Column::ay,
                          Column::az,   Column::gx,     Column::gy, Column::gz};
  }

  std::vector<Bytes> hello() override {
    Bytes line;
    if (!is_header_sent_) {
      append_text(line, "ready\r\n");  // like sketches at start-up; it is dropped as the first line
      return {line};
    }
    for (const auto column : profile_.columns) {
      if (!line.empty()) line.push_back(static_cast<std::uint8_t>(profile_.separator));
      append_text(line, kNames[static_cast<std::size_t>(column)]);
    }
    append_text(line, "\r\n");
    return {line};
  }

  std::vector<Bytes> encode(std::span<const Sample> samples) override {
    Bytes out;
    for (const auto& sample : samples) append_line(out, sample);
    return {out};
  }

 private:
  void append_line(Bytes& out, const Sample& sample) {
    append_text(out, profile_.prefix);
    bool is_first = true;
    for (const auto column : profile_.columns) {
      if (!std::exchange(is_first, false))
        out.push_back(static_cast<std::uint8_t>(profile_.separator));
      append_column(out, column, sample);
    }
    append_text(out, "\r\n");
  }

  void append_column(Bytes& out, Column column, const Sample& sample) {
    const auto index = static_cast<int>(column);
    const auto part = [&](Column first) { return index - static_cast<int>(first); };
    if (column == Column::sensor)
      append_text(out, sensors_.at(static_cast<std::size_t>(sample.sensor)));
    else if (column == Column::skip)
      append_text(out, "0");
    else if (column == Column::time)
      append_number(out, std::fmod(sample.time_s / profile_.time_tick_s, kWrap), 6);
    else if (column == Column::counter)
      append_number(out, static_cast<double>(sample.counter), 0);
    else if (column <= Column::az)
      append_number(out, sample.specific_force[part(Column::ax)] / profile_.force_scale, 6);
    else if (column <= Column::gz)
      append_number(out, sample.angular_velocity[part(Column::gx)] / profile_.turn_scale, 6);
    else if (column <= Column::mz)
      append_number(out, sample.magnetic_field[part(Column::mx)], 6);
    else
      append_number(out, quaternion(sample)[part(Column::qw)], 6);
  }

  static Eigen::Vector4d quaternion(const Sample& sample) {
    if (!sample.has_orientation()) return {1.0, 0.0, 0.0, 0.0};
    const Quat q = z_up_from_orientation(sample.orientation);
    return {q.w(), q.x(), q.y(), q.z()};
  }

  Profile profile_;
  std::vector<std::string> sensors_;
  bool is_header_sent_ = false;
};

}  // namespace

Profile::Profile(const Options& options)
    : prefix(options.text("prefix")), name(options.text("name")) {
  separator = ",\t; "[options.choice("separator", {"comma", "tab", "semicolon", "space"})];
  if (options.text("columns") != "header") {
    for (const auto& column : options.list("columns")) {
      const auto known = column_named(column);
      if (!known)
        options.fail("columns", "'header' or a list of these, of which '" +
                                    std::string(nearest_name(column, kNames)) +
                                    "' is nearest to '" + column + "'");
      columns.push_back(*known);
    }
    if (!is_needed(columns)) options.fail("columns", "a list that has ax, ay and az once each");
  }
  const std::array force{1.0, kStandardGravity_mps2, kStandardGravity_mps2 / 1000.0,
                         kStandardGravity_mps2 / options.number("counts_per_g", 1.0, 1e7)};
  const auto force_unit = options.choice("acceleration_unit", {"m/s2", "g", "mg", "raw"});
  force_scale = force[static_cast<std::size_t>(force_unit)];
  if (options.choice("acceleration_sign", {"+", "-"}) == 1) force_scale = -force_scale;
  const std::array turn{1.0, kRadiansPerDegree,
                        kRadiansPerDegree / options.number("counts_per_degps", 0.01, 1e7)};
  const auto turn_unit = options.choice("angular_velocity_unit", {"rad/s", "deg/s", "raw"});
  turn_scale = turn[static_cast<std::size_t>(turn_unit)];
  const auto time_unit =
      static_cast<std::size_t>(options.choice("time_unit", {"s", "ms", "us", "ns"}));
  time_tick_s = std::array{1.0, 1e-3, 1e-6, 1e-9}[time_unit];
  wraps_after = time_unit == 1 || time_unit == 2 ? kWrap : 0.0;
  is_gravity_included = options.choice("gravity", {"included", "removed"}) == 0;
  if (!is_gravity_included && !columns.empty() &&
      !has(columns, {Column::qw, Column::qx, Column::qy, Column::qz}))
    options.fail("gravity", "included, because gravity cannot be added without qw, qx, qy, qz");
}

Parser::Parser(const Options& options)
    : profile_(options),
      columns_(profile_.columns),
      is_first_line_(options.flag("skip_first_line")),
      skips_first_line_(is_first_line_) {}

void Parser::parse(ByteView bytes) {
  lines_.feed(bytes, all_counts(), [&](ByteView line) { handle(text_of(line)); });
}

void Parser::interrupt() {
  lines_.reset();
  first_line_.clear();
  is_first_line_ = skips_first_line_;
}

void Parser::restart() {
  interrupt();
  columns_ = profile_.columns;
  for (auto& [name, device] : devices_) {
    const int sensor = device.sensor;
    device = Device();
    device.sensor = sensor;
    device.next_flags = kAfterReset;
  }
}

void Parser::handle(std::string_view line) {
  if (std::exchange(is_first_line_, false) && !columns_.empty() && !is_surely_whole(line)) {
    first_line_ = line;
    return;
  }
  if (line.empty()) return;
  if (columns_.empty() && line.starts_with(profile_.prefix) && is_printable(line))
    return handle_header(split_fields(line.substr(profile_.prefix.size()), profile_.separator));
  ColumnValues values;
  std::string_view name;
  if (!read(line, values, name)) {
    ++count(Count::malformed);
    return;
  }
  if (!first_line_.empty()) check_first_line(line, values, name);
  handle_values(values, name);
}

bool Parser::read(std::string_view line, ColumnValues& values, std::string_view& name) const {
  if (!line.starts_with(profile_.prefix) || !is_printable(line)) return false;
  name = profile_.name;
  return read_fields(split_fields(line.substr(profile_.prefix.size()), profile_.separator),
                     columns_, values, name);
}

// A prefix that cannot be part of a number occurs only at the start of a line of numbers; and a
// first column that is skipped may be incomplete.
bool Parser::is_surely_whole(std::string_view line) const {
  const bool has_texts = std::ranges::any_of(
      columns_, [](Column c) { return c == Column::sensor || c == Column::skip; });
  if (profile_.prefix.empty()) return columns_.front() == Column::skip;
  return !has_texts && line.starts_with(profile_.prefix) &&
         profile_.prefix.find_first_not_of(" \t+-.,;eE0123456789") != std::string::npos;
}

// Uses the next line of the same sensor. A number that lost its leading digits is too small by at
// least 10^k, k being the number of remaining digits: more than its own value, and more than any
// step of a counter.
void Parser::check_first_line(std::string_view next_line, const ColumnValues& next,
                              std::string_view name) {
  ColumnValues first;
  std::string_view first_name;
  const bool is_line = read(first_line_, first, first_name);
  if (is_line && first_name != name) return;
  const auto has_point = [&](std::string_view line) {
    return split_fields(line.substr(profile_.prefix.size()), profile_.separator)[0].find('.') !=
           std::string_view::npos;
  };
  const auto column = columns_.front();
  const double step = value_of(next, column) - value_of(first, column);
  const bool counts_on = (column == Column::counter && step == 1.0) ||
                         (column == Column::time && step >= 0.0 && step <= value_of(first, column));
  if (is_line && counts_on && has_point(first_line_) == has_point(next_line))
    handle_values(first, first_name);
  first_line_.clear();
}

void Parser::handle_values(const ColumnValues& values, std::string_view name) {
  ++count(Count::frames);
  auto* device = device_of(name);
  if (device == nullptr) return;
  Sample sample = sample_of(values, profile_);
  sample.sensor = device->sensor;
  const double counter = value_of(values, Column::counter), time = value_of(values, Column::time);
  if (!std::isnan(counter) && !handle_counter(counter, *device, sample)) return;
  if (!std::isnan(time) && !handle_time(time, *device, sample)) return;
  sample.flags |= std::exchange(device->next_flags, 0u);
  emit(sample);
}

// Columns with unknown names are skipped; without ax, ay, az the line is not a header.
void Parser::handle_header(const std::vector<std::string_view>& fields) {
  std::vector<Column> columns;
  for (const auto& field : fields) columns.push_back(column_named(field).value_or(Column::skip));
  const bool has_orientation = has(columns, {Column::qw, Column::qx, Column::qy, Column::qz});
  if (!is_needed(columns) || (!profile_.is_gravity_included && !has_orientation))
    ++count(Count::unconfigured);
  else
    columns_ = columns;
}

bool Parser::handle_time(double value, Device& device, Sample& sample) {
  if (value < 0.0 || value > kLatest) {
    ++count(Count::implausible);
    return false;
  }
  double step = value - device.last_time;
  if (step < -kWrap / 2 && profile_.wraps_after > 0.0 && device.last_time < kWrap) step += kWrap;
  if (step == 0.0) {
    ++count(Count::repeated);
    return false;
  }
  if (step < 0.0) {
    ++count(Count::device_resets);
    device.next_flags |= kAfterReset;
    step = device.last_step;
  }
  if (std::isnan(step)) {
    device.time = value;
  } else {
    device.time += step;
    device.last_step = step;
  }
  device.last_time = value;
  sample.time_s = device.time * profile_.time_tick_s;
  return true;
}

bool Parser::handle_counter(double value, Device& device, Sample& sample) {
  if (value < 0.0 || value > kLatest || value != std::floor(value)) {
    ++count(Count::malformed);
    return false;
  }
  const auto step = device.counter.unwrap(static_cast<std::uint64_t>(value));
  count(Count::missing_samples) += static_cast<std::uint64_t>(step.missing);
  if (step.missing > 0) device.next_flags |= kAfterGap;
  if (step.is_backwards) device.next_flags |= kAfterReset;
  if (step.is_backwards) ++count(Count::out_of_order);
  if (step.is_repeated) ++count(Count::repeated);
  sample.counter = step.counter;
  return !step.is_backwards && !step.is_repeated;
}

Parser::Device* Parser::device_of(std::string_view name) {
  const auto known = devices_.find(name);
  if (known != devices_.end()) return &known->second;
  const int sensor = add_sensor(std::string(name));
  if (sensor < 0) return nullptr;
  auto& device = devices_[std::string(name)];
  device.sensor = sensor;
  return &device;
}

std::vector<OptionSpec> Parser::options() {
  return {
      {"name", "text", "name of the sensor, when no column has it"},
      {"separator", "comma", "comma, tab, semicolon or space"},
      {"columns", "ax,ay,az,gx,gy,gz",
       "'header' if the device sends a header line, or a list of time, sensor, counter, "
       "ax..az, gx..gz, mx..mz, qw..qz, skip"},
      {"prefix", "", "start of every data line"},
      {"acceleration_unit", "m/s2", "m/s2, g, mg or raw"},
      {"counts_per_g", "16384", "for raw: 16384, 8192, 4096, 2048 at +-2, 4, 8, 16 g (MPU6050)"},
      {"acceleration_sign", "+", "'-' for a device that reads -1 g on the axis that points up"},
      {"gravity", "included", "included, or removed (then qw..qz are needed to add it)"},
      {"angular_velocity_unit", "deg/s", "rad/s, deg/s or raw"},
      {"counts_per_degps", "131",
       "for raw: 131, 65.5, 32.8, 16.4 at +-250 to 2000 deg/s (MPU6050)"},
      {"time_unit", "us", "s, ms, us or ns; ms and us may wrap at 2^32"},
      {"skip_first_line", "true",
       "true: the first line may be incomplete; it is used only when it is certainly complete"},
      {"start_text", "", "text to send to a device that waits for it before it starts"},
  };
}

std::vector<Bytes> Parser::start_commands(const Options& options) {
  const auto& text = options.text("start_text");
  if (text.empty()) return {};
  return {Bytes(text.begin(), text.end())};
}

std::unique_ptr<StreamEncoder> Parser::make_encoder(const Options& options,
                                                    const std::vector<std::string>& sensors) {
  Profile profile(options);
  const bool names_sensors =
      profile.columns.empty() || std::ranges::count(profile.columns, Column::sensor) == 1;
  if (sensors.size() != 1 && !names_sensors)
    options.fail("columns", "a list with 'sensor' to emulate several sensors");
  if (!profile.is_gravity_included) options.fail("gravity", "included for the emulator");
  return std::make_unique<Encoder>(std::move(profile), sensors);
}

}  // namespace sparse_mocap::streams::text_line
