// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a device may send at the edges of its protocol, and what is no device's at all.
#include "streams/stream_test_support.hpp"

namespace sparse_mocap::streams {
namespace {

using namespace testing;

Bytes xsens(const Bytes& body) {
  unsigned sum = 0;
  for (const auto byte : body) sum += byte;
  return joined({{0xFA}, body, {static_cast<std::uint8_t>(256 - sum % 256)}});
}

const std::string kFlat = "40 20 0C 00 00 00 00 00 00 00 00 41 1C F5 C3";

// MTData2 with an extended length: one acceleration, then fields that nobody knows.
Bytes extended(std::size_t size) {
  Bytes data = from_hex(kFlat);
  while (data.size() < size) {
    const std::size_t rest = size - data.size();
    const std::size_t field = rest < 3 + 255 || rest == 3 + 255 ? rest - 3 : 200;
    data += Bytes{0xF0, 0x10, static_cast<std::uint8_t>(field)};
    data += Bytes(field, 0xFA);
  }
  Bytes body{0xFF, 0x36, 0xFF, static_cast<std::uint8_t>(size >> 8),
             static_cast<std::uint8_t>(size)};
  return xsens(joined({body, data}));
}

TEST(Hostile, XsensExtendedLengthsOfAnySize) {
  for (const std::size_t size : {254, 255, 256, 600, 2048}) {
    const auto bytes = extended(size);
    const auto result = parsed("xsens_mt", joined({bytes, bytes}));
    EXPECT_EQ(result.samples.size(), 2u) << size;
    EXPECT_EQ(result[Count::bad_checksums] + result[Count::skipped_bytes], 0u) << size;
    auto damaged = bytes;
    damaged.back() = static_cast<std::uint8_t>(damaged.back() + 1);
    const auto mended = parsed("xsens_mt", joined({damaged, bytes}));
    EXPECT_EQ(mended.samples.size(), 1u) << size;
    EXPECT_GE(mended[Count::bad_checksums], 1u) << size;
  }
}

TEST(Hostile, XsensNumbersOfAnyPrecision) {
  const std::string zeros = "0000000000000000";
  for (const auto& [identifier, size, zero, up] :
       {std::tuple{"4020", "0C", zeros.substr(0, 8), "411CF5C3"},
        std::tuple{"4021", "0C", zeros.substr(0, 8), "009CF5C3"},
        std::tuple{"4022", "12", zeros.substr(0, 12), "CF5C28F60009"},
        std::tuple{"4023", "18", zeros, "40239EB851EB851F"}}) {
    const auto data = from_hex(std::string(identifier) + size + zero + zero + up);
    Bytes body{0xFF, 0x36, static_cast<std::uint8_t>(data.size())};
    const auto result = parsed("xsens_mt", xsens(joined({body, data})));
    ASSERT_EQ(result.samples.size(), 1u) << identifier;
    expect_near(result.samples[0].specific_force, Vec3(0, 0, 9.81), 2e-6);
  }
}

TEST(Hostile, XsensErrorsAreToldInWords) {
  const auto result = parsed("xsens_mt", xsens(from_hex("FF 42 01 04")));
  EXPECT_FALSE(result.message.empty());
}

TEST(Hostile, ValuesThatNoSensorReadsAreDropped) {
  const auto huge = xsens(from_hex("FF 36 0F 40 20 0C 00000000 00000000 7149F2CA"));
  EXPECT_EQ(parsed("xsens_mt", huge)[Count::implausible], 1u);
  for (const auto* line : {"0,0,1e30\n", "0,0,-1e5\n"}) {
    const auto result =
        parsed("text_line", from_text(std::string("boot\n") + line), {{"columns", "ax,ay,az"}});
    EXPECT_EQ(result[Count::implausible], 1u) << line;
    EXPECT_TRUE(result.samples.empty());
  }
}

TEST(Hostile, WitMotionsRangeEndsAtBothSides) {
  const auto wit = [](std::string_view hex) {
    auto frame = from_hex(hex);
    unsigned sum = 0;
    for (const auto byte : frame) sum += byte;
    frame.push_back(static_cast<std::uint8_t>(sum));
    return frame;
  };
  for (const auto& [value, is_clipped] :
       {std::pair{"FF7F", true}, std::pair{"0080", true}, std::pair{"FE7F", false}}) {
    const auto frame = wit("55 51 " + std::string(value) + " 0000 0008 0000");
    const auto result = parsed("witmotion", joined({frame, frame}));
    ASSERT_GE(result.samples.size(), 1u);
    EXPECT_EQ((result.samples[0].flags & kClipped) != 0, is_clipped) << value;
  }
}

TEST(Hostile, DatagramsThatAreNoTrackersAreDropped) {
  const auto parser = make_parser("slimevr");
  std::vector<Sample> samples;
  Bytes largest(65'507, 0x00);
  largest[3] = 4;
  Bytes noise(300);
  for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<std::uint8_t>(37 * i + 200);
  for (const auto& datagram : {Bytes{}, Bytes{0}, largest, noise, Bytes(12, 0xFF)})
    parser->feed_datagram(datagram, "10.0.0.8:1", samples);
  EXPECT_TRUE(samples.empty());
  EXPECT_TRUE(parser->sensor_names().empty());
  EXPECT_EQ(parser->counters()[Count::overruns], 1u);
}

// A stream that is taken up amid datagrams is understood again, without one wrong sample.
TEST(Hostile, SlimeVrStreamsAreFoundAgainWhereverTheyBegin) {
  const auto encoder = make_encoder("slimevr", {}, {"a", "b"});
  const auto greeting = as_stream("slimevr", encoder->hello());
  std::vector<Bytes> packets;
  for (int i = 0; i < 40; ++i) {
    std::vector<Sample> sent(2);
    for (int s = 0; s < 2; ++s) {
      auto& sample = sent[static_cast<std::size_t>(s)];
      sample.sensor = s;
      sample.specific_force = Vec3(0.1 * i, s, 9.81);
      sample.orientation = Eigen::Vector4d(1, 0, 0, 0);
    }
    for (const auto& packet : encoder->encode(sent)) packets.push_back(packet);
  }
  const auto bytes = as_stream("slimevr", packets);
  const auto whole = parsed("slimevr", joined({greeting, bytes})).samples.size();
  for (std::size_t cut = 0; cut < 140; ++cut) {
    const Bytes rest(bytes.begin() + static_cast<std::ptrdiff_t>(cut), bytes.end());
    const auto result = parsed("slimevr", joined({greeting, rest}));
    EXPECT_GE(result.samples.size() + 8, whole) << cut;
    for (const auto& sample : result.samples)
      EXPECT_NEAR(sample.specific_force[1] + sample.specific_force[2], 9.81 + sample.sensor, 2.0);
  }
}

}  // namespace
}  // namespace sparse_mocap::streams
