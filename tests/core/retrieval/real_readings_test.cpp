// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/real_readings.hpp"

#include <gtest/gtest.h>

#include "support/synthetic.hpp"

namespace sparse_mocap::retrieval {
namespace {

using testing::swaying_motion;
using testing::template_skeleton;

// Two clips; with_take: sensors at both wrists measured during the second.
std::shared_ptr<const MotionDatabase> database(bool with_take) {
  auto content = testing::content_of({swaying_motion(template_skeleton(), 1, 30, 25.0),
                                      swaying_motion(template_skeleton(), 2, 30, 25.0)},
                                     25.0);
  if (with_take)
    content.clips[1].take = ClipTake{
        "take.csv",
        "hash",
        1.0,
        0.9,
        1.0,
        {{"left_wrist", Channel::specific_force}, {"right_wrist", Channel::specific_force}}};
  return testing::database_of(content);
}

TEST(RealReadings, FactorsFollowTheShareOfRealSignals) {
  auto sensors = testing::paper_sensors();
  const auto half = distance_factors(*database(true), all_signals(sensors), 0.4);
  ASSERT_EQ(half.size(), 2U);
  EXPECT_FLOAT_EQ(half[0], 1.0F);
  EXPECT_FLOAT_EQ(half[1], 0.8F);
  sensors.resize(2);
  EXPECT_FLOAT_EQ(distance_factors(*database(true), all_signals(sensors), 0.4)[1], 0.6F);
}

TEST(RealReadings, NothingIsScaledWithoutAny) {
  const auto signals = all_signals(testing::paper_sensors());
  EXPECT_TRUE(distance_factors(*database(false), signals, 0.4).empty());
  EXPECT_TRUE(distance_factors(*database(true), signals, 0.0).empty());
  EXPECT_TRUE(distance_factors(*database(true), std::span(signals).last(2), 0.4).empty());
}

TEST(RealReadings, NeighboursAreInOrderAgain) {
  std::vector<Neighbour> neighbours{{1.0F, 3}, {1.2F, 40}, {1.5F, 7}, {2.0F, 31}};
  scale_distances(*database(true), std::vector<float>{1.0F, 0.5F}, neighbours);
  const std::vector<Neighbour> expected{{0.6F, 40}, {1.0F, 3}, {1.0F, 31}, {1.5F, 7}};
  EXPECT_EQ(neighbours, expected);
}

}  // namespace
}  // namespace sparse_mocap::retrieval
