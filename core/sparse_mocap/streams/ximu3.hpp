// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "sparse_mocap/streams/framing.hpp"
#include "sparse_mocap/streams/options.hpp"
#include "sparse_mocap/streams/unwrap.hpp"

namespace sparse_mocap::streams::ximu3 {

// x-IMU3: messages that end in '\n', as text (I,time in us,values) or binary (the letter + 0x80,
// time as u64, values as f32, little-endian, bytes 0A and DB escaped); '^' and a channel before
// either is the message of another device. The inertial message (g, deg/s) makes a sample;
// orientation of the same time, whichever of Q, R, A, L and E carries it, is joined to it.
class Parser : public StreamParser {
 public:
  explicit Parser(const Options& options);

  void interrupt() override { lines_.reset(); }

  static std::vector<OptionSpec> options();
  static std::vector<Bytes> start_commands(const Options& options);
  static std::unique_ptr<StreamEncoder> make_encoder(const Options& options,
                                                     const std::vector<std::string>& sensors);

 private:
  struct Device {
    int sensor = -1;
    std::string name, serial;
    TickClock clock{64, 1e-6};
    std::optional<Sample> pending;  // waits for its orientation
    std::uint64_t inertial_us = 0;
    std::uint64_t orientation_us = 0;
    Eigen::Vector4d orientation = Eigen::Vector4d::Constant(kAbsent);
    bool is_orientation_due = true;  // it followed the previous sample
    unsigned next_flags = 0;
  };

  void parse(ByteView bytes) override;
  void restart() override;
  void handle(ByteView message, char channel);
  void handle_text(ByteView message, Device& device);
  void handle_binary(ByteView message, Device& device);
  void handle_reply(std::string_view text, Device& device);
  void handle_values(char id, std::uint64_t time_us, std::span<const double> values,
                     Device& device);
  void handle_inertial(std::uint64_t time_us, std::span<const double> values, Device& device);
  void handle_orientation(std::uint64_t time_us, const Eigen::Vector4d& value, Device& device);
  void finish(Device& device);

  LineSplitter lines_;
  std::map<char, Device> devices_;  // by channel; '\0': the port itself
  std::string name_;
};

}  // namespace sparse_mocap::streams::ximu3
