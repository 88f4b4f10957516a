// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "sparse_mocap/eom2014/config.hpp"
#include "sparse_mocap/eom2014/mapping.hpp"
#include "sparse_mocap/eom2014/mounting.hpp"
#include "sparse_mocap/reconstruction/method_info.hpp"

namespace sparse_mocap::eom2014 {

// A whole take of the one sensor.
class Reconstructor : public WholeTakeMethod {
 public:
  // Throws ConfigError for a sensor where the model was not trained for one, and FormatError.
  Reconstructor(const MethodSettings& settings, const MethodContext& context);

  const Skeleton& skeleton() const override { return skeleton_; }
  double rate_hz() const override { return config_.rate_hz; }

  // Throws ConfigError for a take that is too short or has too many gaps.
  std::vector<PoseEstimate> solve(const std::vector<Reading>& take,
                                  const Progress& progress) override;
  std::vector<std::string> notes() const override { return notes_; }

 private:
  SensorTurn turn_at(const SiteModel& site, const ReadingRows& readings) const;
  ReadingRows in_site_axes(const ReadingRows& readings);

  Config config_;
  TrainedModel model_;
  Skeleton skeleton_;
  double leg_scale_ = 1.0;  // legs of the skeleton as parts of the model's
  std::size_t site_ = 0;    // index in model_.sites
  std::vector<std::string> notes_;
};

}  // namespace sparse_mocap::eom2014
