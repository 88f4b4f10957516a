// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sparse_mocap/base/progress.hpp"
#include "sparse_mocap/motion/skeleton.hpp"
#include "sparse_mocap/readings/reading.hpp"
#include "sparse_mocap/reconstruction/pose_estimate.hpp"
#include "sparse_mocap/sensors/filter.hpp"

namespace sparse_mocap {

// A way from readings to full-body motion, made for one performance and used from one thread.
class Method {
 public:
  virtual ~Method() = default;

  virtual const Skeleton& skeleton() const = 0;  // of its poses
  virtual double rate_hz() const = 0;            // of the readings it takes and the poses it gives
  // What the readings it takes are low-passed by: as those of a database, unless it says otherwise.
  virtual GaussianFilter reading_filter() const { return kReadingFilter; }
  // What it found out about the performance that people should know, a line each.
  virtual std::vector<std::string> notes() const { return {}; }
};

// Answers readings as they come.
class LiveMethod : public Method {
 public:
  // Takes the next reading and gives the pose of latency_s() ago; nothing until there is one.
  // Throws ConfigError for readings of another number of sensors.
  virtual std::optional<PoseEstimate> step(const Reading& reading) = 0;
  // The same in the memory of an earlier estimate of this method; false, and estimate is whatever,
  // where there is no pose yet. Methods that retrieve need no further memory for a frame then.
  virtual bool step_into(const Reading& reading, PoseEstimate& estimate);
  // The poses of the last latency_s(), when the performance ends; the next step() starts anew.
  virtual std::vector<PoseEstimate> flush() = 0;
  virtual void reset() = 0;

  virtual double latency_s() const = 0;  // a whole number of readings
  virtual double history_s() const = 0;  // how far back the readings of a pose reach
};

// A part of a take, and how far two motions of it are apart there.
struct Difference {
  double begin_s = 0.0, end_s = 0.0;  // from the first reading on
  double distance_m = 0.0;            // of the joints, mean over the part; heading frame
};

// Another motion that fits the readings of a take almost as well.
struct Alternative {
  std::vector<PoseEstimate> estimates;  // one a reading
  std::vector<Difference> differences;  // from the motion that solve() gave, in order; not empty
};

// Answers when the whole performance is known; every pose may depend on all of it.
class WholeTakeMethod : public Method {
 public:
  // One pose a reading. Throws ConfigError and Cancelled.
  virtual std::vector<PoseEstimate> solve(const std::vector<Reading>& take,
                                          const Progress& progress) = 0;
  // What else the take of the last solve() may have been, the likeliest first; none unless the
  // method's options ask for it.
  virtual std::vector<Alternative> alternatives() const { return {}; }
};

// Throws ConfigError for a reading of another number of sensors.
void require_sensors(const Reading& reading, Eigen::Index num_sensors);

// A whole take by a live method, reading by reading. Throws Cancelled.
std::vector<PoseEstimate> solve_live(LiveMethod& method, const std::vector<Reading>& take,
                                     const Progress& progress);

}  // namespace sparse_mocap
