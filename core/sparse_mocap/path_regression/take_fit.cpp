// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/take_fit.hpp"

#include <Eigen/SVD>
#include <functional>
#include <utility>

#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/path_regression/fit_equations.hpp"

namespace sparse_mocap::path_regression {
namespace {

constexpr double kRelativeDecrease = 1e-7;  // below this share of the value, it has converged
constexpr double kFirstDamping = 1e-4, kMostDamping = 1e6;

void move(const Skeleton& skeleton, std::size_t first_free, const Eigen::MatrixXd& steps,
          std::vector<FittedFrame>& frames) {
  const Eigen::Index angles = skeleton.num_angles();
  for (std::size_t t = first_free; t < frames.size(); ++t) {
    const auto step = steps.col(static_cast<Eigen::Index>(t - first_free));
    FittedFrame& frame = frames[t];
    frame.rotations = turned(skeleton, std::move(frame.rotations), step.head(angles));
    frame.root_position += step.segment<3>(angles);
    frame.yaw_rad += step[angles + 3];
  }
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

TakeFit::TakeFit(const Skeleton& skeleton, double frame_time_s, const FitWeights& weights,
                 int num_threads)
    : skeleton_(skeleton),
      weights_(weights),
      equations_(std::make_unique<FitEquations>(skeleton, frame_time_s, weights_, num_threads)) {}
TakeFit::~TakeFit() = default;

double TakeFit::value(const std::vector<FittedFrame>& frames, std::span<const FrameTarget> targets,
                      std::size_t first_free) {
  return equations_->value(frames, targets, static_cast<int>(first_free));
}

double TakeFit::fit(std::vector<FittedFrame>& frames, std::span<const FrameTarget> targets,
                    std::size_t first_free, int max_iterations, const Progress& progress) {
  const std::size_t num_free = frames.size() - first_free;
  const auto num_iterations = static_cast<std::size_t>(max_iterations);
  double damping = kFirstDamping;
  double reached = value(frames, targets, first_free);
  for (int iteration = 0; iteration < max_iterations && damping < kMostDamping; ++iteration) {
    equations_->form(frames, targets, static_cast<int>(first_free), true);
    equations_->system().damp(damping);
    const std::size_t done = static_cast<std::size_t>(iteration) * num_free;
    const auto reached_frame = [&](int i) {
      progress.report(done + static_cast<std::size_t>(i), num_iterations * num_free, "fitting");
    };
    // By reference, since live frames must not allocate.
    if (!equations_->system().solve(steps_, std::cref(reached_frame))) break;
    next_ = frames;
    move(skeleton_, first_free, steps_, next_);
    const double value_there =
        equations_->value(next_, targets, static_cast<int>(first_free), true);
    if (!(value_there < reached)) {
      damping *= 30.0;
      continue;
    }
    const bool is_converged = reached - value_there <= kRelativeDecrease * reached;
    std::swap(frames, next_);
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
  if (before == nullptr) {
    frame.root_position.y() = target.root.height_m;
    return frame;
  }
  frame.root_position = before->root_position;
  frame.yaw_rad = before->yaw_rad;
  move_root(frame_time_s, target, frame);
  return frame;
}

void move_root(double frame_time_s, const FrameTarget& target, FittedFrame& frame) {
  const Vec3 velocity(target.root.velocity_mps.x(), 0.0, target.root.velocity_mps.y());
  frame.root_position += yaw_rotation(frame.yaw_rad) * velocity * frame_time_s;
  frame.root_position.y() = target.root.height_m;
  frame.yaw_rad += target.root.yaw_rate_radps * frame_time_s;
}

PoseEstimate to_estimate(const FittedFrame& frame, double time_s, const Eigen::Vector2d& contacts,
                         Diagnostics diagnostics) {
  PoseEstimate estimate;
  put_estimate(frame, time_s, contacts, estimate);
  estimate.diagnostics = std::move(diagnostics);
  return estimate;
}

void put_estimate(const FittedFrame& frame, double time_s, const Eigen::Vector2d& contacts,
                  PoseEstimate& estimate) {
  estimate.time_s = time_s;
  estimate.root_position = frame.root_position;
  estimate.contacts = contacts;
  estimate.rotations.clear();
  for (const Mat3& R : frame.rotations) estimate.rotations.emplace_back(R);
  estimate.rotations[0] = Quat(yaw_rotation(frame.yaw_rad)) * estimate.rotations[0];
}

}  // namespace sparse_mocap::path_regression
