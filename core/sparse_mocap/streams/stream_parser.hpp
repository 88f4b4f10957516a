// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sparse_mocap/streams/counters.hpp"
#include "sparse_mocap/streams/sample.hpp"

namespace sparse_mocap::streams {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

// Turns a device's bytes into samples, without input or output of its own.
//
// Samples and counters do not depend on how the bytes are split into pieces. Memory is bounded for
// any input. What cannot be used is dropped and counted, never guessed.
class StreamParser {
 public:
  StreamParser() = default;
  StreamParser(const StreamParser&) = delete;
  StreamParser& operator=(const StreamParser&) = delete;
  virtual ~StreamParser() = default;

  // Appends the samples completed by these bytes.
  void feed(ByteView bytes, std::vector<Sample>& samples);

  // The same for one datagram; sender identifies devices that share a socket ("10.0.0.7:6969").
  void feed_datagram(ByteView datagram, std::string_view sender, std::vector<Sample>& samples);

  // The connection was opened again: forgets the unfinished message and the device's clocks and
  // configuration. Sensors keep their indices, counters continue.
  void reset();

  // After reset(): the line was idle long enough that the next byte starts a message.
  virtual void begin_message() {}

  // Bytes are missing before the next ones: forgets the unfinished message, but keeps the device's
  // configuration.
  virtual void interrupt() = 0;

  const Counters& counters() const { return counters_; }
  // In the order in which the sensors appeared. A name may change when the device sends its own.
  const std::vector<std::string>& sensor_names() const { return sensor_names_; }
  // What the devices call themselves wherever they are plugged in, such as a serial number or MAC;
  // empty for a protocol without such.
  const std::vector<std::string>& sensor_ids() const { return sensor_ids_; }
  // Percent; NaN: unknown.
  const std::vector<double>& sensor_batteries() const { return sensor_batteries_; }
  // The device's last text message, such as an error; empty: none.
  const std::string& last_message() const { return last_message_; }
  // Answers that the protocol requires; for datagrams, to the sender of the one just fed.
  std::vector<Bytes> pop_replies();

 protected:
  static constexpr std::size_t kMostSensors = 256;

  virtual void parse(ByteView bytes) = 0;
  virtual void parse_datagram(ByteView datagram, std::string_view sender);
  virtual void restart() = 0;

  // The index of a new sensor, -1 when there are too many (which is counted).
  int add_sensor(const std::string& name, const std::string& id = {});
  void rename_sensor(int sensor, const std::string& name, const std::string& id);
  void set_battery(int sensor, double percent);
  // Outputs a sample unless it is implausible.
  void emit(const Sample& sample);
  void set_message(std::string_view message);
  void reply(Bytes bytes);
  std::uint64_t& count(Count what) { return counters_[what]; }
  Counters& all_counts() { return counters_; }

 private:
  Counters counters_;
  std::vector<std::string> sensor_names_, sensor_ids_;
  std::vector<double> sensor_batteries_;
  std::string last_message_;
  std::vector<Bytes> replies_;
  std::vector<Sample>* samples_ = nullptr;
};

// The opposite direction: what a device would send. For emulators and tests.
class StreamEncoder {
 public:
  StreamEncoder() = default;
  StreamEncoder(const StreamEncoder&) = delete;
  StreamEncoder& operator=(const StreamEncoder&) = delete;
  virtual ~StreamEncoder() = default;

  // What a device sends when it starts.
  virtual std::vector<Bytes> hello() { return {}; }
  // The samples of one instant, at most one per sensor, as packets (datagrams, or to be joined).
  // Absent values are sent as zeros, absent orientations as the identity.
  virtual std::vector<Bytes> encode(std::span<const Sample> samples) = 0;
  // The device's answer to what a host sends.
  virtual Bytes respond(ByteView) { return {}; }
};

}  // namespace sparse_mocap::streams
