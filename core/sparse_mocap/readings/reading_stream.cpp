// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/readings/reading_stream.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sparse_mocap/readings/arrival_times.hpp"
#include "sparse_mocap/readings/channel_names.hpp"

namespace sparse_mocap {
namespace {

constexpr double kSlack = 1e-6;  // of a reading's interval, so that rounding loses no last reading

std::span<const double> numbers(const auto& vector) {
  return {vector.data(), static_cast<std::size_t>(vector.size())};
}

// The sample's value of a channel that it has as it is.
std::span<const double> value_of(const SensorSample& sample, Channel channel) {
  switch (channel) {
    case Channel::angular_velocity:
      return numbers(sample.angular_velocity);
    case Channel::position:
      return numbers(sample.position);
    case Channel::orientation:
      return numbers(sample.orientation);
    default:
      return numbers(sample.specific_force);
  }
}

void set_channel(Reading& reading, Eigen::Index sensor, Channel channel,
                 const Eigen::VectorXd& value) {
  switch (channel) {
    case Channel::specific_force:
      reading.specific_force.col(sensor) = value;
      break;
    case Channel::angular_velocity:
      reading.angular_velocity.col(sensor) = value;
      break;
    case Channel::gravity_direction:
      reading.gravity_direction.col(sensor) = value;
      break;
    case Channel::position:
      reading.position.col(sensor) = value;
      break;
    case Channel::orientation:
      reading.orientation.col(sensor) = value;
      break;
  }
}

Eigen::Map<const Eigen::Matrix3Xd> columns(const std::vector<Vec3>& vectors) {
  return {vectors.empty() ? nullptr : vectors.front().data(), 3,
          static_cast<Eigen::Index>(vectors.size())};
}

// The times of samples that arrived together, on the machine's clock.
std::vector<double> times_of(ClockModel& clock, std::span<const Arrival> arrivals) {
  std::vector<double> times_s;
  const bool has_clock = std::all_of(arrivals.begin(), arrivals.end(), [](const Arrival& arrival) {
    return std::isfinite(arrival.device_time_s);
  });
  for (const Arrival& arrival : arrivals)
    times_s.push_back(has_clock ? clock.observe(arrival.device_time_s, arrival.arrival_s)
                                : arrival.arrival_s);
  return has_clock ? times_s : spread_evenly(times_s);
}

}  // namespace

ReadingStream::ReadingStream(std::vector<SensorInput> sensors, const ReadingSettings& settings)
    : sensors_(std::move(sensors)), settings_(settings) {
  if (sensors_.empty() || !(settings.rate_hz > 0.0))
    throw std::invalid_argument("ReadingStream: sensors and a positive rate are needed");
  for (const SensorInput& input : sensors_) {
    if (input.sensor.channels.is_empty())
      throw std::invalid_argument("ReadingStream: a sensor needs a channel");
    states_.push_back(state_of(input));
  }
}

ReadingStream::SensorState ReadingStream::state_of(const SensorInput& input) {
  SensorState state;
  state.correction = input.correction;
  for (const Channel channel : all_channels()) {
    const auto kind =
        channel == Channel::orientation ? Resampler::Kind::rotation : Resampler::Kind::vector;
    if (input.sensor.channels.has(channel)) state.channels.push_back({channel, Resampler(kind)});
  }
  return state;
}

bool ReadingStream::push(int sensor, double time_s, const SensorSample& sample) {
  SensorState& state = states_.at(static_cast<std::size_t>(sensor));
  if (!std::isfinite(time_s)) return false;
  if (time_s > state.last_s) {
    if (num_given_ == 0) begin_s_ = std::min(begin_s_.value_or(time_s), time_s);
    end_s_ = std::max(end_s_, time_s);
    state.last_s = time_s;
  }
  const SensorSample ideal = settings_.tracker_world(state.correction(sample));
  bool is_taken = settings_.gravity_average == GravityAverage::whole_take &&
                  ideal.has_any(sensors_[static_cast<std::size_t>(sensor)].sensor.channels);
  for (auto& [channel, resampler] : state.channels) {
    if (channel == Channel::gravity_direction)
      is_taken |= resampler.push(time_s, numbers(direction_of(state, time_s, ideal)));
    else
      is_taken |= resampler.push(time_s, value_of(ideal, channel));
  }
  return is_taken;
}

// NaN while it is not known: over a whole take, until its end.
Vec3 ReadingStream::direction_of(SensorState& state, double time_s,
                                 const SensorSample& sample) const {
  if (settings_.gravity_average == GravityAverage::causal)
    return state.gravity_direction.update(time_s, sample.specific_force, sample.angular_velocity);
  state.times_s.push_back(time_s);
  state.specific_force.push_back(sample.specific_force);
  state.angular_velocity.push_back(sample.angular_velocity);
  return Vec3::Constant(SensorSample::kAbsent);
}

int ReadingStream::push_arrivals(int sensor, std::span<const Arrival> arrivals) {
  const auto s = static_cast<std::size_t>(sensor);
  SensorState& state = states_.at(s);
  std::vector<Arrival> wanted;
  for (const Arrival& arrival : arrivals)
    if (arrival.sample.has_any(sensors_[s].sensor.channels)) wanted.push_back(arrival);
  const std::vector<double> times_s = times_of(state.clock, wanted);
  int num_taken = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    num_taken += push(sensor, times_s[i], wanted[i].sample) ? 1 : 0;
  return num_taken;
}

bool ReadingStream::is_ready(double time_s, double now_s) const {
  const double known_s = time_s + settings_.filter.reach_s();
  if (now_s >= known_s + Resampler::kLongestGap_s) return true;
  return std::all_of(states_.begin(), states_.end(), [&](const SensorState& state) {
    return std::all_of(
        state.channels.begin(), state.channels.end(),
        [&](const ChannelState& channel) { return channel.resampler.reaches(known_s); });
  });
}

Reading ReadingStream::reading_at(double time_s, bool has_ended) const {
  Reading reading(static_cast<Eigen::Index>(states_.size()));
  reading.time_s = time_s;
  for (std::size_t s = 0; s < states_.size(); ++s)
    for (const auto& [channel, resampler] : states_[s].channels)
      set_channel(reading, static_cast<Eigen::Index>(s), channel,
                  resampler.at(time_s, settings_.filter, has_ended));
  return reading;
}

std::vector<Reading> ReadingStream::ready(double now_s) {
  std::vector<Reading> readings;
  if (!std::isfinite(now_s))
    throw std::invalid_argument("ReadingStream: the time now is not finite");
  if (settings_.gravity_average == GravityAverage::whole_take) return readings;
  while (begin_s_ && is_ready(next_time_s(), now_s)) {
    readings.push_back(reading_at(next_time_s(), false));
    ++num_given_;
    for (SensorState& state : states_)
      for (ChannelState& channel : state.channels)
        channel.resampler.forget(next_time_s() - settings_.filter.reach_s());
  }
  return readings;
}

void ReadingStream::add_whole_take_directions() {
  for (SensorState& state : states_) {
    const SensorRecording recording{std::exchange(state.times_s, {}), columns(state.specific_force),
                                    columns(state.angular_velocity)};
    const Eigen::Matrix3Xd directions = gravity_directions(recording, GravityAverage::whole_take);
    for (auto& [channel, resampler] : state.channels)
      for (Eigen::Index t = 0; channel == Channel::gravity_direction && t < recording.num_samples();
           ++t)
        resampler.push(recording.times_s[static_cast<std::size_t>(t)], numbers(directions.col(t)));
    state.specific_force.clear();
    state.angular_velocity.clear();
  }
}

std::vector<Reading> ReadingStream::flush() {
  std::vector<Reading> readings;
  if (!begin_s_) return readings;
  add_whole_take_directions();
  const auto count = static_cast<long long>((end_s_ - *begin_s_) * settings_.rate_hz + kSlack) + 1;
  for (; num_given_ < count; ++num_given_) readings.push_back(reading_at(next_time_s(), true));
  return readings;
}

std::vector<Reading> readings_of(std::span<const SensorRecording> take,
                                 std::vector<SensorInput> sensors,
                                 const ReadingSettings& settings) {
  if (take.size() != sensors.size())
    throw std::invalid_argument("readings_of: a recording for each sensor is needed");
  ReadingStream stream(std::move(sensors), settings);
  for (std::size_t s = 0; s < take.size(); ++s)
    for (Eigen::Index t = 0; t < take[s].num_samples(); ++t)
      stream.push(static_cast<int>(s), take[s].times_s[static_cast<std::size_t>(t)],
                  sample_at(take[s], t));
  return stream.flush();
}

}  // namespace sparse_mocap
