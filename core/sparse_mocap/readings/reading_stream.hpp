// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "sparse_mocap/readings/gravity_direction.hpp"
#include "sparse_mocap/readings/reading.hpp"
#include "sparse_mocap/readings/resampler.hpp"
#include "sparse_mocap/readings/sensor_sample.hpp"
#include "sparse_mocap/sensors/clock.hpp"
#include "sparse_mocap/sensors/filter.hpp"

namespace sparse_mocap {

// A sensor of a performance, and what makes its samples ideal. Only its sensor.channels are read.
struct SensorInput {
  Sensor sensor;
  SensorCorrection correction;
};

struct ReadingSettings {
  double rate_hz = 25.0;
  GravityAverage gravity_average = GravityAverage::causal;
  TrackerWorld tracker_world{};
  GaussianFilter filter = kReadingFilter;  // on all channels but orientation
};

// A sample as it arrived.
struct Arrival {
  double arrival_s = 0.0;      // on the machine's clock
  double device_time_s = 0.0;  // on the device's, unwrapped; NaN: it has none
  SensorSample sample;
};

// From the samples of a performance's sensors to readings at a method's rate: each sensor's clock
// is laid under the machine's, its samples are corrected, the direction of gravity is found, and
// everything is brought onto one time line. Live and on whole takes alike; one object serves one
// performance.
//
// A reading is given as soon as every channel of every sensor is known beyond the reach of the
// low-pass, so that no later sample can change it: delay_s() after its time. A channel that stays
// away for Resampler::kLongestGap_s more no longer holds up the others; see Resampler for silences.
// Directions of gravity over a whole take are known at its end alone, so flush() gives it all then.
class ReadingStream {
 public:
  // Throws std::invalid_argument without sensors, for a sensor without channels, and for a rate
  // that is not positive.
  ReadingStream(std::vector<SensorInput> sensors, const ReadingSettings& settings);

  // A sample at its time on the common clock. False when nothing of it was taken: what is wanted
  // is not finite, or not after the sensor's last. Readings begin with the first sample, even where
  // that one tells nothing.
  bool push(int sensor, double time_s, const SensorSample& sample);

  // Samples of one sensor that arrived together, by the device's clock; the common clock is the
  // machine's. Without a device's clock the arrivals are spread evenly. Samples without anything
  // that is wanted are dropped, and say nothing about clocks. Returns how many were taken.
  int push_arrivals(int sensor, std::span<const Arrival> arrivals);

  // The readings that can be had by now, in order; now_s is on the common clock.
  std::vector<Reading> ready(double now_s);

  // All further readings up to the last sample: the performance has ended.
  std::vector<Reading> flush();

  // How long after its time a reading can be had, when no sensor is late.
  double delay_s() const { return settings_.filter.reach_s(); }

  double rate_hz() const { return settings_.rate_hz; }
  const std::vector<SensorInput>& sensors() const { return sensors_; }

 private:
  struct ChannelState {
    Channel channel;
    Resampler resampler;
  };
  struct SensorState {
    SensorCorrection correction;
    ClockModel clock;
    GravityDirectionFilter gravity_direction;
    double last_s = -std::numeric_limits<double>::infinity();
    std::vector<double> times_s;  // of all samples, for averages over the whole take
    std::vector<Vec3> specific_force, angular_velocity;
    std::vector<ChannelState> channels;
  };

  static SensorState state_of(const SensorInput& input);
  Vec3 direction_of(SensorState& state, double time_s, const SensorSample& sample) const;
  void add_whole_take_directions();
  bool is_ready(double time_s, double now_s) const;
  Reading reading_at(double time_s, bool has_ended) const;
  double next_time_s() const {
    return *begin_s_ + static_cast<double>(num_given_) / settings_.rate_hz;
  }

  std::vector<SensorInput> sensors_;
  ReadingSettings settings_;
  std::vector<SensorState> states_;
  std::optional<double> begin_s_;
  double end_s_ = -std::numeric_limits<double>::infinity();
  long long num_given_ = 0;
};

// The readings of a whole take, from its first sample to its last; a recording for each sensor.
// Throws std::invalid_argument as the stream does, and unless there are as many sensors.
std::vector<Reading> readings_of(std::span<const SensorRecording> take,
                                 std::vector<SensorInput> sensors, const ReadingSettings& settings);

}  // namespace sparse_mocap
