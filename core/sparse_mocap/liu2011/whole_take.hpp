// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "sparse_mocap/liu2011/config.hpp"
#include "sparse_mocap/liu2011/reconstructor.hpp"

namespace sparse_mocap::liu2011 {

// The poses of a take, all at once: sensors as near to where they are measured as in the method's
// control term, poses near the means, which are given, and movement even from frame to frame:
//   E = sum_t E_control(q_t) + |q_t - mean_t|^2 / (2 agreement^2)
//     + sum_t |q_(t-1) - 2 q_t + q_(t+1)|^2 / (2 evenness^2)
// Frame by frame several times over, each by Levenberg-Marquardt. observed: in the world, a frame.
void refine(const Skeleton& body, const std::vector<std::vector<Observation>>& observed,
            const Config& config, std::vector<BodyPose>& poses);

// The pose in the middle of two.
BodyPose middle(const Skeleton& body, const BodyPose& a, const BodyPose& b);

// Best quality: the method forward and backward through the take, since what comes after a frame
// tells as much of it as what came before, and then the take as a whole.
class WholeTakeReconstructor : public WholeTakeMethod {
 public:
  // Throws ConfigError.
  WholeTakeReconstructor(const Config& config, const MethodContext& context);

  const Skeleton& skeleton() const override { return forward_.skeleton(); }
  double rate_hz() const override { return forward_.rate_hz(); }
  GaussianFilter reading_filter() const override { return forward_.reading_filter(); }

  std::vector<PoseEstimate> solve(const std::vector<Reading>& take,
                                  const Progress& progress) override;

 private:
  Config config_;
  std::vector<WornSensor> worn_;
  Reconstructor forward_, backward_;
  int num_threads_;
};

}  // namespace sparse_mocap::liu2011
