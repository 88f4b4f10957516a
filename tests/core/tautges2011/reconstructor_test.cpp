// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/reconstructor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "sparse_mocap/base/errors.hpp"
#include "support/refusals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::tautges2011 {
namespace {

using testing::paper_sensors;
using testing::readings_of;
using testing::swaying_motion;
using testing::template_skeleton;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// One database for all tests: twelve different movements of four seconds.
const std::shared_ptr<const MotionDatabase>& shared_database() {
  static const auto database = [] {
    std::vector<Motion> motions;
    for (unsigned seed = 0; seed < 12; ++seed)
      motions.push_back(swaying_motion(template_skeleton(), seed, 200, 50.0));
    return testing::database_of(motions);
  }();
  return database;
}

// The mean distance of the estimates from a clip, m, heading frame.
double mean_error_m(const std::vector<PoseEstimate>& estimates, int clip) {
  const auto& database = *shared_database();
  const Clip& truth = database.clips()[static_cast<std::size_t>(clip)];
  double sum = 0.0;
  for (std::size_t t = 0; t < estimates.size(); ++t)
    for (Eigen::Index j = 0; j < kNumStandardJoints; ++j)
      sum += (estimates[t].positions.segment<3>(3 * j) - database.positions()
                                                             .row(truth.begin + static_cast<int>(t))
                                                             .segment<3>(3 * j)
                                                             .transpose()
                                                             .cast<double>())
                 .norm();
  return sum / static_cast<double>(estimates.size()) / kNumStandardJoints;
}

void expect_same(const std::vector<PoseEstimate>& a, const std::vector<PoseEstimate>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t t = 0; t < a.size(); ++t) {
    EXPECT_EQ(a[t].angles, b[t].angles) << t;
    EXPECT_EQ(a[t].root_position, b[t].root_position);
    EXPECT_EQ(a[t].yaw_rad, b[t].yaw_rad);
    EXPECT_EQ(a[t].database_frame, b[t].database_frame);
  }
}

void expect_finite(const std::vector<PoseEstimate>& estimates) {
  for (const auto& estimate : estimates) {
    ASSERT_TRUE(estimate.angles.allFinite());
    ASSERT_TRUE(estimate.positions.allFinite());
    ASSERT_TRUE(estimate.root_position.allFinite());
    ASSERT_TRUE(std::isfinite(estimate.yaw_rad));
    ASSERT_TRUE(estimate.spread_m.allFinite());
  }
}

