// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/readings/take_alignment.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sparse_mocap/base/quaternions.hpp"
#include "sparse_mocap/sensors/filter.hpp"
#include "sparse_mocap/sensors/virtual_sensor.hpp"

namespace sparse_mocap {
namespace {

constexpr double kCoarse_hz = 25.0, kFine_hz = 200.0;
constexpr double kFineReach_s = 1.5 / kCoarse_hz;
constexpr double kLeastOverlap = 0.6;  // of the shorter one
constexpr double kShortest_s = 0.8;
// Root mean squares below which a signal says nothing.
constexpr double kLeastForce_mps2 = 0.1, kLeastTurn_radps = 0.05, kLeastLean = 0.02;

// Three axes over time: what one sensor reads.
struct Signal {
  std::vector<double> times_s;
  Eigen::Matrix3Xd values;
};

// What is compared of one sensor; the signals turn together.
struct ComparedSensor {
  struct Pair {
    Signal motion, take;
    std::size_t kind;  // index in kLeast
  };
  std::vector<Pair> pairs;
};
constexpr double kLeast[] = {kLeastForce_mps2, kLeastTurn_radps, kLeastLean};

void append(Signal& signal, double time_s, const Vec3& value) {
  if (!value.allFinite() || !(signal.times_s.empty() || time_s > signal.times_s.back())) return;
  const auto count = static_cast<Eigen::Index>(signal.times_s.size());
  if (count == signal.values.cols())
    signal.values.conservativeResize(3, std::max<Eigen::Index>(2 * count, 1024));
  signal.times_s.push_back(time_s);
  signal.values.col(count) = value;
}

// Force, turning and, for sensors that tell their orientation, which way is up.
std::array<Signal, 3> measured_signals(const SensorRecording& recording,
                                       const SensorInput& sensor) {
  std::array<Signal, 3> signals;
  const Channels channels = sensor.sensor.channels;
  for (Eigen::Index t = 0; t < recording.num_samples(); ++t) {
    const double time_s = recording.times_s[static_cast<std::size_t>(t)];
    const SensorSample sample = sensor.correction(sample_at(recording, t));
    if (channels.has(Channel::specific_force)) append(signals[0], time_s, sample.specific_force);
    if (channels.has(Channel::angular_velocity))
      append(signals[1], time_s, sample.angular_velocity);
    if (channels.has(Channel::orientation) && sample.orientation.allFinite())
      append(signals[2], time_s, quaternion_of(sample.orientation).normalized().conjugate() * kUp);
  }
  for (Signal& signal : signals)
    signal.values.conservativeResize(3, static_cast<Eigen::Index>(signal.times_s.size()));
  return signals;
}

ComparedSensor compared(const Motion& motion, const VirtualReadings& virtual_readings,
                        const SensorRecording& recording, const SensorInput& sensor) {
  std::vector<double> times_s;
  for (int t = 0; t < motion.num_frames(); ++t) times_s.push_back(t * motion.frame_time_s);
  const Eigen::Matrix3Xd modelled[] = {
      virtual_readings.specific_force(sensor.sensor.position_along_bone),
      virtual_readings.angular_velocity, virtual_readings.gravity_direction};
  ComparedSensor out;
  auto measured = measured_signals(recording, sensor);
  for (std::size_t kind = 0; kind < measured.size(); ++kind)
    if (measured[kind].times_s.size() > 1)
      out.pairs.push_back({{times_s, modelled[kind]}, std::move(measured[kind]), kind});
  return out;
}

// A signal on an even grid, with sums from the beginning, so that means are quick.
struct Sampled {
  Eigen::Matrix3Xd values, sums;
  Eigen::VectorXd squares;

  Sampled(const Signal& signal, const std::vector<double>& grid_s) {
    values = filtered_at(signal.times_s, signal.values, grid_s, kReadingFilter);
    sums.setZero(3, values.cols() + 1);
    squares.setZero(values.cols() + 1);
    for (Eigen::Index i = 0; i < values.cols(); ++i) {
      sums.col(i + 1) = sums.col(i) + values.col(i);
      squares[i + 1] = squares[i] + values.col(i).squaredNorm();
    }
  }
  Vec3 mean(Eigen::Index begin, Eigen::Index count) const {
    return (sums.col(begin + count) - sums.col(begin)) / static_cast<double>(count);
  }
  // Of what differs from the mean.
  double energy(Eigen::Index begin, Eigen::Index count) const {
    return squares[begin + count] - squares[begin] -
           static_cast<double>(count) * mean(begin, count).squaredNorm();
  }
};

std::vector<double> grid(double begin_s, double end_s, double rate_hz) {
  std::vector<double> times_s;
  const auto count = static_cast<long long>((end_s - begin_s) * rate_hz + 1e-6) + 1;
  for (long long i = 0; i < count; ++i)
    times_s.push_back(begin_s + static_cast<double>(i) / rate_hz);
  return times_s;
}

// The most that the trace of R C can be for a rotation R.
double best_trace(const Mat3& covariance) {
  const Vec3 s = Eigen::JacobiSVD<Mat3>(covariance).singularValues();
  return s[0] + s[1] + (covariance.determinant() < 0.0 ? -s[2] : s[2]);
}

// Compares stretches of the motion and of the take, both on grids of one rate.
class Comparison {
 public:
  Comparison(const std::vector<ComparedSensor>& sensors, const std::vector<double>& motion_s,
             const std::vector<double>& take_s) {
    for (const auto& sensor : sensors) {
      auto& pairs = sensors_.emplace_back();
      for (const auto& pair : sensor.pairs)
        pairs.push_back({Sampled(pair.motion, motion_s), Sampled(pair.take, take_s), pair.kind});
    }
  }

