// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "sparse_mocap/streams/framing.hpp"
#include "sparse_mocap/streams/options.hpp"
#include "sparse_mocap/streams/unwrap.hpp"

namespace sparse_mocap::streams::witmotion {

// WIT standard protocol: 55 type 8 data sum; the sum is that of the ten bytes before. One sample is
// several frames of rising type: 50 time, 51 accelerometer, 52 gyroscope, 53 angles, 54 magnetic
// field, 59 quaternion. Numbers are little-endian.
class Parser : public StreamParser {
 public:
  explicit Parser(const Options& options);

  void interrupt() override;

  static std::vector<OptionSpec> options();
  static std::vector<Bytes> start_commands(const Options& options);
  static std::unique_ptr<StreamEncoder> make_encoder(const Options& options,
                                                     const std::vector<std::string>& sensors);

 private:
  void parse(ByteView bytes) override;
  void restart() override;
  void handle(ByteView frame);
  void handle_time(const std::uint8_t* data);
  void finish();

  FrameScanner scanner_{11};
  double range_mps2_;
  bool is_scalar_first_;
  std::string name_;
  TickClock clock_{64, 1e-3};
  Sample sample_;
  bool is_repeated_ = false;
  unsigned next_flags_ = 0;
  int type_ = 0;                     // the newest frame's of this cycle; 0: none
  std::array<int, 2> last_types_{};  // last frame types of the two previous cycles
  bool is_finished_ = false;
};

// WT901BLE and its kin: 55 61, then accelerometer, gyroscope and angles as 9 numbers. There is no
// checksum, so a frame counts only where another header follows it, or follows one that did.
class BleParser : public StreamParser {
 public:
  explicit BleParser(const Options& options);

  void interrupt() override;

  static std::vector<OptionSpec> options();
  static std::vector<Bytes> start_commands(const Options& options);
  static std::unique_ptr<StreamEncoder> make_encoder(const Options& options,
                                                     const std::vector<std::string>& sensors);

 private:
  void parse(ByteView bytes) override;
  void restart() override;
  Head inspect(ByteView head);
  void handle(ByteView frame);

  FrameScanner scanner_{22};
  double range_mps2_;
  std::string name_;
  bool is_locked_ = false;
  unsigned next_flags_ = 0;
};

}  // namespace sparse_mocap::streams::witmotion
