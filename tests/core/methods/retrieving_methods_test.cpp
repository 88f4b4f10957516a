// SPDX-License-Identifier: GPL-3.0-or-later
//
// What every method that retrieves from a database must do, live and on whole takes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/methods/registry.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/sensors/sites.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

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

// A method in one of its two ways, as a whole take is solved by it.
struct Way {
  std::string method;
  bool is_live = true;
  OptionValues options = {};
};

using Solve =
    std::function<std::vector<PoseEstimate>(const std::vector<Reading>&, const Progress&)>;

Solve solver(const Way& way, const MethodContext& context, MethodSettings settings = {}) {
  settings.options.insert(way.options.begin(), way.options.end());
  const MethodEntry& entry = find_method(way.method);
  if (way.is_live) {
    const std::shared_ptr<LiveMethod> method = make_live_method(entry, settings, context);
    return [method](const auto& take, const auto& progress) {
      return solve_live(*method, take, progress);
    };
  }
  const std::shared_ptr<WholeTakeMethod> method = make_whole_take_method(entry, settings, context);
  return [method](const auto& take, const auto& progress) { return method->solve(take, progress); };
}

// At wrists and ankles, with all channels that the method uses, or must have.
Channels channels_of(const std::string& method) {
  const MethodInfo& info = find_method(method).info;
  return info.required_channels | info.one_channel_of | Channel::specific_force;
}

std::vector<Sensor> sensors_for(const std::string& method) {
  std::vector<Sensor> sensors = testing::paper_sensors();
  for (Sensor& sensor : sensors) sensor.channels = channels_of(method);
  return sensors;
}

void silence(Reading& reading, Eigen::Index sensor) {
  reading.specific_force.col(sensor).setConstant(kNan);
  reading.position.col(sensor).setConstant(kNan);
  reading.orientation.col(sensor).setConstant(kNan);
}

std::vector<Way> all_ways() {
  std::vector<Way> ways;
  for (const auto& method : methods()) {
    if (!method.info.needs_database) continue;
    if (method.make_live != nullptr) ways.push_back({method.info.name, true});
    if (method.make_whole_take != nullptr) ways.push_back({method.info.name, false});
  }
  ways.push_back({"path_regression", true, {{"lag_s", "0.2"}}});
  return ways;
}

// The mean distance of the estimates from a clip, m, heading frame.
double mean_error_m(const std::vector<PoseEstimate>& estimates, int clip) {
  const auto& database = *shared_database();
  const Clip& truth = database.clips()[static_cast<std::size_t>(clip)];
  const Eigen::MatrixXd found =
      joint_positions(to_motion(estimates, database.skeleton(), 25.0), PositionFrame::heading);
  double sum = 0.0;
  for (Eigen::Index t = 0; t < found.cols(); ++t) {
    const Eigen::VectorXd wanted =
        database.positions().row(truth.begin + static_cast<int>(t)).transpose().cast<double>();
    for (Eigen::Index j = 0; j < kNumStandardJoints; ++j)
      sum += (found.col(t) - wanted).segment<3>(3 * j).norm();
  }
  return sum / static_cast<double>(found.cols()) / kNumStandardJoints;
}

void expect_same(const std::vector<PoseEstimate>& a, const std::vector<PoseEstimate>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t t = 0; t < a.size(); ++t) {
    for (std::size_t j = 0; j < a[t].rotations.size(); ++j)
      EXPECT_EQ(a[t].rotations[j].coeffs(), b[t].rotations[j].coeffs()) << t;
    EXPECT_EQ(a[t].root_position, b[t].root_position);
    EXPECT_EQ(a[t].diagnostics.at("database_frame"), b[t].diagnostics.at("database_frame"));
  }
}

void expect_finite(const std::vector<PoseEstimate>& estimates) {
  for (const auto& estimate : estimates) {
    ASSERT_EQ(estimate.rotations.size(), static_cast<std::size_t>(kNumStandardJoints));
    for (const auto& rotation : estimate.rotations)
      ASSERT_NEAR(rotation.coeffs().norm(), 1.0, 1e-9);
    ASSERT_TRUE(estimate.root_position.allFinite());
    ASSERT_TRUE(estimate.diagnostics.at("spread_m").allFinite());
    for (const double contact : estimate.contacts) {
      ASSERT_GE(contact, 0.0);
      ASSERT_LE(contact, 1.0);
    }
  }
}

class EachWay : public ::testing::TestWithParam<Way> {
 protected:
  Solve made(const std::vector<int>& excluded = {}) const {
    return solver(GetParam(), {shared_database(), nullptr, {}, sensors_, excluded});
  }
  const std::vector<Sensor> sensors_ = sensors_for(GetParam().method);
  const std::vector<Reading> take_ = readings_of(*shared_database(), 4, sensors_);
};