  // Of `count` samples from these on, over all sensors; puts those of each one where it is wanted.
  double correlation(Eigen::Index motion_at, Eigen::Index take_at, Eigen::Index count,
                     std::vector<double>* of_sensors = nullptr) const {
    std::array<double, 3> motion_energy{}, take_energy{};
    for (const auto& pairs : sensors_)
      for (const auto& pair : pairs) {
        motion_energy[pair.kind] += pair.motion.energy(motion_at, count);
        take_energy[pair.kind] += pair.take.energy(take_at, count);
      }
    std::array<double, 3> scale{};
    double num_kinds = 0.0;
    for (std::size_t kind = 0; kind < scale.size(); ++kind) {
      scale[kind] = norm(motion_energy[kind], take_energy[kind], kind, count);
      num_kinds += take_energy[kind] > 0.0 ? 1.0 : 0.0;
    }
    double sum = 0.0;
    for (const auto& pairs : sensors_) {
      Mat3 pooled = Mat3::Zero(), own = Mat3::Zero();
      for (const auto& pair : pairs) {
        const Mat3 C = covariance(pair, motion_at, take_at, count);
        pooled += C / scale[pair.kind];
        if (of_sensors != nullptr)
          own += C / norm(pair.motion.energy(motion_at, count), pair.take.energy(take_at, count),
                          pair.kind, count);
      }
      sum += best_trace(pooled);
      if (of_sensors != nullptr)
        of_sensors->push_back(pairs.empty() ? 0.0
                                            : best_trace(own) / static_cast<double>(pairs.size()));
    }
    return num_kinds > 0.0 ? sum / num_kinds : 0.0;
  }

 private:
  struct Pair {
    Sampled motion, take;
    std::size_t kind;
  };

  static double norm(double motion_energy, double take_energy, std::size_t kind,
                     Eigen::Index count) {
    const double least = kLeast[kind] * kLeast[kind] * static_cast<double>(count);
    return std::sqrt(std::max(motion_energy, least) * std::max(take_energy, least));
  }

  static Mat3 covariance(const Pair& pair, Eigen::Index motion_at, Eigen::Index take_at,
                         Eigen::Index count) {
    Mat3 C;
    C.noalias() = pair.take.values.middleCols(take_at, count) *
                  pair.motion.values.middleCols(motion_at, count).transpose();
    return C - static_cast<double>(count) * pair.take.mean(take_at, count) *
                   pair.motion.mean(motion_at, count).transpose();
  }

  std::vector<std::vector<Pair>> sensors_;
};

// How the motion's samples and the take's overlap when the motion begins at the take's sample
// `lag`.
struct Overlap {
  Eigen::Index motion_at, take_at, count;

