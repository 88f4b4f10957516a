// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "sparse_mocap/path_regression/banded_system.hpp"
#include "sparse_mocap/path_regression/take_fit.hpp"
#include "sparse_mocap/reconstruction/human_limits.hpp"

namespace sparse_mocap::path_regression {

// The terms of a fit at given frames: their sum, and the Gauss-Newton equations of a step from
// there. The unknowns of a frame are a step of its pose, of its root's position and of its heading.
class FitEquations {
 public:
  FitEquations(const Skeleton& skeleton, double frame_time_s, const FitWeights& weights,
               std::span<const FittedFrame> frames, std::span<const FrameTarget> targets,
               int first_free, bool with_system, int num_threads = 1);

  double value() const { return value_; }
  BandedSystem& system() { return *system_; }

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
    Eigen::VectorXd residual;
  };
  struct Hinge {
    int joint;
    HingeRange range;
  };
  struct Share {  // of a frame in a small residual
    int frame;
    Eigen::MatrixXd jacobian;
  };

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
  void add_small(double weight, const Eigen::VectorXd& residual, std::vector<Share> shares);
  Eigen::VectorXd pulled(const Seen& seen, const Eigen::VectorXd& residual) const;
  Vec3 foot(int t, int ankle) const;
  Share foot_share(int t, int ankle, double factor) const;
  bool is_free(int t) const { return t >= first_free_; }
  Eigen::MatrixXd no_share(Eigen::Index rows) const;

  const Skeleton& skeleton_;
  double frame_time_s_;
  const FitWeights& weights_;
  std::span<const FittedFrame> frames_;
  std::span<const FrameTarget> targets_;
  int first_free_, num_angles_;
  std::vector<Hinge> hinges_;
  std::vector<Seen> seen_;
  double value_ = 0.0;
  std::optional<BandedSystem> system_;
};

}  // namespace sparse_mocap::path_regression
