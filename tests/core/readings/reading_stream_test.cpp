// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/readings/reading_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sparse_mocap/base/quaternions.hpp"
#include "support/random.hpp"

namespace sparse_mocap {
namespace {

using testing::Random;

const Channels kAll = Channel::specific_force | Channel::angular_velocity |
                      Channel::gravity_direction | Channel::orientation | Channel::position;
constexpr double kNone = SensorSample::kAbsent;

std::vector<SensorInput> inputs(std::size_t count, Channels channels) {
  return std::vector<SensorInput>(count, {{0, 1.0, channels}, {}});
}

// Irregular samples of everything, which now and then lack one thing.
SensorRecording recorded(Random& random, double begin_s, double end_s, double gap_begin_s = 99.0,
                         double gap_end_s = 99.0) {
  SensorRecording out;
  for (double t = begin_s; t < end_s; t += random.in(0.004, 0.016))
    if (t < gap_begin_s || t > gap_end_s) out.times_s.push_back(t);
  const auto count = static_cast<Eigen::Index>(out.times_s.size());
  out.specific_force = random.matrix(3, count, 20.0);
  out.angular_velocity = random.matrix(3, count, 2.0);
  out.position = random.matrix(3, count, 2.0);
  out.orientation.resize(4, count);
  for (Eigen::Index i = 0; i < count; ++i) out.orientation.col(i) = wxyz_of(random.rotation());
  for (Eigen::Index i = 7; i < count; i += 41) {
    out.specific_force(1, i) = kNone;
    out.angular_velocity(0, i + i % 2) = kNone;
    out.position(2, i - 3) = kNone;
    out.orientation(0, i - 1) = kNone;
  }
  return out;
}

// All of a take as it is heard: in the order of times, a moment's worth together.
std::vector<Reading> streamed(ReadingStream& stream, const std::vector<SensorRecording>& take,
                              double step_s) {
  std::vector<Reading> readings;
  std::vector<Eigen::Index> next(take.size(), 0);
  double end_s = 0.0;
  for (const auto& recording : take) end_s = std::max(end_s, recording.times_s.back());
  for (double now_s = 0.0; now_s < end_s + step_s; now_s += step_s) {
    for (std::size_t s = 0; s < take.size(); ++s)
      for (; next[s] < take[s].num_samples(); ++next[s]) {
        const double time_s = take[s].times_s[static_cast<std::size_t>(next[s])];
        if (time_s > now_s) break;
        stream.push(static_cast<int>(s), time_s, sample_at(take[s], next[s]));
      }
    for (auto& reading : stream.ready(now_s)) {
      EXPECT_GE(now_s, reading.time_s + stream.delay_s());
      EXPECT_LT(now_s, reading.time_s + stream.delay_s() + 0.1 + step_s + 1e-9);
      readings.push_back(std::move(reading));
    }
  }
  for (auto& reading : stream.flush()) readings.push_back(std::move(reading));
  return readings;
}

// What a channel is at a time, by definition, from all samples that are finite.
struct Oracle {
  std::vector<double> times_s;
  std::vector<Eigen::VectorXd> values;

  Oracle(const std::vector<double>& all_times_s, const Eigen::MatrixXd& all) {
    for (Eigen::Index i = 0; i < all.cols(); ++i)
      if (all.col(i).allFinite()) {
        times_s.push_back(all_times_s[static_cast<std::size_t>(i)]);
        values.push_back(all.col(i));
      }
  }

  bool is_silent(double t) const {
    double before = -1e9, after = 1e9;
    for (const double time_s : times_s) {
      if (time_s <= t + 1e-6) before = std::max(before, time_s);
      if (time_s >= t - 1e-6) after = std::min(after, time_s);
    }
    if (before < -1e8) return after - t > 0.1 + 1e-6;
    if (after > 1e8) return t - before > 0.1 + 1e-6;
    return after - before > 0.1 + 1e-6 && t - before > 1e-6 && after - t > 1e-6;
  }

  Eigen::VectorXd low_passed(double t) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(values[0].size());
    double total = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < times_s.size(); ++i) {
      const double z = (times_s[i] - t) / 0.0115;
      if (std::abs(z) > 3.0) continue;
      sum += std::exp(-0.5 * z * z) * values[i];
      total += std::exp(-0.5 * z * z);
      ++count;
    }
    return count > 1 ? Eigen::VectorXd(sum / total) : interpolated(t);
  }

