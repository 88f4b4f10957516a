// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "sparse_mocap/streams/framing.hpp"
#include "sparse_mocap/streams/options.hpp"

namespace sparse_mocap::streams::slimevr {

// SlimeVR trackers and owoTrack phones, acting as their server: big-endian datagrams [i32 type]
// [i64 number][body] (and bundles of such without numbers). Trackers send their rotation and the
// acceleration without gravity; each acceleration makes a sample, with gravity added using the
// newest rotation.
//
// A tracker is known by the MAC in its greeting, whatever address it sends from; before a greeting
// nothing of it is used. Where there are too many trackers, the one that was silent for longest
// goes. While a tracker is still it sends nothing but answers to keep_alive(); then its last
// orientation is repeated, without acceleration.
//
// feed() accepts recorded datagrams, each as [u16 length][datagram], from one sender.
class Parser : public StreamParser {
 public:
  static constexpr std::size_t kMostTrackers = 32;

  explicit Parser(const Options& options);

  void interrupt() override { scanner_.reset(); }

  static std::vector<OptionSpec> options();
  static std::vector<Bytes> keep_alive(const Options& options);
  static std::unique_ptr<StreamEncoder> make_encoder(const Options& options,
                                                     const std::vector<std::string>& sensors);

 private:
  struct Part {
    int sensor = -1;     // the parser's index; -1: it has sent no acceleration yet
    int num_silent = 0;  // answers to keep_alive() since the last acceleration
    std::optional<Eigen::Vector4d> orientation;
  };
  struct Tracker {
    std::string name;  // its MAC
    std::int32_t protocol = 0;
    std::optional<std::int64_t> last_number;
    std::map<int, Part> parts;  // by the tracker's number
    unsigned next_flags = 0;
    double battery = kAbsent;
    std::uint64_t heard = 0;  // when, in datagrams
  };

  void parse(ByteView bytes) override;
  void parse_datagram(ByteView datagram, std::string_view sender) override;
  void restart() override;
  void handle_handshake(ByteView body, std::string_view sender);
  Tracker* tracker_named(const std::string& mac, std::string_view sender);
  bool handle_number(std::int64_t number, Tracker& tracker);
  void handle_bundle(ByteView body, bool is_compact, Tracker& tracker);
  void handle_packet(std::int32_t type, ByteView body, Tracker& tracker);
  void handle_rotation(int part, const Quat& rotation, Tracker& tracker);
  void handle_acceleration(int part, const Vec3& linear_acceleration, Tracker& tracker);
  void handle_sign_of_life(Tracker& tracker);
  void handle_battery(double level, Tracker& tracker);
  bool has_sensor(int number, Part& part, Tracker& tracker);
  void emit_sample(const Part& part, const Vec3& linear_acceleration, Tracker& tracker);

  FrameScanner scanner_;
  std::set<std::string> allowed_;                         // MACs; empty: all
  std::map<std::string, Tracker> trackers_;               // by MAC
  std::map<std::string, std::string, std::less<>> macs_;  // by sender
  std::uint64_t num_datagrams_ = 0;
};

}  // namespace sparse_mocap::streams::slimevr
