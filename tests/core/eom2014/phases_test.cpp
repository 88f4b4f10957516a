// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/phases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "support/refusals.hpp"

namespace sparse_mocap::eom2014 {
namespace {

constexpr double kRate_hz = 30.0;

// A letter a frame: B both feet stand, L the left one alone, R the right one alone, . neither.
Eigen::Matrix2Xd contacts_of(const std::string& frames) {
  Eigen::Matrix2Xd contacts(2, static_cast<Eigen::Index>(frames.size()));
  for (std::size_t t = 0; t < frames.size(); ++t) {
    contacts(0, static_cast<Eigen::Index>(t)) = frames[t] == 'B' || frames[t] == 'L' ? 1.0 : 0.0;
    contacts(1, static_cast<Eigen::Index>(t)) = frames[t] == 'B' || frames[t] == 'R' ? 1.0 : 0.0;
  }
  return contacts;
}

// A letter a frame: s standing, l left step, r right step, j jump, < start, > stop.
std::string letters(const std::string& frames) {
  std::string out;
  for (const Phase phase : phases_of(contacts_of(frames), kRate_hz))
    out += "slrj<>"[static_cast<std::size_t>(phase)];
  return out;
}

TEST(EomPhases, AStepLastsUntilTheOtherFootLeavesTheFloor) {
  EXPECT_EQ(letters("RRRRRRBBBBLLLLLLLLBBBBRRRRRRRRBBBBLLLLLL"),
            "llllllllllrrrrrrrrrrrrllllllllllllrrrrrr");
}

TEST(EomPhases, StandingIsBeforeTheFirstStepAndAfterTheLast) {
  EXPECT_EQ(letters("BBBBBBBBBBBBBBRRRRRRRRBBBBLLLLLLLLBBBBBBBBBBBBBB"),
            "ssssssssssssss<<<<<<<<<<<<>>>>>>>>ssssssssssssss");
}

TEST(EomPhases, OnlyTheFirstStepAndTheLastOneAreStartAndStop) {
  EXPECT_EQ(letters("BBBBBBBBBBBBBBRRRRRRBBLLLLLLBBRRRRRRBBLLLLLLBBBBBBBBBBBBBB"),
            "ssssssssssssss<<<<<<<<rrrrrrrrllllllll>>>>>>ssssssssssssss");
  EXPECT_EQ(letters("BBBBBBBBBBBBBBRRRRRRBBBBBBBBBBBBBB"), "ssssssssssssssllllllssssssssssssss");
}

TEST(EomPhases, SegmentsSayWherePhasesBegin) {
  const auto phases = phases_of(contacts_of("RRRRRRBBBBLLLLLLLLBBBBRRRRRRRR"), kRate_hz);
  auto segments = segments_of(phases, kRate_hz);
  ASSERT_EQ(segments.size(), 3U);
  EXPECT_EQ(segments[1].label, "right_step");
  EXPECT_DOUBLE_EQ(segments[1].begin_s, 10.0 / 30.0);
  EXPECT_EQ(phases_from(segments, 30, kRate_hz, "walk"), phases);
  segments[1].begin_s = 0.5;
  segments.back() = {100.0, "stop"};
  const auto moved = phases_from(segments, 30, kRate_hz, "walk");
  EXPECT_EQ(std::count(moved.begin(), moved.end(), Phase::left_step), 15);
  EXPECT_EQ(std::count(moved.begin(), moved.end(), Phase::right_step), 15);
}

TEST(EomPhases, SegmentsThatMakeNoSenseAreRefused) {
  const auto refused = [](const std::string& text, const std::vector<Segment>& segments) {
    EXPECT_REFUSED(ConfigError, text, phases_from(segments, 30, kRate_hz, "walk"));
  };
  refused("phases of the clip 'walk' do not begin at 0 s", {{0.1, "jump"}});
  refused("do not begin", {});
  refused("one named 'hop'; choose from standing, left_step", {{0.0, "hop"}});
  refused("not in the order", {{0.0, "jump"}, {0.5, "standing"}, {0.5, "jump"}});
  refused("not in the order", {{0.0, "jump"}, {std::nan(""), "standing"}});
}

TEST(EomPhases, RunningHasStepsAndJumpingHasNone) {
  EXPECT_EQ(letters("RRRRR.....LLLLL.....RRRRR"), "lllllrrrrrrrrrrllllllllll");
  EXPECT_EQ(letters("BBBBB.......BBBBBR......BBBBB"), "sssssjjjjjjjsssssjjjjjjjsssss");
}

TEST(EomPhases, ShortContactsAreOverlooked) {
  EXPECT_EQ(letters("RRRRRRBRRRRRRBBBBLLLLLL"), "lllllllllllllllllrrrrrr");
  EXPECT_EQ(num_steps(contacts_of("RRRRRRBRRRRRRBBBBLLLLLL"), kRate_hz), 1);
  EXPECT_EQ(num_steps(contacts_of("BBBBBBBB"), kRate_hz), 0);
  EXPECT_TRUE(phases_of(contacts_of(""), kRate_hz).empty());
}

}  // namespace
}  // namespace sparse_mocap::eom2014