  Eigen::VectorXd interpolated(double t) const {
    if (t <= times_s.front()) return values.front();
    if (t >= times_s.back()) return values.back();
    std::size_t i = 0;
    while (times_s[i + 1] < t) ++i;
    const double part = (t - times_s[i]) / (times_s[i + 1] - times_s[i]);
    return (1.0 - part) * values[i] + part * values[i + 1];
  }

  // Shoemake's formula.
  Eigen::VectorXd slerped(double t) const {
    if (t <= times_s.front()) return values.front();
    if (t >= times_s.back()) return values.back();
    std::size_t i = 0;
    while (times_s[i + 1] < t) ++i;
    const double part = (t - times_s[i]) / (times_s[i + 1] - times_s[i]);
    const double cosine = values[i].dot(values[i + 1]), sign = cosine < 0.0 ? -1.0 : 1.0;
    const double angle = std::acos(std::min(std::abs(cosine), 1.0));
    return (std::sin((1.0 - part) * angle) * values[i] +
            sign * std::sin(part * angle) * values[i + 1]) /
           std::sin(angle);
  }
};

void expect_vector(const Eigen::VectorXd& found, const Oracle& oracle, double t) {
  if (oracle.is_silent(t))
    EXPECT_TRUE(found.array().isNaN().all()) << t;
  else
    EXPECT_LT((found - oracle.low_passed(t)).norm(), 1e-12) << t;
}

void expect_rotation(const Eigen::VectorXd& found, const Oracle& oracle, double t) {
  if (oracle.is_silent(t))
    EXPECT_TRUE(found.array().isNaN().all()) << t;
  else
    EXPECT_NEAR(std::abs(found.dot(oracle.slerped(t))), 1.0, 1e-12) << t;
}

void expect_as_defined(const std::vector<Reading>& readings,
                       const std::vector<SensorRecording>& take, GravityAverage average) {
  for (std::size_t s = 0; s < take.size(); ++s) {
    const auto& recording = take[s];
    const auto at = static_cast<Eigen::Index>(s);
    const Oracle force(recording.times_s, recording.specific_force),
        turn(recording.times_s, recording.angular_velocity),
        up(recording.times_s, gravity_directions(recording, average)),
        orientation(recording.times_s, recording.orientation),
        position(recording.times_s, recording.position);
    for (const Reading& reading : readings) {
      expect_vector(reading.specific_force.col(at), force, reading.time_s);
      expect_vector(reading.angular_velocity.col(at), turn, reading.time_s);
      expect_vector(reading.gravity_direction.col(at), up, reading.time_s);
      expect_vector(reading.position.col(at), position, reading.time_s);
      expect_rotation(reading.orientation.col(at), orientation, reading.time_s);
    }
  }
}

bool is_same(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return ((a.array() == b.array()) || (a.array().isNaN() && b.array().isNaN())).all();
}

void expect_same(const std::vector<Reading>& found, const std::vector<Reading>& wanted) {
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_EQ(found[k].time_s, wanted[k].time_s);
    EXPECT_TRUE(is_same(found[k].specific_force, wanted[k].specific_force)) << k;
    EXPECT_TRUE(is_same(found[k].angular_velocity, wanted[k].angular_velocity)) << k;
    EXPECT_TRUE(is_same(found[k].gravity_direction, wanted[k].gravity_direction)) << k;
    EXPECT_TRUE(is_same(found[k].orientation, wanted[k].orientation)) << k;
    EXPECT_TRUE(is_same(found[k].position, wanted[k].position)) << k;
  }
}

TEST(ReadingStream, RefusesWhatItCannotServe) {
  EXPECT_THROW(ReadingStream({}, {}), std::invalid_argument);
  EXPECT_THROW(ReadingStream(inputs(1, kAll), {.rate_hz = 0.0}), std::invalid_argument);
  EXPECT_THROW(ReadingStream(inputs(1, {}), {}), std::invalid_argument);
  EXPECT_THROW(readings_of({}, inputs(1, kAll), {}), std::invalid_argument);
  ReadingStream stream(inputs(1, Channel::specific_force), {});
  EXPECT_THROW(stream.push(1, 0.0, {}), std::out_of_range);
  EXPECT_THROW(stream.ready(kNone), std::invalid_argument);
  EXPECT_TRUE(stream.ready(1e6).empty());
  EXPECT_TRUE(stream.flush().empty());
}

