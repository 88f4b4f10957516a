// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "sparse_mocap/eom2014/mapping.hpp"
#include "sparse_mocap/eom2014/mounting.hpp"
#include "sparse_mocap/reconstruction/method_info.hpp"

namespace sparse_mocap::eom2014 {

// What is said of a recording of another motion.
inline constexpr const char* kUnlikeNote =
    "the recording is unlike the clips that the model was trained on, so the motion is a guess";

// How a sensor is worn and what it tells, found from its readings.
struct WornSensor {
  Units units;
  SensorTurn turn;

  // The readings in SI units and in the axes of its site.
  ReadingRows corrected(const ReadingRows& readings) const {
    return turn.corrected(units.converted(readings));
  }
  // The same of its turning about the vertical, as turning_rate() tells it.
  double corrected_turning(double rate) const;
};

// A model with what does not change during a performance; whole takes and live use the same.
class PreparedModel {
 public:
  // Throws ConfigError for a sensor where the model was not trained for one, and FormatError.
  PreparedModel(const MethodSettings& settings, const MethodContext& context);

  const Config& config() const { return config_; }
  const Skeleton& skeleton() const { return skeleton_; }
  const KnownReadings& known() const { return known_[site_]; }

  // From readings as the sensor gives them; what people should know is added to the notes. Throws
  // ConfigError for accelerations without gravity.
  WornSensor worn(const ReadingRows& readings, int most_compared,
                  std::vector<std::string>& notes) const;
  // Whether a sensor moves as much as in the clips.
  bool is_moving(const ReadingRows& readings) const;

  // Whether a movement is like the clips: its path goes through their frames as they follow each
  // other, wherever the sensor moves. readings and frames are of the whole take.
  bool follows_clips(const ReadingRows& readings, const MappedFrames& frames) const;

  // Poses from corrected readings, for the frames of a range; frames of the mapping alone.
  MappedFrames mapped(const ReadingRows& readings, const FrameRange& range) const;
  // Their motion, from the origin, smoothed and with feet that stay where they stand.
  Motion motion_of(const MappedFrames& frames) const;
  // What is told of one of them, but for contacts.
  PoseEstimate estimate(const MappedFrames& frames, const Motion& motion, Eigen::Index frame) const;
  // How far the specific force of each reading of a range is from that of the nearest training
  // frame (m/s^2).
  Eigen::VectorXd force_misfits(const ReadingRows& readings, const FrameRange& range) const;

 private:
  SensorTurn turn_at(std::size_t site, const ReadingRows& readings, int most_compared) const;
  void compare_sites(const ReadingRows& readings, const SensorTurn& turn, int most_compared,
                     std::vector<std::string>& notes) const;

  Config config_;
  TrainedModel model_;
  Skeleton skeleton_;
  double leg_scale_ = 1.0;            // legs of the skeleton as parts of the model's
  std::size_t site_ = 0;              // index in the model's sites
  std::vector<KnownReadings> known_;  // of each of the model's sites
};

}  // namespace sparse_mocap::eom2014
