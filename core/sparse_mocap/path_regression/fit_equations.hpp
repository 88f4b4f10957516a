// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "sparse_mocap/path_regression/banded_system.hpp"
#include "sparse_mocap/path_regression/take_fit.hpp"
#include "sparse_mocap/reconstruction/human_limits.hpp"

namespace sparse_mocap::path_regression {

// The terms of a fit at given frames: their sum, and the Gauss-Newton equations of a step from
// there. The unknowns of a frame are a step of its pose, of its root's position and of its heading.
// Frames of the same number are worked on in the same memory.
class FitEquations {
 public:
  // The skeleton must outlive it; it has at most kMostUnknowns - 4 angles.
  FitEquations(const Skeleton& skeleton, double frame_time_s, const FitWeights& weights,
               int num_threads = 1);

  // The sum of all terms that depend on frames [first_free, end), without or with the equations.
  // is_begun: frames before first_free are those of the last call.
  double value(std::span<const FittedFrame> frames, std::span<const FrameTarget> targets,
               int first_free, bool is_begun = false);
  double form(std::span<const FittedFrame> frames, std::span<const FrameTarget> targets,
              int first_free, bool is_begun = false);
  BandedSystem& system() { return system_; }

  static constexpr int kMostUnknowns = 64;

 private:
  // A frame's points, and how they move under a step: d ends, and d turns times the square root of
  // 2 lever_m, so that products of two frames' rows are those of their points.
  struct Seen {
    JointTransforms pose;  // heading frame, root at the origin
    Eigen::VectorXd points;
    Eigen::MatrixXd jacobian;
    // What the terms of points add up to: the factor of jacobian^T times the jacobian of so many
    // frames before, and the residuals that jacobian^T is to be multiplied with.
    std::array<double, BandedSystem::kReach + 1> products{};
    Eigen::VectorXd residual, pull;
  };
  struct Hinge {
    int joint;
    HingeRange range;
  };
  // A few residuals, and how they depend on a frame's unknowns.
  using SmallResidual = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 4, 1>;
  using SmallJacobian =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 4, kMostUnknowns>;
  struct Share {
    int frame;
    SmallJacobian jacobian;
  };

  void evaluate(std::span<const FittedFrame> frames, std::span<const FrameTarget> targets,
                int first_free, bool is_begun);
  void see(int t);
  void add_frame(int t);
  void add_pose_terms(int t);
  double evenness(int t) const;
  void add_inclination(int t);
  void add_hinges(int t);
  void add_root_terms(int t);
  double root_turn_weight(int t) const;
  void add_foot(int t, std::size_t side);
  void add_turning(int t);
  void add_points(double weight, int t, std::span<const double> factors,
                  const Eigen::VectorXd* target);
  void add_points_to_system(int t);
  void add_small(double weight, const SmallResidual& residual, std::span<const Share> shares);
  void pull(Seen& seen) const;
  Vec3 foot(int t, int ankle) const;
  Share foot_share(int t, int ankle, double factor) const;
  Share root_share(int t, double factor) const;
  Share turning_share(int t, int joint, const Eigen::RowVector3d& slope, double factor) const;
  Eigen::Vector4d root(int t) const;
  bool is_free(int t) const { return t >= first_free_; }
  SmallJacobian no_share(Eigen::Index rows) const;

  const Skeleton& skeleton_;
  double frame_time_s_;
  const FitWeights& weights_;
  int num_angles_, num_threads_;
  std::span<const FittedFrame> frames_;
  std::span<const FrameTarget> targets_;
  int first_free_ = 0;
  bool with_system_ = false;
  std::vector<Hinge> hinges_;
  std::vector<Seen> seen_;
  double value_ = 0.0;
  Eigen::VectorXd residual_;  // of points
  BandedSystem system_{0, 0};
};

}  // namespace sparse_mocap::path_regression
