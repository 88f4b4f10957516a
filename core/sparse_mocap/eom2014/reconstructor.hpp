// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "sparse_mocap/eom2014/prepared_model.hpp"

namespace sparse_mocap::eom2014 {

// A whole take of the one sensor.
class Reconstructor : public WholeTakeMethod {
 public:
  // Throws ConfigError for a sensor where the model was not trained for one, and FormatError.
  Reconstructor(const MethodSettings& settings, const MethodContext& context)
      : model_(settings, context) {}

  const Skeleton& skeleton() const override { return model_.skeleton(); }
  double rate_hz() const override { return model_.config().rate_hz; }

  // Throws ConfigError for a take that is too short or has too many gaps.
  std::vector<PoseEstimate> solve(const std::vector<Reading>& take,
                                  const Progress& progress) override;
  std::vector<std::string> notes() const override { return notes_; }

 private:
  PreparedModel model_;
  std::vector<std::string> notes_;
};

}  // namespace sparse_mocap::eom2014
