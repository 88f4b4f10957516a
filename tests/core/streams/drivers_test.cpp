// SPDX-License-Identifier: GPL-3.0-or-later
//
// What holds of every protocol.
#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/streams/orientation.hpp"
#include "streams/stream_test_support.hpp"

namespace sparse_mocap::streams {
namespace {

using namespace testing;

struct Setting {
  std::string driver;
  OptionMap options;
};

std::vector<Setting> settings() {
  return {{"xsens_mt", {}},
          {"xsens_mt", {{"output_mode", "0x0006"}, {"output_settings", "1"}}},
          {"witmotion", {}},
          {"witmotion_ble", {}},
          {"ximu3", {}},
          {"ximu3", {{"format", "binary"}}},
          {"text_line", {{"columns", "time,ax,ay,az,gx,gy,gz,qw,qx,qy,qz"}}},
          {"text_line", {{"columns", "header"}}},
          {"slimevr", {}}};
}

// A sensor that is turned about and shaken.
std::vector<Sample> movement(int num) {
  std::vector<Sample> samples;
  for (int i = 0; i < num; ++i) {
    Sample sample;
    const double t = i * 0.01;
    sample.time_s = 10.0 + t;
    sample.counter = 65500 + i;
    const Quat q = from_roll_pitch_yaw(std::sin(t), 0.5 * std::cos(t), 2.0 * t);
    sample.orientation = orientation_from_z_up(q);
    sample.specific_force = q.conjugate() * Vec3(3.0 * std::sin(9.0 * t), 1.0, 9.81);
    sample.angular_velocity = Vec3(1.0, std::sin(t), -2.0);
    samples.push_back(sample);
  }
  return samples;
}

Bytes stream_of(const Setting& setting, int num) {
  auto options = setting.options;
  options.erase("output_mode");
  options.erase("output_settings");
  const auto encoder = make_encoder(setting.driver, options, {"one"});
  auto packets = encoder->hello();
  for (const auto& sample : movement(num))
    for (const auto& packet : encoder->encode(std::span(&sample, 1))) packets.push_back(packet);
  return as_stream(setting.driver, packets);
}

TEST(Drivers, GiveBackWhatTheirEncodersSend) {
  for (const auto& setting : settings()) {
    SCOPED_TRACE(setting.driver);
    const auto sent = movement(100);
    const auto result = parsed(setting.driver, stream_of(setting, 100), setting.options);
    ASSERT_GE(result.samples.size(), 98u);  // the last may still wait for what confirms it
    for (std::size_t i = 0; i < result.samples.size(); ++i) {
      const auto& got = result.samples[i];
      expect_near(got.specific_force, sent[i].specific_force, 0.01);
      if (got.angular_velocity.allFinite())
        expect_near(got.angular_velocity, sent[i].angular_velocity, 0.01);
      if (got.has_orientation()) {
        EXPECT_LT(rotation_of(got).angularDistance(rotation_of(sent[i])), 0.01);
      }
      if (i > 0 && !std::isnan(got.time_s)) {
        EXPECT_NEAR(got.time_s - result.samples[i - 1].time_s, 0.01, 1e-6);
      }
    }
    EXPECT_EQ(result[Count::missing_samples], 0u);
    EXPECT_EQ(result[Count::malformed], 0u);
  }
}

TEST(Drivers, DoNotMindHowBytesAreCut) {
  for (const auto& setting : settings()) {
    auto bytes = stream_of(setting, 60);
    expect_same_in_pieces(setting.driver, bytes, setting.options);
    std::mt19937 random(3);
    for (int i = 0; i < 20; ++i)
      bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
    expect_same_in_pieces(setting.driver, bytes, setting.options);
  }
}

TEST(Drivers, LoseOnlyWhatIsDamaged) {
  for (const auto& setting : settings()) {
    if (setting.driver == "slimevr") continue;  // a socket does not cut datagrams
    SCOPED_TRACE(setting.driver);
    const auto whole = stream_of(setting, 100);
    const auto intact = parsed(setting.driver, whole, setting.options).samples.size();
    for (std::size_t cut = whole.size() / 2; cut < whole.size() / 2 + 40; ++cut) {
      auto bytes = whole;
      bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(cut));
      EXPECT_GE(parsed(setting.driver, bytes, setting.options).samples.size() + 2, intact);
    }
  }
}

TEST(Drivers, MakeNothingOfRandomBytes) {
  std::mt19937_64 random(11);
  Bytes noise(10'000'000);
  for (std::size_t i = 0; i < noise.size(); i += 8) {
    const auto word = random();
    std::copy_n(reinterpret_cast<const std::uint8_t*>(&word), 8, &noise[i]);
  }
  for (const auto& setting : settings()) {
    const auto parser = make_parser(setting.driver, setting.options);
    std::vector<Sample> samples;
    const ByteView all(noise);
    for (std::size_t at = 0; at < all.size(); at += 4096)
      parser->feed(all.subspan(at, std::min<std::size_t>(4096, all.size() - at)), samples);
    // A sum of eight bits lets one in 256 candidates pass, which only its content can stop then.
    const std::size_t most = setting.driver == "witmotion" ? 10 : 0;
    EXPECT_LE(samples.size(), most) << setting.driver;
    EXPECT_LE(parser->sensor_names().size(), 64u);
  }
}

TEST(Drivers, RefuseWhatTheyDoNotKnow) {
  const auto message = [](auto&& act) -> std::string {
    try {
      act();
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message([] { make_parser("xsens"); }),
            R"(unknown driver "xsens"; the nearest is 'xsens_mt')");
  EXPECT_EQ(message([] {
              make_parser("witmotion", {{"rate", "100"}});
            }),
            R"(driver witmotion has no option "rate"; the nearest is 'name')");
  EXPECT_NE(message([] {
              make_parser("text_line", {{"columns", "ax,ay,a"}});
            }).find("nearest"),
            std::string::npos);
  EXPECT_NE(message([] {
              make_parser("xsens_mt", {{"rate_hz", "nan"}});
            }).find("from 1 to 2000"),
            std::string::npos);
  EXPECT_NE(message([] {
              make_encoder("ximu3", {}, {"a", "b"});
            }).find("one sensor"),
            std::string::npos);
  for (const auto name : driver_names())
    for (const auto& option : driver_options(name)) EXPECT_FALSE(option.description.empty());
}

}  // namespace
}  // namespace sparse_mocap::streams