TEST_P(EachWay, GivesOneEstimateAReadingAtItsTime) {
  const auto estimates = made()(take_, Progress());
  ASSERT_EQ(estimates.size(), take_.size());
  for (std::size_t t = 0; t < take_.size(); ++t) EXPECT_EQ(estimates[t].time_s, take_[t].time_s);
}

TEST_P(EachWay, AnswersTakesShorterThanItsWindows) {
  for (const std::size_t length : {0U, 1U, 2U, 3U}) {
    const std::vector<Reading> take(take_.begin(),
                                    take_.begin() + static_cast<std::ptrdiff_t>(length));
    const auto estimates = made()(take, Progress());
    EXPECT_EQ(estimates.size(), length);
    expect_finite(estimates);
  }
}

TEST_P(EachWay, ReconstructsAPerformanceThatIsInTheDatabase) {
  // The paper's kernel and weights mix the best path's pose with those around it; what is shown
  // follows these poses with a lag, which is left out here.
  const bool is_paper = GetParam().method == "tautges2011";
  MethodSettings settings;
  if (is_paper) settings.options["follow_s"] = "0";
  const auto solve = solver(GetParam(), {shared_database(), nullptr, {}, sensors_, {}}, settings);
  EXPECT_LT(mean_error_m(solve(take_, Progress()), 4), is_paper ? 0.05 : 0.03);
}

TEST_P(EachWay, GivesTheSameResultsAgain) {
  const auto solve = made();
  const auto first = solve(take_, Progress());
  solve({take_.begin() + 40, take_.begin() + 47}, Progress());
  expect_same(solve(take_, Progress()), first);
  expect_same(made()(take_, Progress()), first);
}

TEST_P(EachWay, GivesTheSameResultsOnAnyNumberOfThreads) {
  const auto on = [&](int num_threads) {
    MethodContext context{shared_database(), nullptr, {}, sensors_, {}};
    context.num_threads = num_threads;
    return solver(GetParam(), context)(take_, Progress());
  };
  const auto on_one = on(1);
  for (const int num_threads : {0, 2, 5}) expect_same(on(num_threads), on_one);
}

TEST_P(EachWay, HangsOnNoRounding) {
  const auto solve = made();
  const auto& skeleton = shared_database()->skeleton();
  const Motion plain = to_motion(solve(take_, Progress()), skeleton, 25.0);
  testing::Random random(1);
  auto take = take_;
  for (auto& reading : take) {
    reading.specific_force += 1e-6 * random.matrix(3, 4, 1.0);
    reading.position += 1e-6 * random.matrix(3, 4, 1.0);
  }
  const Motion other = to_motion(solve(take, Progress()), skeleton, 25.0);
  for (int t = 0; t < plain.num_frames(); ++t) {
    const JointTransforms a = plain.transforms(t), b = other.transforms(t);
    for (std::size_t j = 0; j < a.end.size(); ++j)
      ASSERT_LT((a.end[j] - b.end[j]).norm(), 1e-3) << t << " " << j;
  }
}

TEST_P(EachWay, TurnsNoJointFasterThanPeopleCan) {
  auto take = take_;
  std::swap_ranges(take.begin() + 30, take.begin() + 40, take.begin() + 60);  // and back at once
  const auto estimates = made()(take, Progress());
  for (std::size_t t = 1; t < estimates.size(); ++t)
    for (std::size_t j = 0; j < estimates[t].rotations.size(); ++j)
      EXPECT_LT(estimates[t].rotations[j].angularDistance(estimates[t - 1].rotations[j]),
                1400.0 * kRadiansPerDegree / 25.0 + 1e-9);
}

TEST_P(EachWay, NeverUsesExcludedClips) {
  for (const auto& estimate : made({4, 7})(take_, Progress())) {
    const auto clip = static_cast<int>(estimate.diagnostics.at("clip")[0]);
    EXPECT_NE(clip, 4);
    EXPECT_NE(clip, 7);
    const auto frame = static_cast<int>(estimate.diagnostics.at("database_frame")[0]);
    EXPECT_EQ(clip, shared_database()->clip_index(frame));
  }
}

TEST_P(EachWay, ContinuesWhileSensorsAreSilent) {
  auto take = take_;
  for (std::size_t t = 20; t < 50; ++t) silence(take[t], 1);
  for (std::size_t t = 35; t < 40; ++t)
    for (Eigen::Index s = 0; s < 4; ++s) silence(take[t], s);
  for (std::size_t t = 60; t < 70; ++t) take[t].specific_force(2, 3) = kNan;
  const auto estimates = made()(take, Progress());
  ASSERT_EQ(estimates.size(), take.size());
  expect_finite(estimates);
  for (std::size_t t = 0; t < take.size(); ++t)
    for (Eigen::Index s = 0; s < 4; ++s)
      EXPECT_EQ(std::isnan(estimates[t].diagnostics.at("sensor_misfit_mps2")[s]),
                take[t].specific_force.col(s).hasNaN());
  for (auto& reading : take)
    for (Eigen::Index s = 0; s < 4; ++s) silence(reading, s);
  expect_finite(made()(take, Progress()));
}

