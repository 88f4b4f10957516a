// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "sparse_mocap/streams/text_header.hpp"
#include "streams/stream_test_support.hpp"

namespace sparse_mocap::streams {
namespace {

using namespace testing;

using text_line::Column;

TEST(TextHeader, KnowsTheNamesThatSketchesPrint) {
  const std::vector<std::pair<std::string_view, Column>> names{{"ax", Column::ax},
                                                               {"AccX", Column::ax},
                                                               {"acc_y", Column::ay},
                                                               {"Accel Z", Column::az},
                                                               {"Acceleration x", Column::ax},
                                                               {"Acc_X [m/s^2]", Column::ax},
                                                               {"GyroX", Column::gx},
                                                               {"gyr_y (deg/s)", Column::gy},
                                                               {"gz", Column::gz},
                                                               {"Quat_W", Column::qw},
                                                               {"qz", Column::qz},
                                                               {"Time_ms", Column::time},
                                                               {"millis", Column::time},
                                                               {"timestamp_us", Column::time},
                                                               {"t", Column::time},
                                                               {"Time (s)", Column::time},
                                                               {"ID", Column::sensor},
                                                               {"Seq", Column::counter}};
  for (const auto& [name, column] : names) {
    ASSERT_TRUE(text_line::header_column(name)) << name;
    EXPECT_EQ(*text_line::header_column(name), column) << name;
  }
  for (const std::string_view name : {"", "temp", "x", "axz", "battery_ms", "(ms)", "9.81"})
    EXPECT_FALSE(text_line::header_column(name)) << name;
}

TEST(TextHeader, KnowsTheUnitOfATime) {
  for (const auto& [name, seconds] : std::vector<std::pair<std::string_view, double>>{
           {"Time_ms", 1e-3}, {"t (us)", 1e-6}, {"time_s", 1.0}, {"micros", 1e-6}, {"time", 7.0}})
    EXPECT_EQ(text_line::header_tick_s(name, 7.0), seconds) << name;
}

TEST(TextLine, FollowsAHeaderLineWithOtherNames) {
  const auto result =
      parsed("text_line",
             from_text("Time_ms,AccX,AccY,AccZ,Temp\n"
                       "1000,0,0,1,25\n1010,0,0,1,25\n"),
             {{"columns", "header"}, {"acceleration_unit", "g"}, {"skip_first_line", "false"}});
  ASSERT_EQ(result.samples.size(), 2u);
  EXPECT_NEAR(result.samples[1].time_s - result.samples[0].time_s, 0.01, 1e-9);
  EXPECT_NEAR(result.samples[0].specific_force.z(), 9.80665, 1e-9);
}

TEST(TextLine, EndsALineWithItsDatagram) {
  const auto parser = make_parser("text_line", {{"columns", "sensor,ax,ay,az"}});
  std::vector<Sample> samples;
  for (const char* text : {"1,0,0,9.8", "2,0,0,9.8\n", "1,0,0,9.7", "2,0", "1,0,0,9.6"})
    parser->feed_datagram(from_text(text), "10.0.0.7:5", samples);
  EXPECT_EQ(samples.size(), 4u);
  EXPECT_EQ(parser->sensor_ids(), (std::vector<std::string>{"1", "2"}));
  EXPECT_EQ(parser->counters()[Count::malformed], 1u);
}

TEST(TextLine, TellsSendersApartWithoutAColumnForThem) {
  const auto parser = make_parser("text_line", {{"columns", "ax,ay,az"}});
  std::vector<Sample> samples;
  for (const char* sender : {"10.0.0.7:5", "10.0.0.8:5", "10.0.0.7:5", "10.0.0.7:6"})
    parser->feed_datagram(from_text("0,0,9.8"), sender, samples);
  ASSERT_EQ(samples.size(), 4u);
  EXPECT_EQ(samples[0].sensor, samples[2].sensor);
  EXPECT_EQ(parser->sensor_ids(), (std::vector<std::string>{"10.0.0.7", "10.0.0.8", "10.0.0.7:6"}));
}

// micros() read in an interrupt may be a little older than what was printed before.
TEST(TextLine, SmallStepsBackAreNoReset) {
  std::string text;
  for (int i = 0; i < 10; ++i) {
    text += std::to_string(1'000'000 + 10'000 * i) + ",0,0,9.8\n";
    text += std::to_string(1'000'000 + 10'000 * i - 12) + ",0,0,9.8\n";
  }
  const auto result = parsed("text_line", from_text(text),
                             {{"columns", "time,ax,ay,az"}, {"skip_first_line", "false"}});
  EXPECT_EQ(result.samples.size(), 10u);
  EXPECT_EQ(result.counters[Count::device_resets], 0u);
  EXPECT_EQ(result.counters[Count::out_of_order], 10u);
  EXPECT_NEAR(result.samples.back().time_s, 1.09, 1e-9);
}

TEST(Ximu3, ReadsAccelerationsWithAndWithoutAQuaternionAndTheBattery) {
  const auto parser = make_parser("ximu3");
  std::vector<Sample> samples;
  parser->feed(from_text("I,1000,0,0,0,0,0,1\nL,1000,0,0,0\nE,1000,0,0,0\nB,1000,42.5,3.7,0\n"
                         "I,2000,0,0,0,0,0,1\nL,2000,1,0,0,0,0,0,0\nB,2000,41,3.7\n"
                         "L,2000,1,0\n"),
               samples);
  EXPECT_EQ(samples.size(), 2u);
  EXPECT_EQ(parser->sensor_batteries(), std::vector<double>{41.0});
  EXPECT_EQ(parser->counters()[Count::malformed], 1u);
}

}  // namespace
}  // namespace sparse_mocap::streams
