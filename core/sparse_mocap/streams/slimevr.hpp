// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>

#include "sparse_mocap/streams/framing.hpp"
#include "sparse_mocap/streams/options.hpp"

namespace sparse_mocap::streams::slimevr {

// SlimeVR trackers, acting as their server: big-endian datagrams [i32 type][i64 number][body] (and
// bundles of such without numbers). Trackers send their rotation and the acceleration without
// gravity; each acceleration makes a sample, with gravity added using the newest rotation.
//
// feed() accepts recorded datagrams, each as [u16 length][datagram], from one sender.
class Parser : public StreamParser {
 public:
  explicit Parser(const Options& options);

  void interrupt() override { scanner_.reset(); }

  static std::vector<OptionSpec> options();
  static std::vector<Bytes> keep_alive(const Options& options);
  static std::unique_ptr<StreamEncoder> make_encoder(const Options& options,
                                                     const std::vector<std::string>& sensors);

 private:
  struct Tracker {
    std::string name;
    std::optional<std::int64_t> last_number;
    std::map<int, int> sensors;  // from the tracker's number to the parser's index
    std::map<int, Eigen::Vector4d> orientations;
    unsigned next_flags = 0;
  };

  void parse(ByteView bytes) override;
  void parse_datagram(ByteView datagram, std::string_view sender) override;
  void restart() override;
  bool handle_number(std::int64_t number, Tracker& tracker);
  void handle_handshake(ByteView body, Tracker& tracker);
  void handle_bundle(ByteView body, bool is_compact, Tracker& tracker);
  void handle_packet(std::int32_t type, ByteView body, Tracker& tracker);
  void handle_rotation(int sensor, const Quat& rotation, Tracker& tracker);
  void handle_acceleration(int sensor, const Vec3& linear_acceleration, Tracker& tracker);

  FrameScanner scanner_;
  std::map<std::string, Tracker, std::less<>> trackers_;  // by sender
};

}  // namespace sparse_mocap::streams::slimevr
