// SPDX-License-Identifier: GPL-3.0-or-later
//
// Frames written by hand from the protocols' descriptions.
#include "sparse_mocap/streams/orientation.hpp"
#include "streams/stream_test_support.hpp"

namespace sparse_mocap::streams {
namespace {

using namespace testing;

// Adds what makes all bytes after FA sum to 0.
Bytes xsens(std::string_view hex) {
  auto frame = from_hex(hex);
  unsigned sum = 0;
  for (std::size_t i = 1; i < frame.size(); ++i) sum += frame[i];
  frame.push_back(static_cast<std::uint8_t>(256 - sum % 256));
  return frame;
}

Bytes wit(std::string_view hex) {
  auto frame = from_hex(hex);
  unsigned sum = 0;
  for (const auto byte : frame) sum += byte;
  frame.push_back(static_cast<std::uint8_t>(sum));
  return frame;
}

// 9.81 as f32 is 411CF5C3.
const std::string kFlat = "40 20 0C 00 00 00 00 00 00 00 00 41 1C F5 C3";

TEST(Protocols, ReadPlusGOnTheAxisThatPointsUp) {
  struct Case {
    std::string driver;
    Bytes bytes;
    OptionMap options;
  };
  const Bytes slime =
      as_stream("slimevr",
                {from_hex("00000003 0000000000000000 00000000 00000000 00000000 00000000 00000000"
                          "00000000 00000016 00 AABBCCDDEEFF"),
                 from_hex("00000011 0000000000000001 00 01 00000000 00000000 00000000 3F800000 00"),
                 from_hex("00000004 0000000000000002 00000000 00000000 00000000 00")});
  const auto ble = from_hex("55 61 0000 0000 0008 0000 0000 0000 0000 0000 0000");
  const std::vector<Case> cases{
      {"xsens_mt", xsens("FA FF 36 0F " + kFlat), {}},
      {"witmotion",
       joined({wit("55 51 0000 0000 0008 0000"), wit("55 51 0000 0000 0008 0000")}),
       {}},
      {"witmotion_ble", joined({ble, ble}), {}},
      {"ximu3", from_text("I,1000,0,0,0,0,0,1.0\r\nI,2000,0,0,0,0,0,1.0\r\n"), {}},
      {"text_line",
       from_text("x\n0\t0\t16384\n"),
       {{"columns", "ax,ay,az"}, {"separator", "tab"}, {"acceleration_unit", "raw"}}},
      {"text_line",
       from_text("x\n0;0;-1000\n"),
       {{"columns", "ax,ay,az"},
        {"separator", "semicolon"},
        {"acceleration_unit", "mg"},
        {"acceleration_sign", "-"}}},
      {"slimevr", slime, {}},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.driver);
    const auto result = parsed(c.driver, c.bytes, c.options);
    ASSERT_GE(result.samples.size(), 1u);
    expect_near(result.samples[0].specific_force, Vec3(0, 0, 9.81), 0.004);
  }
}

TEST(Xsens, SendsTheManualsFrames) {
  const auto commands = start_commands("xsens_mt");
  EXPECT_EQ(commands.front(), from_hex("FA FF 30 00 D1"));
  EXPECT_EQ(commands[1], from_hex("FA FF 00 00 01"));
  EXPECT_EQ(commands.back(), from_hex("FA FF 10 00 F1"));
}

TEST(Xsens, FindsTheFrameBehindADamagedOne) {
  const auto good = xsens("FA FF 36 0F " + kFlat);
  auto damaged = good;
  damaged.back() ^= 1;
  auto cut = good;
  cut.resize(9);
  const auto result = parsed("xsens_mt", joined({damaged, cut, good}));
  EXPECT_EQ(result.samples.size(), 1u);
  EXPECT_GE(result[Count::bad_checksums], 1u);
  EXPECT_GE(result[Count::resyncs], 1u);
  // A preamble inside the data is data.
  EXPECT_EQ(parsed("xsens_mt", xsens("FA FF 36 14 F0 10 02 FA FA " + kFlat)).samples.size(), 1u);
}

TEST(Xsens, ReadsExtendedLengthsAndRefusesImpossibleOnes) {
  std::string filling = " F0 10 F0";
  for (int i = 0; i < 0xF0; ++i) filling += " 00";
  const auto extended = xsens("FA FF 36 FF 01 02 " + kFlat + filling);
  EXPECT_EQ(parsed("xsens_mt", extended).samples.size(), 1u);
  EXPECT_EQ(parsed("xsens_mt", xsens("FA FF 36 FF 00 0F " + kFlat)).samples.size(), 1u);
  const auto result = parsed("xsens_mt", from_hex("FA FF 36 FF 08 01 00 00"));
  EXPECT_EQ(result[Count::overruns], 1u);
}

TEST(Xsens, SkipsUnknownFieldsAndDropsContradictions) {
  const auto unknown = parsed("xsens_mt", xsens("FA FF 36 14 F0 10 02 AB CD " + kFlat));
  EXPECT_EQ(unknown.samples.size(), 1u);
  EXPECT_EQ(unknown[Count::unknown_types], 1u);
  EXPECT_EQ(parsed("xsens_mt", xsens("FA FF 36 12 F0 10 00 " + kFlat)).samples.size(), 1u);
  for (const auto* bad :
       {"FA FF 36 05 40 20 0C 00 00", "FA FF 36 04 40 20 01 00", "FA FF 36 02 40 20",
        "FA FF 36 0F 40 20 0C 7F C0 00 00 00000000 00000000"})
    EXPECT_EQ(parsed("xsens_mt", xsens(bad))[Count::malformed], 1u) << bad;
}

TEST(Xsens, FollowsCountersOverTheirEnd) {
  const auto at = [](const std::string& count) {
    return xsens("FA FF 36 14 10 20 02 " + count + kFlat);
  };
  const auto result = parsed("xsens_mt", joined({at("FF FF"), at("00 00"), at("00 00"), at("00 0B"),
                                                 at("00 03"), at("00 04")}));
  ASSERT_EQ(result.samples.size(), 4u);
  EXPECT_EQ(result.samples[1].counter, 65536);
  EXPECT_EQ(result[Count::repeated], 1u);
  EXPECT_EQ(result[Count::missing_samples], 10u);
  EXPECT_EQ(result.samples[2].flags, unsigned{kAfterGap});
  EXPECT_EQ(result[Count::out_of_order], 1u);
  EXPECT_TRUE(result.samples[3].flags & kAfterReset);
}

TEST(Xsens, FollowsClocksOverTheirEnd) {
  const auto at = [](const std::string& ticks) {
    return xsens("FA FF 36 16 10 60 04 " + ticks + kFlat);
  };
  const auto bytes = joined({at("FF FF FF FE"), at("00 00 00 62")});
  for (const auto& [tick_us, step_s] : {std::pair{"100", 0.01}, std::pair{"1", 1e-4}}) {
    const auto result = parsed("xsens_mt", bytes, {{"tick_us", tick_us}});
    ASSERT_EQ(result.samples.size(), 2u);
    EXPECT_NEAR(result.samples[1].time_s - result.samples[0].time_s, step_s, 1e-9);
  }
}

TEST(Xsens, TellsOfErrorsAndResets) {
  const auto result =
      parsed("xsens_mt",
             joined({xsens("FA FF 42 01 04"), xsens("FA FF 3E 00"), xsens("FA FF 32 02 00 00")}));
  EXPECT_EQ(result[Count::device_errors], 1u);
  EXPECT_EQ(result[Count::device_resets], 1u);
  EXPECT_EQ(result[Count::unconfigured], 1u);
}

// One MTData of an Xbus Master: [counter][block of MT 1][block of MT 2], by its configuration.
TEST(Xsens, ReadsSeveralSensorsOfAnXbusMaster) {
  std::string configuration = "FA FF 0D 8A 00200001 0480";  // 138 bytes, 1152 ticks: 100 Hz
  for (int i = 0; i < 90; ++i) configuration += "00";
  configuration += " 0002";
  for (const auto* id : {" 0030000A", " 0030000B"})
    configuration += std::string(id) + " 000C 0002 00000061 0000000000000000";
  // Settings 0x61: counter, no gyroscope, no magnetic field; blocks of 12 bytes have no counter.
  const std::string blocks = " 00000000 00000000 411CF5C3 411CF5C3 00000000 00000000";
  const auto first = xsens("FA FF 32 1A 0001" + blocks),
             second = xsens("FA FF 32 1A 0002" + blocks);
  const auto result = parsed("xsens_mt", joined({xsens(configuration), first, second}));
  ASSERT_EQ(result.samples.size(), 4u);
  EXPECT_EQ(result.names, (std::vector<std::string>{"0030000A", "0030000B"}));
  expect_near(result.samples[0].specific_force, Vec3(0, 0, 9.81), 1e-6);
  expect_near(result.samples[1].specific_force, Vec3(9.81, 0, 0), 1e-6);
  EXPECT_EQ(result.samples[1].sensor, 1);
  EXPECT_NEAR(result.samples[2].time_s - result.samples[0].time_s, 0.01, 1e-9);
  EXPECT_EQ(parsed("xsens_mt",
                   joined({xsens(configuration), xsens("FA FF 32 02 0001")}))[Count::malformed],
            1u);
}

TEST(Xsens, BusOfAnEmulatorAnswersItsParser) {
  const OptionMap options{{"output", "mtdata"}, {"num_sensors", "8"}};
  const std::vector<std::string> names(8, "mt");
  const auto encoder = make_encoder("xsens_mt", options, names);
  const auto parser = make_parser("xsens_mt", options);
  std::vector<Sample> samples, sent(8);
  for (const auto& command : start_commands("xsens_mt", options))
    parser->feed(encoder->respond(command), samples);
  for (int i = 0; i < 8; ++i) {
    sent[static_cast<std::size_t>(i)].sensor = i;
    sent[static_cast<std::size_t>(i)].specific_force = Vec3(i, 0, 9.81);
  }
  const auto frames = encoder->encode(sent);  // 8 blocks of 52 bytes: extended length
  ASSERT_GT(frames.at(0).size(), 260u);
  parser->feed(frames[0], samples);
  ASSERT_EQ(samples.size(), 8u);
  EXPECT_NEAR(samples[7].specific_force[0], 7.0, 1e-6);
}

TEST(WitMotion, JoinsFramesOfACycle) {
  // 0x0800 = 2048 of 32768: 1 g of 16, 125 deg/s of 2000; the quaternion 7FFF 0 0 0.
  const auto cycle = joined({wit("55 51 0000 0000 0008 0000"), wit("55 52 0008 0000 0000 0000"),
                             wit("55 59 FF7F 0000 0000 0000")});
  const auto result = parsed("witmotion", joined({cycle, cycle, cycle}));
  ASSERT_EQ(result.samples.size(), 3u);
  expect_near(result.samples[2].angular_velocity, Vec3(125.0 * kRadiansPerDegree, 0, 0), 1e-9);
  expect_near(rotation_of(result.samples[2]) * result.samples[2].specific_force,
              Vec3(0, 9.80665, 0), 1e-6);
  EXPECT_TRUE(std::isnan(result.samples[2].time_s));
}

TEST(WitMotion, CountsStormsAndMarksTheEndOfItsRange) {
  Bytes storm(500, 0x55);
  auto damaged = wit("55 51 0000 0000 0008 0000");
  damaged[10] ^= 1;
  const auto clipped = wit("55 51 FF7F 0000 0008 0000");
  const auto result = parsed(
      "witmotion", joined({storm, damaged, wit("55 5F 0000 0000 0000 0000"), clipped, clipped}));
  ASSERT_GE(result.samples.size(), 1u);
  EXPECT_TRUE(result.samples[0].flags & kClipped);
  EXPECT_EQ(result[Count::unknown_types], 1u);
  EXPECT_GT(result[Count::bad_checksums], 1u);
}

TEST(Ximu3, ReadsBinaryWithEscapes) {
  // Time 0x0A0A us, gyroscope 0, accelerometer (0, 0, 1) g.
  const auto at = [](const std::string& time) {
    return from_hex("C9 " + time + " 00000000 00000000 00000000 00000000 00000000 0000803F 0A");
  };
  const auto result =
      parsed("ximu3", joined({at("DBDC DBDC 000000000000"), at("DBDD 0B 000000000000")}));
  ASSERT_EQ(result.samples.size(), 2u);
  EXPECT_NEAR(result.samples[0].time_s, 0x0A0A * 1e-6, 1e-12);
  expect_near(result.samples[0].specific_force, Vec3(0, 0, 9.80665), 1e-9);
}

TEST(Ximu3, JoinsOrientationAndNamesTheDevice) {
  const auto result = parsed(
      "ximu3", from_text("{\"ping\":{\"interface\":\"USB\",\"name\":\"Foot\",\"sn\":\"64F6\"}}\r\n"
                         "I,1000,90,0,0,0,0,1\r\nQ,1000,1,0,0,0\r\n^B"
                         "I,1000,0,0,0,1,0,0\r\n^B"
                         "I,3000,0,0,0,1,0,0\r\n"));
  ASSERT_EQ(result.samples.size(), 3u);
  EXPECT_EQ(result.names, (std::vector<std::string>{"Foot 64F6", "ximu3_B"}));
  expect_near(rotation_of(result.samples[0]) * result.samples[0].specific_force,
              Vec3(0, 9.80665, 0), 1e-9);
  EXPECT_NEAR(result.samples[0].angular_velocity[0], kPi / 2, 1e-12);
}

TEST(Ximu3, DropsWhatIsNotAMessage) {
  for (const auto* bad :
       {"I,abc,0,0,0,0,0,1\n", "I,1,0,0,0,0,0\n", "I,1,0,0,0,0,0,1,1\n", "I,1,0,0,0,0,0,nan\n",
        "I,-1,0,0,0,0,0,1\n", "\xC9\x01\xDB\n", "\xC9\x01\x02\n"}) {
    const auto result = parsed("ximu3", from_text(bad));
    EXPECT_EQ(result[Count::malformed], 1u) << bad;
    EXPECT_EQ(result.samples.size(), 0u);
  }
  Bytes endless(5000, 'I');
  EXPECT_EQ(parsed("ximu3", joined({endless, from_text("\n")}))[Count::overruns], 1u);
}

TEST(TextLine, DropsEveryLineThatIsNotAsTheProfileSays) {
  const OptionMap options{{"columns", "ax,ay,az"}};
  for (const auto* bad :
       {"0,0", "0,0,9.81,1", "ax,ay,az", "0,0,nan", "1,5;2", "0,0,ovf",
        "Initializing I2C devices...", "0,0,9.Booting", "0,,9.81", "0x1,0,9", "\x80,0,9.81"}) {
    const auto result =
        parsed("text_line", from_text("half\n" + std::string(bad) + "\n0,0,9.81\n"), options);
    EXPECT_EQ(result.samples.size(), 1u) << bad;
    EXPECT_EQ(result[Count::malformed], 1u) << bad;
  }
}

// The torn first lines of a device that was sending already, cut at every place.
void expect_no_wrong_sample(const std::string& columns, const std::vector<std::string>& lines,
                            const OptionMap& more = {}) {
  OptionMap options{{"columns", columns}};
  options.insert(more.begin(), more.end());
  std::string text;
  for (const auto& line : lines) text += line + "\r\n";
  auto whole_options = options;
  whole_options["skip_first_line"] = "false";
  const auto whole = parsed("text_line", from_text(text), whole_options);
  ASSERT_EQ(whole.samples.size(), lines.size());
  for (std::size_t cut = 1; cut < lines[0].size() + 2; ++cut) {
    const auto torn = parsed("text_line", from_text(text.substr(cut)), options);
    const std::size_t lost = whole.samples.size() - torn.samples.size();
    ASSERT_LE(lost, 1u) << cut;
    for (std::size_t i = 0; i < torn.samples.size(); ++i) {
      const auto &got = torn.samples[i], &sent = whole.samples[i + lost];
      expect_near(got.specific_force, sent.specific_force, 1e-12);
      EXPECT_EQ(got.counter, sent.counter) << cut;
      EXPECT_TRUE(same(got.time_s, sent.time_s) || std::abs(got.time_s - sent.time_s) < 1e-9)
          << cut;
    }
  }
  expect_same_in_pieces("text_line", from_text(text), options);
}

TEST(TextLine, NeverTakesATornFirstLineForAWholeOne) {
  expect_no_wrong_sample("ax,ay,az", {"-12.50,0.10,9.81", "-12.40,0.20,9.71", "2.40,0.20,9.61"});
  expect_no_wrong_sample("time,ax,ay,az",
                         {"1234567,0.1,0.2,9.81", "1244567,0.1,0.3,9.8", "1254567,0,0,9"});
  expect_no_wrong_sample("time,ax,ay,az", {"7.51,-0.1,0,9.8", "8.02,0,0,9.8", "8.53,0,0,9.8"},
                         {{"time_unit", "s"}});
  expect_no_wrong_sample("time,ax,ay,az", {"7.5,0,0,9.8", "7.6,0,0,9.7", "7.7,0,0,9.6"},
                         {{"time_unit", "s"}});
  expect_no_wrong_sample("counter,ax,ay,az", {"1009,0,0,9.8", "1010,0,0,9.7", "1011,0,0,9.6"});
  expect_no_wrong_sample("sensor,ax,ay,az", {"arm1,0,0,9.8", "m1,0,0,9.7", "1,0,0,9.6"});
  expect_no_wrong_sample("ax,ay,az", {"a/g: 1 2 9", "a/g: 2 3 8"},
                         {{"prefix", "a/g: "}, {"separator", "space"}});
}

TEST(TextLine, TakesAFirstLineThatIsSureToBeWhole) {
  const auto num = [](const std::string& columns, const std::string& text, OptionMap options = {}) {
    options["columns"] = columns;
    return parsed("text_line", from_text(text), options).samples.size();
  };
  EXPECT_EQ(num("time,ax,ay,az", "20000,0,0,9\n30000,0,0,8\n"), 2u);
  EXPECT_EQ(num("time,ax,ay,az", "9000,0,0,9\n30000,0,0,8\n"), 1u);  // perhaps 29000
  EXPECT_EQ(num("counter,ax,ay,az", "0,0,0,9\n1,0,0,8\n"), 2u);
  EXPECT_EQ(num("counter,sensor,ax,ay,az", "5,a,0,0,9\n5,b,0,0,9\n6,a,0,0,8\n6,b,0,0,8\n"), 4u);
  EXPECT_EQ(num("skip,ax,ay,az", "x,0,0,9\n"), 1u);
  EXPECT_EQ(num("ax,ay,az", "S:0,0,9\n", {{"prefix", "S:"}}), 1u);
  EXPECT_EQ(num("ax,ay,az", "1,0,0,9\n", {{"prefix", "1,"}}), 0u);
  EXPECT_EQ(num("sensor,ax,ay,az", "S:a,0,0,9\n", {{"prefix", "S:"}}), 0u);  // perhaps S:S:a
  EXPECT_EQ(num("ax,ay,az", "0,0,9\n0,0,8\n"), 1u);
}

TEST(TextLine, TakesTheFirstLineOfAWireThatWasIdle) {
  const auto parser = make_parser("text_line", {{"columns", "ax,ay,az"}});
  std::vector<Sample> samples;
  parser->begin_message();
  parser->feed(from_text("0,0,9\n0,0,8\n"), samples);
  EXPECT_EQ(samples.size(), 2u);
  parser->reset();
  parser->feed(from_text("0,0,7\n0,0,6\n"), samples);
  EXPECT_EQ(samples.size(), 3u);
}

TEST(TextLine, FollowsColumnsSensorsAndClocks) {
  const auto result =
      parsed("text_line",
             from_text("boot\r\nsensor time counter ax ay az\r\na 4294967000 1 0 0 9.81\r\n"
                       "b 500010 1 9.81 0 0\r\na 704 3 0 0 9.81\r\nb 5 2 9.81 0 0\r\n"),
             {{"columns", "header"}, {"separator", "space"}, {"time_unit", "us"}});
  ASSERT_EQ(result.samples.size(), 4u);
  EXPECT_EQ(result.names, (std::vector<std::string>{"a", "b"}));
  EXPECT_NEAR(result.samples[2].time_s - result.samples[0].time_s, 1e-3, 1e-9);
  EXPECT_EQ(result.samples[2].flags, unsigned{kAfterGap});
  EXPECT_EQ(result.samples[3].flags, unsigned{kAfterReset});
  EXPECT_GT(result.samples[3].time_s, result.samples[1].time_s);
}

TEST(TextLine, ReadsMpu6050Raw) {
  const auto result = parsed(
      "text_line", from_text("Testing device connections...\na/g:\t0\t0\t16384\t131\t0\t-262\n"),
      {{"columns", "ax,ay,az,gx,gy,gz"},
       {"separator", "tab"},
       {"prefix", "a/g:\t"},
       {"acceleration_unit", "raw"},
       {"angular_velocity_unit", "raw"}});
  ASSERT_EQ(result.samples.size(), 1u);
  expect_near(result.samples[0].angular_velocity, Vec3(1, 0, -2) * kRadiansPerDegree, 1e-12);
}

}  // namespace
}  // namespace sparse_mocap::streams
