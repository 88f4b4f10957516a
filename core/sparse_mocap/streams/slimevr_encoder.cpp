// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>

#include "sparse_mocap/streams/orientation.hpp"
#include "sparse_mocap/streams/slimevr.hpp"
#include "sparse_mocap/streams/slimevr_packets.hpp"

namespace sparse_mocap::streams::slimevr {
namespace {

float finite_float(double value) { return std::isfinite(value) ? static_cast<float>(value) : 0.0f; }

// One tracker with several sensors.
class Encoder : public StreamEncoder {
 public:
  explicit Encoder(const std::string& name) : mac_(mac_of(name)) {}

  std::vector<Bytes> hello() override {
    Bytes packet = header(kHandshake, 0);
    for (int i = 0; i < 6; ++i) append_big(packet, std::int32_t{0});
    append_big(packet, kTurnedBefore);  // version of the protocol
    packet.push_back(0);                // no firmware name
    packet.insert(packet.end(), mac_.begin(), mac_.end());
    return {packet};
  }

  std::vector<Bytes> encode(std::span<const Sample> samples) override {
    std::vector<Bytes> datagrams;
    for (const auto& sample : samples) {
      Sample upright = sample;
      if (!sample.has_orientation()) upright.orientation = orientation_from_z_up(Quat::Identity());
      datagrams.push_back(rotation(upright));
      datagrams.push_back(acceleration(upright));
    }
    return datagrams;
  }

 private:
  Bytes rotation(const Sample& sample) {
    Bytes packet = header(kRotation, ++number_);
    packet.push_back(static_cast<std::uint8_t>(sample.sensor));
    packet.push_back(kNormalRotation);
    const Quat q = z_up_from_orientation(sample.orientation);
    for (const double x : {q.x(), q.y(), q.z(), q.w()}) append_big(packet, finite_float(x));
    packet.push_back(0);
    return packet;
  }

  Bytes acceleration(const Sample& sample) {
    Bytes packet = header(kAcceleration, ++number_);
    for (const double x : without_gravity(sample)) append_big(packet, finite_float(x));
    packet.push_back(static_cast<std::uint8_t>(sample.sensor));
    return packet;
  }

  // A locally administered address for each name (FNV-1a).
  static std::array<std::uint8_t, 6> mac_of(const std::string& name) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char c : name) hash = (hash ^ static_cast<std::uint8_t>(c)) * 0x100000001b3;
    std::array<std::uint8_t, 6> mac{0x02};
    for (std::size_t i = 1; i < mac.size(); ++i)
      mac[i] = static_cast<std::uint8_t>(hash >> (8 * i));
    return mac;
  }

  std::array<std::uint8_t, 6> mac_;
  std::int64_t number_ = 0;
};

}  // namespace

std::unique_ptr<StreamEncoder> Parser::make_encoder(const Options&,
                                                    const std::vector<std::string>& sensors) {
  return std::make_unique<Encoder>(sensors.front());
}

}  // namespace sparse_mocap::streams::slimevr