TEST(ReadingStream, GivesAWholeTakeAsItIsDefined) {
  Random random(3);
  // One sensor falls silent for a while, one starts late and ends early.
  const std::vector<SensorRecording> take{recorded(random, 7.0, 12.0, 9.0, 9.6),
                                          recorded(random, 8.2, 10.9)};
  for (const GravityAverage average : {GravityAverage::causal, GravityAverage::whole_take}) {
    const auto readings =
        readings_of(take, inputs(2, kAll), {.rate_hz = 40.0, .gravity_average = average});
    const double length_s = take[0].times_s.back() - take[0].times_s.front();
    ASSERT_EQ(readings.size(), static_cast<std::size_t>(length_s * 40.0 + 1e-6) + 1);
    for (std::size_t k = 0; k < readings.size(); ++k)
      EXPECT_DOUBLE_EQ(readings[k].time_s, take[0].times_s[0] + static_cast<double>(k) / 40.0);
    expect_as_defined(readings, take, average);
  }
}

TEST(ReadingStream, GivesTheSameLiveHoweverSamplesCome) {
  Random random(4);
  const std::vector<SensorRecording> take{recorded(random, 7.0, 12.0, 9.0, 9.6),
                                          recorded(random, 7.02, 12.05)};
  const auto whole = readings_of(take, inputs(2, kAll), {});
  for (const double step_s : {0.003, 0.02, 0.09}) {
    ReadingStream stream(inputs(2, kAll), {});
    auto live = streamed(stream, take, step_s);
    expect_same(live, whole);
  }
}

// Over a whole take nothing is ready before its end.
TEST(ReadingStream, AveragesOverAWholeTakeAtItsEnd) {
  Random random(5);
  const std::vector<SensorRecording> take{recorded(random, 1.0, 4.0), recorded(random, 1.0, 4.0)};
  const ReadingSettings settings{.gravity_average = GravityAverage::whole_take};
  ReadingStream stream(inputs(2, kAll), settings);
  for (const std::size_t s : {1U, 0U})
    for (Eigen::Index t = 0; t < take[s].num_samples(); ++t)
      stream.push(static_cast<int>(s), take[s].times_s[static_cast<std::size_t>(t)],
                  sample_at(take[s], t));
  EXPECT_TRUE(stream.ready(100.0).empty());
  expect_same(stream.flush(), readings_of(take, inputs(2, kAll), settings));
}

TEST(ReadingStream, CorrectsSamplesFirst) {
  Random random(6);
  SensorRecording worn = recorded(random, 0.0, 3.0);
  const SensorInput input{{0, 1.0, kAll},
                          {9.8, random.rotation().toRotationMatrix(), Vec3(0.1, -0.2, 0.05)}};
  const TrackerWorld world{0.7, Vec3(1.0, 0.0, -2.0)};
  SensorRecording ideal = worn;
  for (Eigen::Index t = 0; t < worn.num_samples(); ++t) {
    const SensorSample sample = world(input.correction(sample_at(worn, t)));
    ideal.specific_force.col(t) = sample.specific_force;
    ideal.angular_velocity.col(t) = sample.angular_velocity;
    ideal.orientation.col(t) = sample.orientation;
    ideal.position.col(t) = sample.position;
  }
  expect_same(readings_of({&worn, 1}, {input}, {.tracker_world = world}),
              readings_of({&ideal, 1}, inputs(1, kAll), {}));
}

TEST(ReadingStream, GivesOnlyWhatIsWanted) {
  Random random(7);
  const std::vector<SensorRecording> take{recorded(random, 0.0, 2.0), recorded(random, 0.0, 2.0)};
  auto sensors = inputs(2, Channel::specific_force);
  sensors[1].sensor.channels = Channel::position;
  for (const Reading& reading : readings_of(take, sensors, {})) {
    EXPECT_TRUE(reading.specific_force.col(0).allFinite());
    EXPECT_TRUE(reading.position.col(1).allFinite());
    EXPECT_TRUE(reading.specific_force.col(1).array().isNaN().all());
    EXPECT_TRUE(reading.position.col(0).array().isNaN().all());
    EXPECT_TRUE(reading.gravity_direction.array().isNaN().all());
    EXPECT_TRUE(reading.orientation.array().isNaN().all());
  }
}

