// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sparse_mocap/readings/reading_stream.hpp"
#include "sparse_mocap/reconstruction/extremity_track.hpp"
#include "sparse_mocap/reconstruction/method_info.hpp"

namespace sparse_mocap {

enum class Quality {
  live,  // each pose from the readings up to then, and the few that the method waits for
  best,  // each pose from the whole take
};

// How a performance is to be reconstructed.
struct ReconstructionRequest {
  std::string method;  // empty: the default
  MethodSettings settings;
  std::shared_ptr<const MotionDatabase> database;
  std::shared_ptr<const Model> model;
  std::optional<Skeleton> body;
  std::vector<int> excluded_clips;
  TrackerWorld tracker_world;
};

// What became of a take.
struct Reconstruction {
  Skeleton skeleton;  // the method's, with feet, toes and hands if it is a standard skeleton
  double rate_hz = 0.0;
  std::optional<double> latency_s;  // of a pose after its reading, low-pass included; none: best
  std::vector<Sensor> sensors;      // with the channels that were used
  std::vector<Reading> readings;
  std::vector<PoseEstimate> estimates;  // one a reading
  std::vector<std::string> notes;       // what the method says of the take, a line each
  // Best quality, where the method's options ask for it: what else the take may have been, the
  // likeliest first, each a whole reconstruction.
  std::vector<Reconstruction> alternatives;
  std::vector<Difference> differences;  // of an alternative, from the reconstruction that has it

  Motion motion() const { return to_motion(estimates, skeleton, rate_hz); }
};

// The sensors with those of their channels that the method uses. Throws ConfigError for an unknown
// method.
std::vector<SensorInput> used_channels(std::vector<SensorInput> sensors, const MethodInfo& method);

// From what the sensors of a whole performance recorded to motion. sensors say where each is worn,
// what it gives and how it is calibrated. Throws ConfigError and Cancelled.
Reconstruction reconstruct(std::span<const SensorRecording> take, std::vector<SensorInput> sensors,
                           const ReconstructionRequest& request, Quality quality,
                           const Progress& progress);

// The same while the performance goes on. Use it from one thread.
class LiveReconstructor {
 public:
  // largest_backlog: more readings than this that wait are given up but for the newest, and the
  // method begins anew, so that a slow machine stays in time; 0: none is. Throws ConfigError.
  LiveReconstructor(std::vector<SensorInput> sensors, const ReconstructionRequest& request,
                    int largest_backlog = 0);

  // Takes the sensors' samples.
  ReadingStream& readings() { return readings_; }
  // The poses that can be had by now, on the clock of the samples.
  std::vector<PoseEstimate> advance(double now_s);
  // The remaining ones, when the performance ends.
  std::vector<PoseEstimate> flush();

  const Skeleton& skeleton() const { return extremities_.skeleton(); }
  double rate_hz() const { return method_->rate_hz(); }
  double latency_s() const { return method_->latency_s() + readings_.delay_s(); }
  double history_s() const { return method_->history_s(); }
  std::vector<std::string> notes() const { return method_->notes(); }
  int num_skipped() const { return num_skipped_; }  // readings that were given up
  // When the last reading was that any sensor was in; minus infinity before there is one.
  double last_reading_s() const { return last_reading_s_; }

 private:
  std::vector<PoseEstimate> solve(const std::vector<Reading>& readings);

  std::unique_ptr<LiveMethod> method_;
  ReadingStream readings_;
  ExtremityTrack extremities_;
  std::size_t largest_backlog_;
  int num_skipped_ = 0;
  double last_reading_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace sparse_mocap
