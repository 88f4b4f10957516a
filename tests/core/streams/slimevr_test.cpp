// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "sparse_mocap/base/errors.hpp"
#include "streams/stream_test_support.hpp"

namespace sparse_mocap::streams {
namespace {

using namespace testing;

TEST(SlimeVr, AnswersHandshakesAndDropsDatagramsOutOfOrder) {
  const auto parser = make_parser("slimevr");
  std::vector<Sample> samples;
  const auto feed = [&](const std::string& hex) {
    parser->feed_datagram(from_hex(hex), "10.0.0.7:6969", samples);
  };
  feed(
      "00000003 0000000000000000 00000001 00000000 00000000 00000000 00000000 00000000 00000013"
      "03 312E30 AABBCCDDEEFF");
  const auto replies = parser->pop_replies();
  ASSERT_EQ(replies.size(), 1u);
  EXPECT_EQ(replies[0].size(), 64u);
  EXPECT_EQ(Bytes(replies[0].begin(), replies[0].begin() + 13),
            from_hex("03 486579204F5652203D442035"));
  const std::string turn =
      " 02 01 3F3504F3 00000000 00000000 3F3504F3 00";  // x up: 90 degrees about x
  feed("00000011 0000000000000005" + turn);
  feed("00000004 0000000000000006 3F800000 00000000 00000000 02");
  feed("00000004 0000000000000004 3F800000 00000000 00000000 02");  // late
  feed("00000004 0000000000000009 3F800000 00000000 00000000 02");  // two are missing
  feed("00000064 000000000000000A 0017 00000011" + turn +
       " 0011 00000004 3F800000 00000000 00000000 02");
  feed("00000064 000000000000000B 0000");
  feed("00000064 000000000000000C 00FF 00");
  feed("00000004 000000000000000D 7FC00000 00000000 00000000 02");
  feed("0000");
  ASSERT_EQ(samples.size(), 3u);
  EXPECT_EQ(parser->sensor_names(), std::vector<std::string>{"aa:bb:cc:dd:ee:ff/2"});
  // Protocol 19 turns the acceleration: what it sends as x is -y.
  expect_near(samples[0].specific_force, Vec3(0, 8.81, 0), 1e-6);
  EXPECT_TRUE(samples[1].flags & kAfterGap);
  EXPECT_EQ(parser->counters()[Count::out_of_order], 1u);
  EXPECT_EQ(parser->counters()[Count::missing_samples], 2u);
  EXPECT_EQ(parser->counters()[Count::malformed], 3u);
  EXPECT_EQ(parser->counters()[Count::implausible], 1u);
}

// What the tests below feed a parser with, one datagram at a time.
struct Slime {
  std::unique_ptr<StreamParser> parser;
  std::vector<Sample> samples = {};

