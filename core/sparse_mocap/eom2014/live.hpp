// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "sparse_mocap/eom2014/prepared_model.hpp"

namespace sparse_mocap::eom2014 {

// The same while the performer moves: each pose waits for lag_ms of further readings. How the
// sensor is worn is found in the first seconds in which it moves.
class LiveReconstructor : public LiveMethod {
 public:
  // Throws ConfigError for a sensor where the model was not trained for one, and FormatError.
  LiveReconstructor(const MethodSettings& settings, const MethodContext& context);

  const Skeleton& skeleton() const override { return model_.skeleton(); }
  double rate_hz() const override { return model_.config().rate_hz; }
  double latency_s() const override { return lag_frames_ / rate_hz(); }
  double history_s() const override;

  // Throws ConfigError also for accelerations without gravity, after a second.
  std::optional<PoseEstimate> step(const Reading& reading) override;
  std::vector<PoseEstimate> flush() override;
  void reset() override;
  std::vector<std::string> notes() const override { return notes_; }

 private:
  struct Kept {
    double time_s = 0.0;
    Eigen::Matrix<double, 1, 6> reading;  // as the sensor gives it
    double turning = 0.0;                 // as turning_rate()
  };

  void keep(const Reading& reading);
  void find_how_it_is_worn();
  ReadingRows kept_rows(std::size_t begin) const;
  PoseEstimate next_pose();
  void turn_as_measured(MappedFrames& frames, Eigen::Index frame, std::size_t first_kept);
  void place(const MappedFrames& frames, const Motion& motion, Eigen::Index frame,
             PoseEstimate& estimate);
  void forget_old();

  PreparedModel model_;
  int lag_frames_ = 0;
  std::deque<Kept> kept_;
  std::size_t next_ = 0;  // of what is kept, whose pose comes next
  int num_seen_ = 0;      // readings since the beginning
  int num_found_ = 0;     // times that how it is worn was found
  WornSensor worn_;
  std::deque<double> turning_errors_;  // measured against modelled, of the last poses (rad/s)
  Vec3 place_ = Vec3::Zero();
  double yaw_rad_ = 0.0;
  std::vector<std::string> notes_;
};

}  // namespace sparse_mocap::eom2014