// Times of samples that tell nothing are of the take as well.
TEST(ReadingStream, BeginsAndEndsWithSamplesThatTellNothing) {
  SensorRecording recording{{}, Eigen::Matrix3Xd::Ones(3, 101), {}};
  for (int i = 0; i <= 100; ++i) recording.times_s.push_back(0.02 * i);
  recording.specific_force.leftCols(10).setConstant(kNone);
  recording.specific_force.rightCols(20).setConstant(kNone);
  const auto readings = readings_of({&recording, 1}, inputs(1, Channel::specific_force), {});
  ASSERT_EQ(readings.size(), 51U);
  for (const Reading& reading : readings)
    EXPECT_EQ(reading.specific_force.hasNaN(),
              reading.time_s < 0.1 - 1e-6 || reading.time_s > 1.7 + 1e-6)
        << reading.time_s;
}

TEST(ReadingStream, WaitsNoLongerThanTheLowPassReaches) {
  ReadingStream stream(inputs(1, Channel::specific_force), {});
  SensorSample sample;
  sample.specific_force = Vec3::UnitX();
  for (int i = 0; i <= 7; ++i) {
    stream.push(0, i * 0.005, sample);
    EXPECT_EQ(stream.ready(i * 0.005).size(), i == 7 ? 1U : 0U) << i;
  }
  EXPECT_NEAR(stream.delay_s(), 0.0345, 1e-12);
}

TEST(ReadingStream, GoesOnWithoutASensorThatLeft) {
  ReadingStream stream(inputs(2, Channel::specific_force), {});
  SensorSample sample;
  sample.specific_force = Vec3::UnitX();
  for (int i = 0; i < 200; ++i) {
    stream.push(0, i * 0.01, sample);
    if (i < 50) stream.push(1, i * 0.01, sample);
  }
  const auto readings = stream.ready(1.99);
  ASSERT_GT(readings.size(), 45U);
  EXPECT_FALSE(readings[11].specific_force.hasNaN());
  EXPECT_FALSE(readings[14].specific_force.col(0).hasNaN());
  EXPECT_TRUE(readings[14].specific_force.col(1).hasNaN());
}

std::vector<Arrival> arrivals(const SensorRecording& recording, double offset_s, bool has_clock) {
  std::vector<Arrival> out;
  for (Eigen::Index t = 0; t < recording.num_samples(); ++t) {
    const double time_s = recording.times_s[static_cast<std::size_t>(t)];
    out.push_back({time_s + offset_s, has_clock ? time_s : kNone, sample_at(recording, t)});
  }
  return out;
}

TEST(ReadingStream, LaysADevicesClockUnderTheArrivals) {
  Random random(8);
  const SensorRecording recording = recorded(random, 3.0, 6.0);
  for (const bool has_clock : {true, false}) {
    ReadingStream stream(inputs(1, Channel::specific_force), {});
    const auto all = arrivals(recording, 100.0, has_clock);
    for (std::size_t i = 0; i < all.size(); ++i) stream.push_arrivals(0, {&all[i], 1});
    const auto readings = stream.flush();
    const Oracle oracle(recording.times_s, recording.specific_force);
    ASSERT_GT(readings.size(), 74U);
    EXPECT_NEAR(readings[0].time_s, 103.0, 1e-4);
    for (const Reading& reading : readings)
      EXPECT_LT((reading.specific_force - oracle.low_passed(reading.time_s - 100.0)).norm(), 0.5)
          << reading.time_s;
  }
}

// Neither the clock nor the beginning comes of them.
TEST(ReadingStream, DropsArrivalsWithoutWhatIsWanted) {
  SensorSample nothing, sample;
  nothing.angular_velocity = Vec3::UnitX();
  sample.specific_force = Vec3::UnitY();
  ReadingStream stream(inputs(1, Channel::specific_force), {});
  const std::vector<Arrival> some{
      {50.0, kNone, nothing}, {60.0, 0.0, sample}, {60.01, 0.01, sample}};
  EXPECT_EQ(stream.push_arrivals(0, some), 2);
  const auto readings = stream.flush();
  ASSERT_FALSE(readings.empty());
  EXPECT_NEAR(readings[0].time_s, 60.0, 1e-3);
}

// An hour at 100 Hz would take minutes if each reading cost what was recorded before it.
TEST(ReadingStream, CostsEachSampleOnce) {
  ReadingStream stream(inputs(1, Channel::specific_force), {});
  SensorSample sample;
  sample.specific_force = Vec3::UnitX();
  for (int i = 0; i < 360000; ++i) stream.push(0, 0.01 * i, sample);
  EXPECT_GT(stream.ready(3600.0).size(), 89990U);
}

}  // namespace
}  // namespace sparse_mocap