  void feed(const std::string& sender, const std::string& hex) {
    parser->feed_datagram(from_hex(hex), sender, samples);
  }
  void greet(const std::string& sender, const std::string& mac, const std::string& protocol) {
    feed(sender, "00000003 0000000000000000 00000000 00000000 00000000 00000000 00000000 00000000" +
                     protocol + "00" + mac);
  }
};

const std::string kUpright = " 00000000 00000000 00000000 3F800000 ";  // x y z w
const std::string kAhead = " 3F800000 40000000 40400000 ";             // 1 2 3 m/s^2

TEST(SlimeVr, TurnsTheAccelerationOfEarlierProtocols) {
  for (const bool is_earlier : {true, false}) {
    Slime slime{make_parser("slimevr")};
    slime.greet("a:1", "0102030405 06", is_earlier ? "00000015" : "00000016");
    slime.feed("a:1", "00000011 0000000000000001 00 01" + kUpright + "00");
    slime.feed("a:1", "00000004 0000000000000002" + kAhead + "00");
    ASSERT_EQ(slime.samples.size(), 1u);
    const Vec3 sent = is_earlier ? Vec3(2, -1, 3) : Vec3(1, 2, 3);
    expect_near(slime.samples[0].specific_force, sent + Vec3(0, 0, 9.81), 1e-5);
  }
}

TEST(SlimeVr, ReadsPhonesWhoseAccelerationHasNoNumber) {
  Slime phone{make_parser("slimevr")};
  phone.feed("10.0.0.9:5000", "00000003 0000000000000000");  // an early owoTrack greets with less
  ASSERT_EQ(phone.parser->pop_replies().size(), 1u);
  phone.feed("10.0.0.9:5000", "00000001 0000000000000001" + kUpright);
  phone.feed("10.0.0.9:5000", "00000004 0000000000000002" + kAhead);
  ASSERT_EQ(phone.samples.size(), 1u);
  EXPECT_EQ(phone.parser->sensor_ids(), std::vector<std::string>{"10.0.0.9"});
}

TEST(SlimeVr, KnowsATrackerByItsMacWhateverItsAddress) {
  Slime slime{make_parser("slimevr")};
  for (const std::string sender : {"10.0.0.7:1000", "10.0.0.8:2000"}) {
    slime.greet(sender, "0102030405 06", "00000016");
    slime.feed(sender, "00000011 0000000000000001 00 01" + kUpright + "00");
    slime.feed(sender, "00000004 0000000000000002" + kAhead + "00");
  }
  slime.feed("10.0.0.7:1000", "00000004 0000000000000003" + kAhead + "00");  // the old address
  ASSERT_EQ(slime.samples.size(), 2u);
  EXPECT_EQ(slime.samples[0].sensor, slime.samples[1].sensor);
  EXPECT_EQ(slime.parser->sensor_ids(), std::vector<std::string>{"01:02:03:04:05:06"});
}

TEST(SlimeVr, StrangersLockNoTrackerOut) {
  Slime slime{make_parser("slimevr")};
  slime.greet("a:1", "0102030405 06", "00000016");
  slime.feed("a:1", "00000011 0000000000000001 00 01" + kUpright + "00");
  for (int i = 0; i < 100; ++i) {
    const std::string sender = "b:" + std::to_string(i);
    slime.feed(sender, "00000011 0000000000000001 00 01" + kUpright + "00");  // no greeting
    slime.feed(sender, "00000004 0000000000000002" + kAhead + "00");
    const std::string digits = std::to_string(10 + i % 90);
    slime.greet(sender, "FFFFFFFFFF" + digits, "00000016");
    slime.feed("a:1", "00000000 " + std::string(16 - std::to_string(i + 2).size(), '0') +
                          std::to_string(i + 2));
  }
  slime.feed("a:1", "00000004 0000000000001000" + kAhead + "00");
  EXPECT_EQ(slime.samples.size(), 1u);
  EXPECT_EQ(slime.parser->sensor_ids(), std::vector<std::string>{"01:02:03:04:05:06"});
}

TEST(SlimeVr, AcceptsTheNamedTrackersAlone) {
  Slime slime{make_parser("slimevr", {{"macs", "AA-BB-CC-DD-EE-FF,010203040506"}})};
  for (const std::string mac : {"AABBCCDDEEFF", "010203040506", "010203040507"})
    slime.greet(mac + ":1", mac, "00000016");
  EXPECT_EQ(slime.parser->pop_replies().size(), 2u);
  EXPECT_EQ(slime.parser->last_message(), "tracker 01:02:03:04:05:07 is not in the option macs");
  EXPECT_THROW(make_parser("slimevr", {{"macs", "AA:BB"}}), ConfigError);
}

TEST(SlimeVr, RepeatsTheOrientationOfATrackerThatIsStill) {
  Slime slime{make_parser("slimevr")};
  slime.greet("a:1", "0102030405 06", "00000016");
  slime.feed("a:1", "00000011 0000000000000001 00 01" + kUpright + "00");
  slime.feed("a:1", "00000004 0000000000000002" + kAhead + "00");
  for (const char* number : {"3", "4", "5", "6"})
    slime.feed("a:1", "00000000 000000000000000" + std::string(number));
  ASSERT_EQ(slime.samples.size(), 3u);  // two answers may be due to radio
  expect_near(slime.samples[2].specific_force, Vec3(0, 0, 9.81), 1e-6);
}

TEST(SlimeVr, ReadsTheBatteryAndAnswersSensorInfo) {
  Slime slime{make_parser("slimevr")};
  slime.greet("a:1", "0102030405 06", "00000016");
  slime.feed("a:1", "00000011 0000000000000001 00 01" + kUpright + "00");
  slime.feed("a:1", "00000004 0000000000000002" + kAhead + "00");
  EXPECT_TRUE(std::isnan(slime.parser->sensor_batteries()[0]));
  slime.feed("a:1", "0000000C 0000000000000003 40700000 3E000000");  // 3.75 V, an eighth
  EXPECT_NEAR(slime.parser->sensor_batteries()[0], 12.5, 1e-6);
  slime.parser->pop_replies();
  slime.feed("a:1", "0000000F 0000000000000004 02 01 08");
  EXPECT_EQ(slime.parser->pop_replies(), std::vector<Bytes>{from_hex("0000000F 02 01")});
}

}  // namespace
}  // namespace sparse_mocap::streams
