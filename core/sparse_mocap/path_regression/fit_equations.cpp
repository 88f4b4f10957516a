// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/fit_equations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "sparse_mocap/base/ordered_work.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap::path_regression {
namespace {

constexpr std::array<double, 1> kHere{1.0};
constexpr std::array<double, 2> kFirstDifference{1.0, -1.0};
constexpr std::array<double, 3> kSecondDifference{1.0, -2.0, 1.0};
constexpr Eigen::Index kRootUnknowns = 4;  // position, heading

// 0 up to one value, 1 from another on, smooth in between.
double smooth_step(double x, double from, double to) {
  const double s = std::clamp((x - from) / std::max(to - from, 1e-9), 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

Vec3 rotation_vector(const Mat3& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

// d rotation_vector(exp(w) R) / d w at w = 0; its transpose is that of rotation_vector(R exp(w)).
Mat3 rotation_vector_slopes(const Vec3& v) {
  Mat3 cross;
  cross << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  const double angle = v.norm();
  const double square = angle < 1e-4 ? 1.0 / 12.0
                                     : 1.0 / (angle * angle) - (1.0 + std::cos(angle)) /
                                                                   (2.0 * angle * std::sin(angle));
  return Mat3::Identity() - 0.5 * cross + square * cross * cross;
}

}  // namespace

FitEquations::FitEquations(const Skeleton& skeleton, double frame_time_s, const FitWeights& weights,
                           int num_threads)
    : skeleton_(skeleton),
      frame_time_s_(frame_time_s),
      weights_(weights),
      num_angles_(skeleton.num_angles()),
      num_threads_(num_threads) {
  if (num_angles_ + kRootUnknowns > kMostUnknowns)
    throw std::invalid_argument("FitEquations: the skeleton has too many angles");
  for (int j = 0; j < skeleton.num_joints(); ++j)
    if (const auto range = hinge_range(skeleton.joint(j).name)) hinges_.push_back({j, *range});
}

double FitEquations::value(std::span<const FittedFrame> frames,
                           std::span<const FrameTarget> targets, int first_free, bool is_begun) {
  with_system_ = false;
  evaluate(frames, targets, first_free, is_begun);
  return value_;
}

double FitEquations::form(std::span<const FittedFrame> frames, std::span<const FrameTarget> targets,
                          int first_free, bool is_begun) {
  with_system_ = true;
  system_.clear(static_cast<int>(frames.size()) - first_free,
                num_angles_ + static_cast<int>(kRootUnknowns));
  evaluate(frames, targets, first_free, is_begun);
  return value_;
}

void FitEquations::evaluate(std::span<const FittedFrame> frames,
                            std::span<const FrameTarget> targets, int first_free, bool is_begun) {
  frames_ = frames;
  targets_ = targets;
  first_free_ = first_free;
  value_ = 0.0;
  seen_.resize(frames.size());
  const int n = static_cast<int>(frames.size());
  const auto each_frame = [&](int begin, void (FitEquations::*work)(int)) {
    constexpr std::size_t kPiece = 64;
    const auto one = [this, begin, work](std::size_t i) {
      (this->*work)(begin + static_cast<int>(i));
    };
    in_pieces(static_cast<std::size_t>(n - begin), kPiece, num_threads_, std::ref(one));
  };
  each_frame(is_begun ? first_free : std::max(0, first_free - BandedSystem::kReach),
             &FitEquations::see);
  for (int t = first_free; t < n; ++t) add_frame(t);
  if (with_system_) each_frame(first_free, &FitEquations::add_points_to_system);
}

void FitEquations::see(int t) {
  Seen& seen = seen_[static_cast<std::size_t>(t)];
  const auto& rotations = frames_[static_cast<std::size_t>(t)].rotations;
  forward_kinematics(skeleton_, Vec3::Zero(), rotations, seen.pose);
  put_pose_points(seen.pose, weights_.lever_m, seen.points);
  if (!with_system_ || !is_free(t)) return;
  seen.residual.setZero(seen.points.size());
  seen.products.fill(0.0);
  const Eigen::Index rows = 3 * skeleton_.num_joints();
  seen.jacobian.resize(2 * rows, num_angles_);
  put_step_jacobians(skeleton_, rotations, seen.pose, seen.jacobian.topRows(rows),
                     seen.jacobian.bottomRows(rows));
  seen.jacobian.bottomRows(rows) *= std::sqrt(2.0) * weights_.lever_m;
}

void FitEquations::add_frame(int t) {
  add_pose_terms(t);
  add_inclination(t);
  add_hinges(t);
  add_root_terms(t);
  for (const std::size_t side : {0U, 1U}) add_foot(t, side);
  add_turning(t);
}

void FitEquations::add_pose_terms(int t) {
  const FrameTarget& target = targets_[static_cast<std::size_t>(t)];
  add_points(weights_.pose * target.agreement, t, kHere, &target.points);
  if (t >= 1 && target.step.size() > 0)
    add_points(weights_.step, t, kFirstDifference, &target.step);
  if (t >= 2) add_points(weights_.smoothness * evenness(t), t, kSecondDifference, nullptr);
}

// How much even movement counts: fast movements are uneven, and retrieved poses that agree need no
// help.
double FitEquations::evenness(int t) const {
  const FrameTarget& target = targets_[static_cast<std::size_t>(t)];
  const double doubt = 1.0 - target.agreement;
  const Eigen::VectorXd& step = target.step;
  if (step.size() == 0) return doubt;
  const Eigen::Index ends = 3 * skeleton_.num_joints();
  const double speed_mps =
      std::sqrt(step.head(ends).squaredNorm() / skeleton_.num_joints()) / frame_time_s_;
  const double share = speed_mps / weights_.calm_mps;
  return doubt / (1.0 + share * share);
}

// weight * |sum_k factors_k points(t - k) - target|^2.
void FitEquations::add_points(double weight, int t, std::span<const double> factors,
                              const Eigen::VectorXd* target) {
  if (weight <= 0.0) return;
  const auto seen = [&](std::size_t k) -> Seen& { return seen_[static_cast<std::size_t>(t) - k]; };
  residual_ = factors[0] * seen(0).points;
  for (std::size_t k = 1; k < factors.size(); ++k) residual_ += factors[k] * seen(k).points;
  if (target != nullptr) residual_ -= *target;
  value_ += weight * residual_.squaredNorm();
  if (!with_system_) return;
  for (std::size_t k = 0; k < factors.size() && is_free(t - static_cast<int>(k)); ++k) {
    seen(k).residual += weight * factors[k] * residual_;
    for (std::size_t l = k; l < factors.size() && is_free(t - static_cast<int>(l)); ++l)
      seen(k).products[l - k] += weight * factors[k] * factors[l];
  }
}

// All terms of points at once: products of jacobians are what a fit costs most.
void FitEquations::add_points_to_system(int t) {
  Seen& seen = seen_[static_cast<std::size_t>(t)];
  const int row = t - first_free_;
  pull(seen);
  system_.right(row).head(num_angles_).noalias() -= seen.jacobian.transpose() * seen.pull;
  const auto corner = [&](int column) {
    return system_.block(row, column).topLeftCorner(num_angles_, num_angles_);
  };
  corner(row).selfadjointView<Eigen::Lower>().rankUpdate(seen.jacobian.transpose(),
                                                         seen.products[0]);
  for (int back = 1; back <= std::min(BandedSystem::kReach, row); ++back) {
    const double factor = seen.products[static_cast<std::size_t>(back)];
    if (factor == 0.0) continue;
    corner(row - back).noalias() +=
        factor * seen.jacobian.transpose() * seen_[static_cast<std::size_t>(t - back)].jacobian;
  }
}

// What the jacobian's transpose is multiplied with to be d points^T residual. Of the tips only the
// part that turns their joint counts: for each axis a of a joint and its tip's residual r the
// moment a x r.
void FitEquations::pull(Seen& seen) const {
  const Eigen::Index ends = 3 * skeleton_.num_joints();
  seen.pull.resize(2 * ends);
  seen.pull.head(ends) = seen.residual.head(ends);
  for (Eigen::Index j = 0; j < skeleton_.num_joints(); ++j) {
    Vec3 moment = Vec3::Zero();
    const Mat3& R = seen.pose.R_world_joint[static_cast<std::size_t>(j)];
    for (Eigen::Index a = 0; a < 3; ++a)
      moment += R.col(a).cross(Vec3(seen.residual.segment<3>(ends + 9 * j + 3 * a)));
    seen.pull.segment<3>(ends + 3 * j) = moment / std::sqrt(2.0);
  }
}

void FitEquations::add_inclination(int t) {
  const InclinationTarget& target = targets_[static_cast<std::size_t>(t)].inclination;
  const Seen& seen = seen_[static_cast<std::size_t>(t)];
  for (std::size_t k = 0; k < target.joints.size(); ++k) {
    const int joint = target.joints[k];
    const int parent = skeleton_.joint(joint).parent;
    const auto at = [&](int j) -> const Vec3& {
      return seen.pose.end[static_cast<std::size_t>(j)];
    };
    const double rise = kUp.dot(at(joint) - at(parent));
    Share share{t, no_share(1)};
    if (with_system_)
      for (Eigen::Index axis = 0; axis < 3; ++axis)
        share.jacobian.leftCols(num_angles_) += kUp[axis] * (seen.jacobian.row(3 * joint + axis) -
                                                             seen.jacobian.row(3 * parent + axis));
    add_small(weights_.inclination, SmallResidual::Constant(1, rise - target.rises_m[k]),
              {&share, 1});
  }
}

// Knees and elbows that bend farther than people's are drawn back; the last degrees are for what
// recordings have.
void FitEquations::add_hinges(int t) {
  constexpr double kMargin_rad = 10.0 * kRadiansPerDegree;
  for (const auto& [joint, range] : hinges_) {
    const Mat3& R = frames_[static_cast<std::size_t>(t)].rotations[static_cast<std::size_t>(joint)];
    const double middle = 0.5 * (range.least_rad + range.most_rad);
    double angle = 0.0;
    joint_angles(skeleton_.joint(joint), R, &middle, &angle);
    const double beyond =
        angle - std::clamp(angle, range.least_rad + kMargin_rad, range.most_rad - kMargin_rad);
    if (beyond == 0.0) continue;
    Share share{t, no_share(1)};
    share.jacobian(0, skeleton_.angle_begin(joint)) = 1.0;
    add_small(weights_.hinge, SmallResidual::Constant(1, beyond), {&share, 1});
  }
}

// Position and heading of the root: as the retrieved motions have them, and smooth.
void FitEquations::add_root_terms(int t) {
  const retrieval::RootRates& rates = targets_[static_cast<std::size_t>(t)].root;
  Share height{t, no_share(1)};
  height.jacobian(0, num_angles_ + 1) = 1.0;
  add_small(weights_.root_height, SmallResidual::Constant(1, root(t)[1] - rates.height_m),
            {&height, 1});
  if (t < 1) return;
  const Mat3 R_world_heading = yaw_rotation(frames_[static_cast<std::size_t>(t - 1)].yaw_rad);
  const Vec3 step =
      R_world_heading * Vec3(rates.velocity_mps.x(), 0.0, rates.velocity_mps.y()) * frame_time_s_;
  const Eigen::Vector4d wanted(step.x(), 0.0, step.z(), rates.yaw_rate_radps * frame_time_s_);
  const Eigen::Vector4d scale(std::sqrt(weights_.root_step), 0.0, std::sqrt(weights_.root_step),
                              std::sqrt(root_turn_weight(t)));
  std::array<Share, 2> moves{root_share(t, 1.0), root_share(t - 1, -1.0)};
  moves[1].jacobian.col(num_angles_ + 3).head<3>() -= kUp.cross(step);
  for (Share& share : moves)
    for (Eigen::Index row = 0; row < kRootUnknowns; ++row) share.jacobian.row(row) *= scale[row];
  add_small(1.0, scale.cwiseProduct(root(t) - root(t - 1) - wanted), moves);
  if (t < 2) return;
  const std::array<Share, 3> bends{root_share(t, 1.0), root_share(t - 1, -2.0),
                                   root_share(t - 2, 1.0)};
  add_small(weights_.root_smoothness, root(t) - 2.0 * root(t - 1) + root(t - 2), bends);
}

// Position and heading.
Eigen::Vector4d FitEquations::root(int t) const {
  const FittedFrame& frame = frames_[static_cast<std::size_t>(t)];
  return {frame.root_position.x(), frame.root_position.y(), frame.root_position.z(), frame.yaw_rad};
}

FitEquations::Share FitEquations::root_share(int t, double factor) const {
  Share share{t, no_share(kRootUnknowns)};
  share.jacobian.rightCols(kRootUnknowns).diagonal().setConstant(factor);
  return share;
}

// Where gyroscopes say how the body turns, retrieved motions have little to say.
double FitEquations::root_turn_weight(int t) const {
  constexpr double kBesideGyroscopes = 0.07;
  const bool is_measured = !targets_[static_cast<std::size_t>(t)].turning.empty();
  return is_measured && weights_.turning > 0.0 ? kBesideGyroscopes * weights_.root_turn
                                               : weights_.root_turn;
}

// Where an ankle is in the world.
Vec3 FitEquations::foot(int t, int ankle) const {
  const FittedFrame& frame = frames_[static_cast<std::size_t>(t)];
  return frame.root_position +
         yaw_rotation(frame.yaw_rad) *
             seen_[static_cast<std::size_t>(t)].pose.end[static_cast<std::size_t>(ankle)];
}

FitEquations::Share FitEquations::foot_share(int t, int ankle, double factor) const {
  Share share{t, no_share(3)};
  if (!with_system_ || !is_free(t)) return share;
  const FittedFrame& frame = frames_[static_cast<std::size_t>(t)];
  share.jacobian.leftCols(num_angles_) =
      yaw_rotation(frame.yaw_rad)
          .lazyProduct(seen_[static_cast<std::size_t>(t)].jacobian.middleRows<3>(3 * ankle));
  share.jacobian.middleCols(num_angles_, 3).setIdentity();
  share.jacobian.col(num_angles_ + 3) = kUp.cross(foot(t, ankle) - frame.root_position);
  share.jacobian *= factor;
  return share;
}

// A foot that stands moves as retrieved ones do and is as high; another one is not lower.
void FitEquations::add_foot(int t, std::size_t side) {
  const retrieval::StandingFeet& feet = targets_[static_cast<std::size_t>(t)].feet;
  const int ankle = side == 0 ? standard_joint::ltibia : standard_joint::rtibia;
  const auto row = static_cast<Eigen::Index>(side);
  const double stands = smooth_step(feet.certainty[row], weights_.stands_from, weights_.stands_at);
  const double above = foot(t, ankle).y() - feet.height_m[row];
  const double pressed = above < 0.0 ? 1.0 : stands;
  if (pressed > 0.0) {
    const Share height{t, foot_share(t, ankle, 1.0).jacobian.row(1)};
    add_small(weights_.foot_height * pressed, SmallResidual::Constant(1, above), {&height, 1});
  }
  if (t < 1 || stands <= 0.0) return;
  const Vec3 step =
      yaw_rotation(frames_[static_cast<std::size_t>(t - 1)].yaw_rad) * feet.step_m[side];
  std::array<Share, 2> shares{foot_share(t, ankle, 1.0), foot_share(t - 1, ankle, -1.0)};
  if (with_system_) shares[1].jacobian.col(num_angles_ + 3) -= kUp.cross(step);
  add_small(weights_.contact * stands, foot(t, ankle) - foot(t - 1, ankle) - step, shares);
}

// Heading and pose together turn a joint about the vertical as its gyroscope measured, on average
// over the two readings.
void FitEquations::add_turning(int t) {
  if (t < 1) return;
  const auto now = static_cast<std::size_t>(t), last = now - 1;
  const auto& rates = targets_[now].turning;
  const auto& rates_before = targets_[last].turning;
  if (rates.size() != rates_before.size()) return;  // a sensor fell silent
  for (std::size_t k = 0; k < rates.size(); ++k) {
    const int joint = rates[k].joint;
    const auto j = static_cast<std::size_t>(joint);
    const double measured =
        0.5 * (rates[k].rate_radps + rates_before[k].rate_radps) * frame_time_s_;
    const Mat3 turn =
        seen_[now].pose.R_world_joint[j] * seen_[last].pose.R_world_joint[j].transpose();
    const Vec3 turned = rotation_vector(turn);
    const double off = frames_[now].yaw_rad - frames_[last].yaw_rad + turned.y() - measured;
    const Mat3 slopes = rotation_vector_slopes(turned);
    const std::array<Share, 2> shares{turning_share(t, joint, slopes.row(1), 1.0),
                                      turning_share(t - 1, joint, slopes.col(1).transpose(), -1.0)};
    add_small(weights_.turning, SmallResidual::Constant(1, off), shares);
  }
}

FitEquations::Share FitEquations::turning_share(int t, int joint, const Eigen::RowVector3d& slope,
                                                double factor) const {
  Share share{t, no_share(1)};
  if (!with_system_ || !is_free(t)) return share;
  const Eigen::MatrixXd& jacobian = seen_[static_cast<std::size_t>(t)].jacobian;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    share.jacobian.leftCols(num_angles_) +=
        slope[axis] * jacobian.row(3 * (skeleton_.num_joints() + joint) + axis);
  share.jacobian /= std::sqrt(2.0) * weights_.lever_m;
  share.jacobian(0, num_angles_ + 3) = 1.0;
  share.jacobian *= factor;
  return share;
}

void FitEquations::add_small(double weight, const SmallResidual& residual,
                             std::span<const Share> shares) {
  if (weight <= 0.0) return;
  value_ += weight * residual.squaredNorm();
  if (!with_system_) return;
  for (std::size_t k = 0; k < shares.size() && is_free(shares[k].frame); ++k) {
    const int row = shares[k].frame - first_free_;
    const SmallJacobian weighted = weight * shares[k].jacobian;
    system_.right(row).noalias() -= weighted.transpose() * residual;
    for (std::size_t l = k; l < shares.size() && is_free(shares[l].frame); ++l)
      system_.block(row, shares[l].frame - first_free_).noalias() +=
          weighted.transpose() * shares[l].jacobian;
  }
}

FitEquations::SmallJacobian FitEquations::no_share(Eigen::Index rows) const {
  return SmallJacobian::Zero(rows, num_angles_ + kRootUnknowns);
}

}  // namespace sparse_mocap::path_regression
