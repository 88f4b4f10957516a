// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "sparse_mocap/streams/framing.hpp"
#include "sparse_mocap/streams/options.hpp"
#include "sparse_mocap/streams/unwrap.hpp"
#include "sparse_mocap/streams/xsens_data.hpp"
#include "sparse_mocap/streams/xsens_frames.hpp"

namespace sparse_mocap::streams::xsens {

// MTi, MTx, MTw: MTData2, or MTData of one MT or of several on an Xbus Master. The layout of MTData
// comes from the device's Configuration message (requested by start_commands) or from the options.
class Parser : public StreamParser {
 public:
  explicit Parser(const Options& options);

  void interrupt() override { scanner_.reset(); }

  static std::vector<OptionSpec> options();
  static std::vector<Bytes> start_commands(const Options& options);
  static std::unique_ptr<StreamEncoder> make_encoder(const Options& options,
                                                     const std::vector<std::string>& sensors);

 private:
  struct Device {
    int sensor = 0;
    PacketCounter counter{16};
    TickClock clock{32, 1e-4};
    unsigned next_flags = 0;
  };
  struct Block {
    Layout layout;
    std::size_t length = 0;
  };

  void parse(ByteView bytes) override;
  void restart() override;
  void handle(const Message& message);
  void handle_device_id(const Message& message);
  void handle_configuration(ByteView data);
  bool add_block(ByteView device);
  void handle_data2(const Message& message);
  void handle_data(ByteView data);
  void request_configuration();
  void handle_bus_data(ByteView data);
  void handle_measured(Device& device, const Measured& measured);
  Device* device_at(int address);
  void configure_by_options();

  FrameScanner scanner_{kLongestFrame};
  std::map<int, Device> devices_;     // by bus address
  std::map<int, std::string> names_;  // sent by the devices, by bus address
  std::vector<Block> blocks_;         // of an MTData message; empty: unconfigured
  std::optional<PacketCounter> bus_counter_;
  double tick_s_;
  double period_s_;  // 0: unknown
  double configured_period_s_;
  std::optional<Layout> configured_layout_;
};

}  // namespace sparse_mocap::streams::xsens
