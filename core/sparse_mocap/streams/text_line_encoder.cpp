// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <utility>

#include "sparse_mocap/streams/orientation.hpp"
#include "sparse_mocap/streams/text_fields.hpp"
#include "sparse_mocap/streams/text_line.hpp"

namespace sparse_mocap::streams::text_line {
namespace {

constexpr double kWrap = 4294967296.0;

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
      append_text(line, kColumnNames[static_cast<std::size_t>(column)]);
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