  Overlap(Eigen::Index lag, std::size_t num_motion, std::size_t num_take)
      : motion_at(std::max<Eigen::Index>(0, -lag)),
        take_at(std::max<Eigen::Index>(0, lag)),
        count(std::min(static_cast<Eigen::Index>(num_motion) - motion_at,
                       static_cast<Eigen::Index>(num_take) - take_at)) {}
};

struct Peak {
  double lag = 0.0;  // samples
  double correlation = -1.0, runner_up = -1.0;
};

// The highest of the values, refined by a parabola, and the highest beyond the valleys beside it.
Peak peak_of(const std::vector<double>& values, Eigen::Index first_lag) {
  const auto best = std::max_element(values.begin(), values.end());
  auto low = best, high = best;
  while (low != values.begin() && *(low - 1) < *low) --low;
  while (high + 1 != values.end() && *(high + 1) < *high) ++high;
  Peak peak{static_cast<double>(first_lag + (best - values.begin())), *best};
  if (best != values.begin() && best + 1 != values.end()) {
    const double bend = *(best - 1) - 2.0 * *best + *(best + 1);
    if (bend < 0.0) peak.lag += 0.5 * (*(best - 1) - *(best + 1)) / bend;
  }
  if (low != values.begin())
    peak.runner_up = std::max(peak.runner_up, *std::max_element(values.begin(), low));
  if (high + 1 < values.end())
    peak.runner_up = std::max(peak.runner_up, *std::max_element(high + 1, values.end()));
  return peak;
}

struct Span {
  double begin_s, end_s;
  double duration_s() const { return end_s - begin_s; }
};

// While all sensors recorded.
Span common_span(const std::vector<ComparedSensor>& sensors) {
  Span span{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (const auto& sensor : sensors)
    for (const auto& pair : sensor.pairs) {
      span.begin_s = std::max(span.begin_s, pair.take.times_s.front());
      span.end_s = std::min(span.end_s, pair.take.times_s.back());
    }
  return span;
}

// When the motion begins on the take's clock, by comparing all that the span has with all of the
// motion: roughly at every time, then finely around the best.
Peak find(const std::vector<ComparedSensor>& sensors, double duration_s, const Span& span,
          const Progress& progress) {
  const auto motion_s = grid(0.0, duration_s, kCoarse_hz);
  const auto take_s = grid(span.begin_s, span.end_s, kCoarse_hz);
  const Comparison coarse(sensors, motion_s, take_s);
  const auto least = static_cast<Eigen::Index>(
      std::ceil(kLeastOverlap * static_cast<double>(std::min(motion_s.size(), take_s.size()))));
  const Eigen::Index first = least - static_cast<Eigen::Index>(motion_s.size());
  const Eigen::Index last = static_cast<Eigen::Index>(take_s.size()) - least;
  std::vector<double> values;
  for (Eigen::Index lag = first; lag <= last; ++lag) {
    if (lag % 64 == 0)
      progress.report(static_cast<std::size_t>(lag - first),
                      static_cast<std::size_t>(last - first + 1), "comparing");
    const Overlap o(lag, motion_s.size(), take_s.size());
    values.push_back(coarse.correlation(o.motion_at, o.take_at, o.count));
  }
  Peak peak = peak_of(values, first);
  const double about_s = span.begin_s + peak.lag / kCoarse_hz;

  const auto fine_motion_s = grid(0.0, duration_s, kFine_hz);
  const auto fine_take_s = grid(span.begin_s, span.end_s, kFine_hz);
  const Comparison fine(sensors, fine_motion_s, fine_take_s);
  const auto middle = static_cast<Eigen::Index>(std::lround((about_s - span.begin_s) * kFine_hz));
  const auto reach = static_cast<Eigen::Index>(std::lround(kFineReach_s * kFine_hz));
  values.clear();
  for (Eigen::Index lag = middle - reach; lag <= middle + reach; ++lag) {
    const Overlap o(lag, fine_motion_s.size(), fine_take_s.size());
    values.push_back(fine.correlation(o.motion_at, o.take_at, o.count));
  }
  peak.lag = span.begin_s + peak_of(values, middle - reach).lag / kFine_hz;
  return peak;
}

// How well everything agrees when the motion begins then.
void put_agreement(const std::vector<ComparedSensor>& sensors, double duration_s, const Span& span,
                   TakeAlignment& alignment) {
  const double from_s = std::max(0.0, span.begin_s - alignment.begin_s);
  const double to_s = std::min(duration_s, span.end_s - alignment.begin_s);
  alignment.coverage = std::clamp((to_s - from_s) / duration_s, 0.0, 1.0);
  if (to_s - from_s < kShortest_s) return;
  const auto motion_s = grid(from_s, to_s, kFine_hz);
  std::vector<double> take_s;
  for (const double time_s : motion_s) take_s.push_back(time_s + alignment.begin_s);
  alignment.correlation = Comparison(sensors, motion_s, take_s)
                              .correlation(0, 0, static_cast<Eigen::Index>(motion_s.size()),
                                           &alignment.sensor_correlations);
}

}  // namespace

TakeAlignment align_take(const Motion& standard_motion, std::span<const SensorRecording> take,
                         std::span<const SensorInput> sensors,
                         std::optional<std::pair<double, double>> event, const Progress& progress) {
  if (take.size() != sensors.size() || take.empty())
    throw std::invalid_argument("align_take: a recording for each sensor is needed");
  std::vector<Site> sites;
  for (const auto& sensor : sensors)
    sites.push_back(all_sites()[static_cast<std::size_t>(sensor.sensor.site)]);
  const auto modelled = virtual_readings(standard_motion, sites);
  std::vector<ComparedSensor> compared_sensors;
  for (std::size_t s = 0; s < take.size(); ++s)
    compared_sensors.push_back(compared(standard_motion, modelled[s], take[s], sensors[s]));
  const double duration_s = standard_motion.frame_time_s * (standard_motion.num_frames() - 1);
  const Span whole = common_span(compared_sensors);
  if (!std::isfinite(whole.duration_s()))
    throw ConfigError("the take has no accelerometer, gyroscope or orientation");
  Span searched = whole;
  if (event)
    searched = {std::max(whole.begin_s, event->first), std::min(whole.end_s, event->second)};
  if (searched.duration_s() < kShortest_s || duration_s < kShortest_s)
    throw ConfigError("the motion and the take must each last at least 0.8 s");
  const Peak peak = find(compared_sensors, duration_s, searched, progress);
  TakeAlignment alignment;
  alignment.begin_s = peak.lag;
  alignment.runner_up = peak.runner_up;
  put_agreement(compared_sensors, duration_s, whole, alignment);
  return alignment;
}

}  // namespace sparse_mocap
