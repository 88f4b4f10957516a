// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/signals.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/sensors/sites.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::retrieval {
namespace {

using testing::database_of;
using testing::swaying_motion;
using testing::template_skeleton;

constexpr Channels kInertial = Channel::specific_force | Channel::gravity_direction;

std::string complaint(const std::function<void()>& call) {
  try {
    call();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(ComparedSignals, AreAllForcesAndThenTheGravityDirectionsThatThereAre) {
  const std::vector<Sensor> sensors{
      {0, 1.0, kInertial}, {3, 0.4, Channel::specific_force}, {4, 0.5, kInertial}};
  const auto signals = compared_signals(sensors, true);
  ASSERT_EQ(signals.size(), 5U);
  const std::vector<Eigen::Index> columns{0, 1, 2, 0, 2};
  for (std::size_t s = 0; s < signals.size(); ++s) {
    EXPECT_EQ(signals[s].sensor, columns[s]);
    const Sensor& sensor = sensors[static_cast<std::size_t>(columns[s])];
    EXPECT_EQ(signals[s].site, sensor.site);
    EXPECT_EQ(signals[s].position_along_bone, sensor.position_along_bone);
    EXPECT_EQ(signals[s].channel, s < 3 ? Channel::specific_force : Channel::gravity_direction);
  }
  EXPECT_EQ(compared_signals(sensors, false).size(), 3U);
}

TEST(ComparedSignals, RefuseNoSensorsAndTwoAtOneSite) {
  EXPECT_NE(complaint([] { compared_signals({}, false); }).find("at least one sensor"),
            std::string::npos);
  const std::vector<Sensor> twins{{0, 1.0}, {2, 1.0}, {0, 0.5}};
  EXPECT_NE(complaint([&] { compared_signals(twins, false); }).find("two sensors at left_wrist"),
            std::string::npos);
}

TEST(ComparedSignals, KnowTheLegs) {
  for (const auto& [site, is_leg] :
       {std::pair{"left_ankle", true}, {"right_thigh", true}, {"pelvis", false}, {"head", false}})
    EXPECT_EQ(is_on_leg({0, find_site(site), 1.0, Channel::specific_force}), is_leg) << site;
}

TEST(DatabaseSignals, AreThoseOfTheSensorsInTheirOrderAndPosition) {
  const auto database = database_of({swaying_motion(template_skeleton(), 1, 30, 50.0)});
  const std::vector<Sensor> sensors{{find_site("head"), 1.0, Channel::specific_force},
                                    {find_site("left_ankle"), 0.25, kInertial}};
  const FeatureRows rows = database_signals(*database, compared_signals(sensors, true));
  ASSERT_EQ(rows.cols(), 9);
  const SiteRows& head = database->site(static_cast<std::size_t>(find_site("head")));
  const SiteRows& ankle = database->site(static_cast<std::size_t>(find_site("left_ankle")));
  for (int n = 0; n < database->num_frames(); ++n) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(rows(n, k), head.specific_force_end(n, k));
      EXPECT_NEAR(rows(n, 3 + k),
                  0.75F * ankle.specific_force_pivot(n, k) + 0.25F * ankle.specific_force_end(n, k),
                  1e-5F);
      EXPECT_EQ(rows(n, 6 + k), ankle.gravity_direction(n, k));
    }
  }
}

TEST(SignalRow, HoldsTheReadingAsTheDatabaseHoldsItsOwn) {
  const auto database = database_of({swaying_motion(template_skeleton(), 1, 30, 50.0)});
  const std::vector<Sensor> sensors{{find_site("head"), 1.0, Channel::specific_force},
                                    {find_site("left_ankle"), 0.25, kInertial}};
  const auto signals = compared_signals(sensors, true);
  const FeatureRows rows = database_signals(*database, signals);
  const auto take = testing::readings_of(*database, 0, sensors);
  for (std::size_t t = 0; t < take.size(); ++t)
    EXPECT_LT((signal_row(take[t], signals) - rows.row(static_cast<Eigen::Index>(t))).norm(),
              1e-5F);
}

TEST(SearchedFrames, LeaveOutExcludedClipsAndCopiesAtOtherTempos) {
  auto content = testing::content_of({swaying_motion(template_skeleton(), 1, 10, 25.0),
                                      swaying_motion(template_skeleton(), 2, 10, 25.0),
                                      swaying_motion(template_skeleton(), 3, 10, 25.0)},
                                     25.0);
  content.clips[1].tempo = 1.25;
  const auto database = database_of(content);
  const auto count = [&](bool use_copies, const std::vector<int>& excluded) {
    const auto is_searched = searched_frames(*database, use_copies, excluded);
    return std::count(is_searched.begin(), is_searched.end(), true);
  };
  EXPECT_EQ(count(true, {}), 30);
  EXPECT_EQ(count(false, {}), 20);
  EXPECT_EQ(count(true, {0}), 20);
  EXPECT_EQ(count(false, {0}), 10);
  EXPECT_TRUE(searched_frames(*database, false, {0})[25]);
  const auto refuses = [&](const std::vector<int>& excluded, const std::string& part) {
    const auto text = complaint([&] { searched_frames(*database, false, excluded); });
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  refuses({3}, "excluded clip 3");
  refuses({-1}, "excluded clip -1");
  refuses({0, 2}, "every clip");
}

}  // namespace
}  // namespace sparse_mocap::retrieval