TEST_P(EachWay, WorksWithOneSensorWithAllAndWithGravityDirections) {
  std::vector<Sensor> all;
  for (int site = 0; site < static_cast<int>(all_sites().size()); ++site)
    all.push_back({site, 0.7, channels_of(GetParam().method) | Channel::gravity_direction});
  const std::vector<Sensor> one{{0, 1.0, channels_of(GetParam().method)}};
  for (const auto& sensors : {one, all}) {
    const auto solve = solver(GetParam(), {shared_database(), nullptr, {}, sensors, {}});
    const auto estimates = solve(readings_of(*shared_database(), 4, sensors), Progress());
    expect_finite(estimates);
    EXPECT_EQ(estimates.front().diagnostics.at("sensor_misfit_mps2").size(),
              static_cast<Eigen::Index>(sensors.size()));
  }
}

TEST_P(EachWay, RefusesReadingsOfOtherSensors) {
  EXPECT_THROW(made()({Reading(3)}, Progress()), ConfigError);
  EXPECT_THROW(made()({Reading(5)}, Progress()), ConfigError);
}

TEST_P(EachWay, CanBeCancelled) {
  const Progress cancelling(
      [](std::size_t done, std::size_t, std::string_view) { return done < 5; });
  EXPECT_THROW(made()(take_, cancelling), Cancelled);
}

TEST_P(EachWay, WorksOnADatabaseOfAFewFrames) {
  const auto tiny = testing::database_of({swaying_motion(template_skeleton(), 1, 3, 25.0)});
  const auto solve = solver(GetParam(), {tiny, nullptr, {}, sensors_, {}});
  expect_finite(solve(readings_of(*tiny, 0, sensors_), Progress()));
}

std::string name_of(const ::testing::TestParamInfo<Way>& test) {
  return test.param.method + (test.param.is_live ? "_live" : "_whole_take") +
         (test.param.options.empty() ? "" : "_late");
}

INSTANTIATE_TEST_SUITE_P(Methods, EachWay, ::testing::ValuesIn(all_ways()), name_of);

class EachLiveMethod : public ::testing::TestWithParam<Way> {};

TEST_P(EachLiveMethod, AnswersEachReadingAfterItsLatency) {
  const auto sensors = sensors_for(GetParam().method);
  const auto take = readings_of(*shared_database(), 4, sensors);
  const auto method = make_live_method(find_method(GetParam().method), {"", GetParam().options},
                                       {shared_database(), nullptr, {}, sensors, {}});
  const auto latency = static_cast<std::size_t>(std::lround(method->latency_s() * 25.0));
  EXPECT_GT(method->history_s(), 0.0);
  for (std::size_t t = 0; t < take.size(); ++t) {
    const auto estimate = method->step(take[t]);
    ASSERT_EQ(estimate.has_value(), t >= latency);
    if (estimate) {
      EXPECT_EQ(estimate->time_s, take[t - latency].time_s);
    }
  }
  EXPECT_EQ(method->flush().size(), latency);
  EXPECT_TRUE(method->flush().empty());
}

std::vector<Way> live_ways() {
  std::vector<Way> ways;
  for (const auto& way : all_ways())
    if (way.is_live) ways.push_back(way);
  return ways;
}

// What comes after a pose tells more about it: of a performance that the database lacks, poses that
// wait are nearer to the truth.
TEST(PathRegression, IsMoreAccurateTheLongerPosesWait) {
  const auto sensors = sensors_for("path_regression");
  const auto error_of = [&](const Way& way) {
    double sum_m = 0.0;
    for (const int clip : {1, 4, 7}) {
      const auto solve = solver(way, {shared_database(), nullptr, {}, sensors, {clip}});
      sum_m +=
          mean_error_m(solve(readings_of(*shared_database(), clip, sensors), Progress()), clip);
    }
    return sum_m / 3.0;
  };
  const double at_once = error_of({"path_regression", true, {}});
  const double late = error_of({"path_regression", true, {{"lag_s", "0.2"}}});
  EXPECT_LT(late, 0.99 * at_once);
}

INSTANTIATE_TEST_SUITE_P(Methods, EachLiveMethod, ::testing::ValuesIn(live_ways()), name_of);

}  // namespace
}  // namespace sparse_mocap
