// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <memory>

#include "sparse_mocap/streams/framing.hpp"
#include "sparse_mocap/streams/options.hpp"
#include "sparse_mocap/streams/text_header.hpp"
#include "sparse_mocap/streams/unwrap.hpp"

namespace sparse_mocap::streams::text_line {

// By column; NaN where a line has no such column.
using ColumnValues = std::array<double, kNumColumns>;

// The layout and units of a device's lines; throws ConfigError for invalid options.
struct Profile {
  explicit Profile(const Options& options);

  char separator = ',';
  std::string prefix;
  std::vector<Column> columns;  // empty: the device sends a header line
  double force_scale = 1.0;     // to m/s^2
  double turn_scale = 1.0;      // to rad/s
  double time_tick_s = 1.0;
  bool is_gravity_included = true;
  std::string name;
};

// One sample a line of text, as Arduino and ESP32 sketches print them. A line that is not exactly
// as the profile says is dropped: text at start-up, half lines, a repeated header, nan and ovf.
//
// The first line after the port was opened may be incomplete and still look valid. It is used when
// it is certainly complete: the line was idle before it (begin_message), it starts with a prefix
// that cannot be part of a number, or the sensor's next line continues its counter or time. A
// datagram always ends a line; without a column for the sensor, each sender is one.
class Parser : public StreamParser {
 public:
  explicit Parser(const Options& options);

  void begin_message() override { is_first_line_ = false; }
  void interrupt() override;

  static std::vector<OptionSpec> options();
  static std::vector<Bytes> start_commands(const Options& options);
  static std::unique_ptr<StreamEncoder> make_encoder(const Options& options,
                                                     const std::vector<std::string>& sensors);

 private:
  struct Device {
    int sensor = 0;
    PacketCounter counter{63};
    double last_time = kAbsent;  // as the device counts
    double last_step = 1.0;
    double time = kAbsent;
    unsigned next_flags = 0;
  };

  void parse(ByteView bytes) override;
  void parse_datagram(ByteView datagram, std::string_view sender) override;
  void restart() override;
  void handle(std::string_view line);
  bool read(std::string_view line, ColumnValues& values, std::string_view& name) const;
  bool is_surely_whole(std::string_view line) const;
  void check_first_line(std::string_view next_line, const ColumnValues& next,
                        std::string_view name);
  void handle_values(const ColumnValues& values, std::string_view name);
  void handle_header(const std::vector<std::string_view>& fields);
  void begin_columns(const std::vector<Column>& columns,
                     const std::vector<std::string_view>& header);
  bool handle_time(double value, Device& device, Sample& sample);
  bool handle_counter(double value, Device& device, Sample& sample);
  Device* device_of(std::string_view name);
  std::string address_of(const std::string& sender) const;

  Profile profile_;
  std::vector<Column> columns_;
  double time_tick_s_;
  bool is_first_line_;
  bool skips_first_line_;
  std::string first_line_;  // may be incomplete; empty: none
  std::string sender_;      // of the datagram being parsed; empty: none
  LineSplitter lines_;
  std::map<std::string, Device, std::less<>> devices_;
};

}  // namespace sparse_mocap::streams::text_line
