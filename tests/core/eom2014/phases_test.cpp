// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/phases.hpp"

#include <gtest/gtest.h>

#include <string>

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

// A letter a frame: s standing, l left step, r right step, j jump.
std::string letters(const std::string& frames) {
  std::string out;
  for (const Phase phase : phases_of(contacts_of(frames), kRate_hz)) out += name_of(phase)[0];
  return out;
}

TEST(EomPhases, AStepLastsUntilTheOtherFootLeavesTheFloor) {
  EXPECT_EQ(letters("RRRRRRBBBBLLLLLLLLBBBBRRRRRRRRBBBBLLLLLL"),
            "llllllllllrrrrrrrrrrrrllllllllllllrrrrrr");
}

TEST(EomPhases, StandingIsBeforeTheFirstStepAndAfterTheLast) {
  EXPECT_EQ(letters("BBBBBBBBBBBBBBRRRRRRRRBBBBLLLLLLLLBBBBBBBBBBBBBB"),
            "ssssssssssssssllllllllllllrrrrrrrrssssssssssssss");
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