TEST(Reconstructor, RefusesSettingsThatCannotWork) {
  const auto refuses = [](std::vector<WornSensor> sensors, const Config& config,
                          const std::vector<int>& excluded, const std::string& part) {
    try {
      Reconstructor(shared_database(), std::move(sensors), config, excluded);
      ADD_FAILURE() << part;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refuses({}, {}, {}, "at least one sensor");
  refuses({{0, 1.0}, {2, 1.0}, {0, 0.5}}, {}, {}, "two sensors at left_wrist");
  refuses(paper_sensors(), {}, {12}, "excluded clip 12");
  refuses(paper_sensors(), {}, {-1}, "excluded clip -1");
  refuses(paper_sensors(), {}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, "every clip");
  Config config;
  config.num_paths = 0;
  refuses(paper_sensors(), config, {}, "num_paths");
}

TEST(Reconstructor, RefusesReadingsOfOtherSensors) {
  Reconstructor method(shared_database(), paper_sensors(), preset("paper"));
  EXPECT_REFUSED(ConfigError, "4 sensors is expected, got 3", method.step(Reading::Zero(3, 3)));
  EXPECT_REFUSED(ConfigError, "4 sensors is expected, got 5", method.step(Reading::Zero(3, 5)));
  EXPECT_TRUE(method.step(Reading::Zero(3, 4)).has_value());
}

class EachPreset : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<Reconstructor> made(const std::vector<int>& excluded = {}) const {
    return std::make_unique<Reconstructor>(shared_database(), paper_sensors(), preset(GetParam()),
                                           excluded);
  }
  const std::vector<Reading> take_ = readings_of(*shared_database(), 4, paper_sensors());
};

TEST_P(EachPreset, GivesOneEstimateAReadingAfterItsLatency) {
  const auto method = made();
  const int latency = method->latency_frames();
  std::vector<PoseEstimate> stepped;
  for (std::size_t t = 0; t < take_.size(); ++t) {
    auto estimate = method->step(take_[t]);
    EXPECT_EQ(estimate.has_value(), static_cast<int>(t) >= latency);
    if (estimate) stepped.push_back(*estimate);
  }
  const auto owed = method->flush();
  EXPECT_EQ(static_cast<int>(owed.size()), latency);
  stepped.insert(stepped.end(), owed.begin(), owed.end());
  EXPECT_TRUE(method->flush().empty());
  expect_same(stepped, solve_online(*made(), take_, Progress()));
}

TEST_P(EachPreset, AnswersTakesShorterThanItsWindows) {
  for (const std::size_t length : {0U, 1U, 2U, 3U}) {
    const std::vector<Reading> take(take_.begin(),
                                    take_.begin() + static_cast<std::ptrdiff_t>(length));
    const auto online = solve_online(*made(), take, Progress());
    const auto offline = made()->solve(take, Progress());
    EXPECT_EQ(online.size(), length);
    EXPECT_EQ(offline.size(), length);
    expect_finite(online);
    expect_finite(offline);
  }
}

TEST_P(EachPreset, ReconstructsAPerformanceThatIsInTheDatabase) {
  const double online = mean_error_m(solve_online(*made(), take_, Progress()), 4);
  const double offline = mean_error_m(made()->solve(take_, Progress()), 4);
  RecordProperty("online_mm", static_cast<int>(1000 * online));
  RecordProperty("offline_mm", static_cast<int>(1000 * offline));
  // The paper's kernel and weights mix the best path's pose with those around it.
  const double allowed = GetParam() == "paper" ? 0.05 : 0.03;
  EXPECT_LT(online, allowed);
  EXPECT_LT(offline, allowed);
}

TEST_P(EachPreset, GivesTheSameResultsAgain) {
  const auto method = made();
  const auto online = solve_online(*method, take_, Progress());
  const auto offline = method->solve(take_, Progress());
  expect_same(method->solve(take_, Progress()), offline);
  for (int t = 0; t < 7; ++t) method->step(take_[static_cast<std::size_t>(40 + t)]);
  expect_same(solve_online(*method, take_, Progress()), online);
  for (int t = 0; t < 7; ++t) method->step(take_[static_cast<std::size_t>(40 + t)]);
  method->reset();
  expect_same(made()->solve(take_, Progress()), offline);
  expect_same(method->solve(take_, Progress()), offline);
}

TEST_P(EachPreset, NeverLeansOnExcludedClips) {
  const auto method = made({4, 7});
  for (const auto& estimates :
       {solve_online(*method, take_, Progress()), method->solve(take_, Progress())})
    for (const auto& estimate : estimates) {
      EXPECT_NE(estimate.clip, 4);
      EXPECT_NE(estimate.clip, 7);
      EXPECT_EQ(estimate.clip, shared_database()->clip_index(estimate.database_frame));
    }
}

TEST_P(EachPreset, KeepsGoingWhileSensorsAreSilent) {
  auto take = take_;
  for (std::size_t t = 20; t < 50; ++t) take[t].col(1).setConstant(kNan);
  for (std::size_t t = 35; t < 40; ++t) take[t].setConstant(kNan);
  for (std::size_t t = 60; t < 70; ++t) take[t](2, 3) = kNan;
  const auto method = made();
  for (const auto& estimates :
       {solve_online(*method, take, Progress()), method->solve(take, Progress())}) {
    ASSERT_EQ(estimates.size(), take.size());
    expect_finite(estimates);
    for (std::size_t t = 0; t < take.size(); ++t)
      for (Eigen::Index s = 0; s < 4; ++s)
        EXPECT_EQ(std::isnan(estimates[t].sensor_misfit_mps2[s]), take[t].col(s).hasNaN());
  }
  for (auto& reading : take) reading.setConstant(kNan);
  expect_finite(method->solve(take, Progress()));
}

TEST_P(EachPreset, WorksWithOneSensorAndWithAll) {
  std::vector<WornSensor> all;
  for (int site = 0; site < static_cast<int>(all_sites().size()); ++site)
    all.push_back({site, 0.7});
  for (const auto& sensors : {std::vector<WornSensor>{{0, 1.0}}, all}) {
    Reconstructor method(shared_database(), sensors, preset(GetParam()));
    const auto estimates = method.solve(readings_of(*shared_database(), 4, sensors), Progress());
    expect_finite(estimates);
    EXPECT_EQ(estimates.front().sensor_misfit_mps2.size(),
              static_cast<Eigen::Index>(sensors.size()));
  }
}

TEST_P(EachPreset, CanBeCancelled) {
  const Progress cancelling(
      [](std::size_t done, std::size_t, std::string_view) { return done < 5; });
  EXPECT_THROW(made()->solve(take_, cancelling), Cancelled);
  EXPECT_THROW(solve_online(*made(), take_, cancelling), Cancelled);
}

TEST_P(EachPreset, SaysWhereTheJointsOfItsAnglesAre) {
  JointTransforms pose;
  for (const auto& estimate : made()->solve(take_, Progress())) {
    forward_kinematics(shared_database()->skeleton(), Vec3::Zero(), estimate.angles, pose);
    for (Eigen::Index j = 0; j < kNumStandardJoints; ++j)
      EXPECT_LT(
          (estimate.positions.segment<3>(3 * j) - pose.end[static_cast<std::size_t>(j)]).norm(),
          1e-9);
    for (const double contact : estimate.contacts) {
      EXPECT_GE(contact, 0.0);
      EXPECT_LE(contact, 1.0 + 1e-9);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, EachPreset, ::testing::Values("default", "paper"),
                         [](const auto& test) { return test.param; });

// Any term but the pose prior may be switched off, in both rules and spaces.
TEST(Reconstructor, WorksWithAnyTermsSwitchedOff) {
  const auto take = readings_of(*shared_database(), 2, paper_sensors());
  const std::vector<Reading> start(take.begin(), take.begin() + 10);
  for (int off = 0; off < 32; ++off) {
    Config config;
    if ((off & 1) != 0) config.w_motion = 0.0;
    if ((off & 2) != 0) config.w_smooth = 0.0;
    if ((off & 4) != 0) config.w_contr = 0.0;
    if ((off & 8) != 0) config.motion_rule = MotionRule::exact;
    if ((off & 16) != 0) config.pose_space = PoseSpace::positions;
    Reconstructor method(shared_database(), paper_sensors(), config);
    expect_finite(solve_online(method, start, Progress()));
  }
}

TEST(Reconstructor, WorksOnADatabaseOfAFewFrames) {
  const auto tiny = testing::database_of({swaying_motion(template_skeleton(), 1, 3, 25.0)});
  for (const auto name : preset_names()) {
    Reconstructor method(tiny, paper_sensors(), preset(name));
    expect_finite(method.solve(readings_of(*tiny, 0, paper_sensors()), Progress()));
  }
}

}  // namespace
}  // namespace sparse_mocap::tautges2011
