// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "sparse_mocap/base/progress.hpp"
#include "sparse_mocap/motion/joint_rotations.hpp"
#include "sparse_mocap/path_regression/frame_target.hpp"
#include "sparse_mocap/reconstruction/pose_estimate.hpp"

namespace sparse_mocap::path_regression {

// A frame that is being fitted: the pose without heading, and where it stands in the world.
struct FittedFrame {
  JointRotations rotations;
  Vec3 root_position = Vec3::Zero();  // m
  double yaw_rad = 0.0;
};

// What the terms of a fit count. Residuals are in metres, or in radians, squared and summed.
struct FitWeights {
  double lever_m = 0.1;       // of the axes' tips, see pose_points
  double pose = 1.0;          // points where the retrieved poses have them
  double step = 0.0;          // points move on as in the retrieved motions
  double smoothness = 0.0;    // second differences of the points, where retrieved poses differ
  double calm_mps = 0.5;      // of joints that move so fast they count half
  double inclination = 6.0;   // limbs inclined as measured
  double contact = 40.0;      // feet that stand move on no more than retrieved ones that stand
  double stands_from = 0.4;   // a foot whose certainty is less does not stand,
  double stands_at = 0.8;     // one whose certainty is more does; in between gradually
  double foot_height = 30.0;  // feet that stand are as high as retrieved ones, others not lower
  double turning = 100.0;     // joints turn about the vertical as gyroscopes say
  double root_step = 30.0;    // the root moves as in the retrieved motions
  double root_turn = 30.0;    // and turns as in them
  double root_height = 5.0;
  double root_smoothness = 2.0;  // second differences of the root's position and heading
  double hinge = 5.0;            // knees and elbows bend within their range
};

class FitEquations;

// Fits the frames of a take, or its last ones, all at once: the pose of each frame to what was
// retrieved and measured for it, and neighbouring frames to each other. Levenberg-Marquardt; each
// step is the solution of one banded system.
class TakeFit {
 public:
  // The skeleton must outlive the fit. The result does not depend on the number of threads (0: one
  // a processor).
  TakeFit(const Skeleton& skeleton, double frame_time_s, const FitWeights& weights,
          int num_threads = 1);
  TakeFit(const TakeFit&) = delete;
  TakeFit& operator=(const TakeFit&) = delete;
  ~TakeFit();

  // Fits frames [first_free, end) from where they are; those before stay. One target a frame.
  // Gives the value that is reached, never more than at the start. Throws Cancelled; the frames are
  // then where the last step left them.
  double fit(std::vector<FittedFrame>& frames, std::span<const FrameTarget> targets,
             std::size_t first_free, int max_iterations, const Progress& progress = {});
  // The sum of all terms that depend on frames [first_free, end).
  double value(const std::vector<FittedFrame>& frames, std::span<const FrameTarget> targets,
               std::size_t first_free);

 private:
  const Skeleton& skeleton_;
  FitWeights weights_;
  std::unique_ptr<FitEquations> equations_;
  Eigen::MatrixXd steps_;
  std::vector<FittedFrame> next_;
};

// Where a fit of a frame can start: a pose that has its points about where the target asks for
// them, the root moved on from the frame before (null: at the origin, facing forward).
FittedFrame start_of(const Skeleton& skeleton, double frame_time_s, const FrameTarget& target,
                     const FittedFrame* before);
// Moves the root of a frame, which is where it was one frame before.
void move_root(double frame_time_s, const FrameTarget& target, FittedFrame& frame);

// The pose in the world.
PoseEstimate to_estimate(const FittedFrame& frame, double time_s, const Eigen::Vector2d& contacts,
                         Diagnostics diagnostics);
// The same, all but the diagnostics.
void put_estimate(const FittedFrame& frame, double time_s, const Eigen::Vector2d& contacts,
                  PoseEstimate& estimate);

}  // namespace sparse_mocap::path_regression
