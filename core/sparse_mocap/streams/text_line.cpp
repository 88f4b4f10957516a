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
#include "sparse_mocap/streams/text_header.hpp"

namespace sparse_mocap::streams::text_line {
namespace {

constexpr double kWrap = 4294967296.0;
constexpr double kLatest = 9e15;  // exactly representable in a double
constexpr std::size_t kLongestName = 64;

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

}  // namespace

Profile::Profile(const Options& options)
    : prefix(options.text("prefix")), name(options.text("name")) {
  separator = ",\t; "[options.choice("separator", {"comma", "tab", "semicolon", "space"})];
  if (options.text("columns") != "header") {
    for (const auto& column : options.list("columns")) {
      const auto known = column_named(column);
      if (!known)
        options.fail("columns", "'header' or a list of these, of which '" +
                                    std::string(nearest_name(column, kColumnNames)) +
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
  is_gravity_included = options.choice("gravity", {"included", "removed"}) == 0;
  if (!is_gravity_included && !columns.empty() &&
      !has(columns, {Column::qw, Column::qx, Column::qy, Column::qz}))
    options.fail("gravity", "included, because gravity cannot be added without qw, qx, qy, qz");
}

Parser::Parser(const Options& options)
    : profile_(options),
      columns_(profile_.columns),
      time_tick_s_(profile_.time_tick_s),
      is_first_line_(options.flag("skip_first_line")),
      skips_first_line_(is_first_line_) {}

void Parser::parse_datagram(ByteView datagram, std::string_view sender) {
  interrupt();
  sender_ = sender;
  begin_message();
  parse(datagram);
  constexpr std::array<std::uint8_t, 1> kEnd{'\n'};
  if (!datagram.empty() && datagram.back() != kEnd[0]) parse(kEnd);
  sender_.clear();
}

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
  for (const auto& field : fields) columns.push_back(header_column(field).value_or(Column::skip));
  const bool has_orientation = has(columns, {Column::qw, Column::qx, Column::qy, Column::qz});
  if (!is_needed(columns) || (!profile_.is_gravity_included && !has_orientation))
    ++count(Count::unconfigured);
  else
    begin_columns(columns, fields);
}

// A unit in the header, as in Time_ms, wins over the option.
void Parser::begin_columns(const std::vector<Column>& columns,
                           const std::vector<std::string_view>& header) {
  columns_ = columns;
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i] == Column::time) time_tick_s_ = header_tick_s(header[i], profile_.time_tick_s);
}

bool Parser::handle_time(double value, Device& device, Sample& sample) {
  if (value < 0.0 || value > kLatest) {
    ++count(Count::implausible);
    return false;
  }
  double step = value - device.last_time;
  const bool wraps = time_tick_s_ == 1e-3 || time_tick_s_ == 1e-6;  // millis() and micros()
  if (step < -kWrap / 2 && wraps && device.last_time < kWrap) step += kWrap;
  if (step == 0.0) {
    ++count(Count::repeated);
    return false;
  }
  if (step < 0.0 && step * time_tick_s_ > -kSmallStepBack_s) {
    ++count(Count::out_of_order);
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
  sample.time_s = device.time * time_tick_s_;
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
  const bool has_id = std::ranges::count(columns_, Column::sensor) == 1;
  const std::string key(has_id || sender_.empty() ? name : std::string_view(sender_));
  const auto known = devices_.find(key);
  if (known != devices_.end()) return &known->second;
  int sensor = -1;
  if (has_id) {
    sensor = add_sensor(key, key);
  } else {
    const std::string id = address_of(sender_);
    sensor = add_sensor(devices_.empty() ? profile_.name : id, id);
  }
  if (sensor < 0) return nullptr;
  auto& device = devices_[key];
  device.sensor = sensor;
  return &device;
}

// A sender's address, without its port unless another sender has the address too.
std::string Parser::address_of(const std::string& sender) const {
  const std::string host = sender.substr(0, sender.rfind(':'));
  const auto& ids = sensor_ids();
  return std::ranges::find(ids, host) == ids.end() ? host : sender;
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

}  // namespace sparse_mocap::streams::text_line
