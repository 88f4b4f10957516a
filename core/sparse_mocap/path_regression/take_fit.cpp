// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/take_fit.hpp"

#include <Eigen/SVD>
#include <utility>

#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/path_regression/fit_equations.hpp"

namespace sparse_mocap::path_regression {
namespace {

constexpr double kRelativeDecrease = 1e-7;  // below this share of the value, it has converged
constexpr double kFirstDamping = 1e-4, kMostDamping = 1e6;

std::vector<FittedFrame> stepped(const Skeleton& skeleton, std::vector<FittedFrame> frames,
                                 std::size_t first_free, const Eigen::MatrixXd& steps) {
  const Eigen::Index angles = skeleton.num_angles();
  for (std::size_t t = first_free; t < frames.size(); ++t) {
    const auto step = steps.col(static_cast<Eigen::Index>(t - first_free));
    FittedFrame& frame = frames[t];
    frame.rotations = turned(skeleton, std::move(frame.rotations), step.head(angles));
    frame.root_position += step.segment<3>(angles);
    frame.yaw_rad += step[angles + 3];
  }
  return frames;
}

Mat3 nearest_rotation(const Mat3& matrix) {
  const Eigen::JacobiSVD<Mat3> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0.0) U.col(2) = -U.col(2);
  return U * svd.matrixV().transpose();
}

// A pose that has its points about where they are asked for.
JointRotations rotations_near(const Skeleton& skeleton, const Eigen::VectorXd& points) {
  JointRotations R_world_joint, R_joint;
  const Eigen::Index ends = 3 * skeleton.num_joints();
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const Eigen::Matrix<double, 9, 1> tips = points.segment<9>(ends + 9 * j);
    R_world_joint.push_back(nearest_rotation(tips.reshaped(3, 3)));
    const int parent = skeleton.joint(j).parent;
    R_joint.push_back(parent < 0
                          ? R_world_joint.back()
                          : Mat3(R_world_joint[static_cast<std::size_t>(parent)].transpose() *
                                 R_world_joint.back()));
  }
  return reachable(skeleton, std::move(R_joint));
}

}  // namespace

double TakeFit::value(const std::vector<FittedFrame>& frames, std::span<const FrameTarget> targets,
                      std::size_t first_free) const {
  return FitEquations(skeleton_, frame_time_s_, weights_, frames, targets,
                      static_cast<int>(first_free), false, num_threads_)
      .value();
}

double TakeFit::fit(std::vector<FittedFrame>& frames, std::span<const FrameTarget> targets,
                    std::size_t first_free, int max_iterations) const {
  double damping = kFirstDamping;
  double reached = value(frames, targets, first_free);
  for (int iteration = 0; iteration < max_iterations && damping < kMostDamping; ++iteration) {
    FitEquations equations(skeleton_, frame_time_s_, weights_, frames, targets,
                           static_cast<int>(first_free), true, num_threads_);
    equations.system().damp(damping);
    Eigen::MatrixXd steps;
    if (!equations.system().solve(steps)) break;
    std::vector<FittedFrame> next = stepped(skeleton_, frames, first_free, steps);
    const double value_there = value(next, targets, first_free);
    if (!(value_there < reached)) {
      damping *= 30.0;
      continue;
    }
    const bool is_converged = reached - value_there <= kRelativeDecrease * reached;
    frames = std::move(next);
    reached = value_there;
    damping *= 0.1;
    if (is_converged) break;
  }
  return reached;
}

FittedFrame start_of(const Skeleton& skeleton, double frame_time_s, const FrameTarget& target,
                     const FittedFrame* before) {
  FittedFrame frame;
  frame.rotations = rotations_near(skeleton, target.points);
  if (before != nullptr) {
    const Vec3 velocity(target.root.velocity_mps.x(), 0.0, target.root.velocity_mps.y());
    frame.root_position =
        before->root_position + yaw_rotation(before->yaw_rad) * velocity * frame_time_s;
    frame.yaw_rad = before->yaw_rad + target.root.yaw_rate_radps * frame_time_s;
  }
  frame.root_position.y() = target.root.height_m;
  return frame;
}

PoseEstimate to_estimate(const FittedFrame& frame, double time_s, const Eigen::Vector2d& contacts,
                         Diagnostics diagnostics) {
  PoseEstimate estimate{time_s, {}, frame.root_position, contacts, std::move(diagnostics), {}};
  for (const Mat3& R : frame.rotations) estimate.rotations.emplace_back(R);
  estimate.rotations[0] = Quat(yaw_rotation(frame.yaw_rad)) * estimate.rotations[0];
  return estimate;
}

}  // namespace sparse_mocap::path_regression
