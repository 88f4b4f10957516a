// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/motion_examples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"
#include "sparse_mocap/retrieval/neighbourhood.hpp"

namespace sparse_mocap::liu2011 {
namespace {

Quat yaw_quaternion(double yaw_rad) {
  return {std::cos(0.5 * yaw_rad), 0.0, std::sin(0.5 * yaw_rad), 0.0};
}

Vec3 rotation_vector(const Quat& rotation) {
  const double sine = rotation.vec().norm();
  if (sine < 1e-9) return rotation.w() < 0.0 ? Vec3(-2.0 * rotation.vec()) : 2.0 * rotation.vec();
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
  return rotation.vec() * (sign * 2.0 * std::atan2(sine, sign * rotation.w()) / sine);
}

}  // namespace

MotionExamples::MotionExamples(std::shared_ptr<const MotionDatabase> database, Skeleton body,
                               Direction direction, const std::vector<bool>& is_used)
    : database_(std::move(database)),
      body_(std::move(body)),
      direction_(direction),
      scale_(leg_length_m(bones_of(body_)) / leg_length_m(bones_of(database_->skeleton()))) {
  lay_out();
  const int stride = std::max(1, num_frames() / kMostMeanFrames);
  numbers_.setZero(num_frames(), num_numbers_);
  std::vector<double> row(static_cast<std::size_t>(num_numbers_));
  for (int frame = 0; frame < num_frames(); ++frame) {
    const bool is_wanted = is_used.empty() || is_used[static_cast<std::size_t>(frame)];
    if (!is_wanted && frame % stride != 0) continue;
    const BodyPose here = pose(frame);
    for (int j = 0; j < body_.num_joints(); ++j)
      put_numbers(j, here.rotations[static_cast<std::size_t>(j)], row.data());
    numbers_.row(frame) =
        Eigen::Map<const Eigen::RowVectorXd>(row.data(), num_numbers_).cast<float>();
  }
  std::vector<Place> places;
  for (int frame = 0; frame < num_frames(); frame += stride) places.push_back({frame, {}});
  mean_ = mean_of(places, Eigen::VectorXd::Ones(static_cast<Eigen::Index>(places.size())));
}

BodyPose MotionExamples::pose(int frame) const {
  const Eigen::VectorXd angles = database_->angles().row(frame).transpose().cast<double>();
  return {{0.0, scale_ * database_->root_motion()(frame, root_motion_column::height), 0.0},
          joint_rotations(body_, angles)};
}

HeadingFrame MotionExamples::step(int frame) const {
  if (is_first(frame)) return {};
  return direction_ == Direction::forward ? recorded_step(frame)
                                          : recorded_step(frame + 1).inverse();
}

// The heading frame of a frame in that of the frame before it in the recording.
HeadingFrame MotionExamples::recorded_step(int frame) const {
  using namespace root_motion_column;
  const auto motion = database_->root_motion().row(frame);
  const double dt_s = database_->frame_time_s();
  return {motion[yaw_rate] * dt_s,
          scale_ * dt_s * Vec3(motion[velocity_left], 0.0, motion[velocity_forward])};
}

std::vector<MotionExamples::Place> MotionExamples::history(int frame, int count) const {
  std::vector<Place> places;
  Place place{before(frame), {}};
  for (int i = 0; i < count; ++i) {
    places.push_back(place);
    const HeadingFrame moved = step(place.frame);
    place.heading.yaw_rad -= moved.yaw_rad;
    place.heading.origin -= yaw_rotation(place.heading.yaw_rad) * moved.origin;
    place.frame = before(place.frame);
  }
  return places;
}

MotionExamples::Reference MotionExamples::reference(const BodyPose& pose) const {
  Reference out{pose.root_position, std::vector<double>(static_cast<std::size_t>(num_numbers_))};
  for (int j = 0; j < body_.num_joints(); ++j)
    put_numbers(j, pose.rotations[static_cast<std::size_t>(j)], out.numbers.data());
  return out;
}

void MotionExamples::put_vector(const Place& place, const Reference& reference, double* out) const {
  put_root(place, reference, out);
  put_joints(place.frame, reference, out + num_root_freedoms());
}

void MotionExamples::put_root(const Place& place, const Reference& reference, double* out) const {
  const double height_m = database_->root_motion()(place.frame, root_motion_column::height);
  const Vec3 root = place.heading.origin + Vec3(0.0, scale_ * height_m, 0.0);
  out = std::copy_n((root - reference.root_position).eval().data(), 3, out);
  put_turns(0, place, reference, out);
}

void MotionExamples::put_joints(int frame, const Reference& reference, double* out) const {
  for (std::size_t j = 1; j < layout_.size(); ++j) out = put_turns(j, {frame, {}}, reference, out);
}

Eigen::Index MotionExamples::num_root_freedoms() const {
  return 3 + static_cast<Eigen::Index>(layout_.front().axes.size());
}

// The numbers of one joint; returns where the next one's go.
double* MotionExamples::put_turns(std::size_t joint, const Place& place, const Reference& reference,
                                  double* out) const {
  const Layout& layout = layout_[joint];
  const float* own = numbers_.data() + place.frame * num_numbers_ + layout.begin;
  const double* from = reference.numbers.data() + layout.begin;
  if (!layout.is_ball) {
    for (std::size_t i = 0; i < layout.axes.size(); ++i)
      *out++ = std::remainder(static_cast<double>(own[i]) - from[i], 2.0 * kPi);
    return out;
  }
  Quat rotation = Eigen::Map<const Eigen::Quaternionf>(own).cast<double>();
  if (joint == 0) rotation = yaw_quaternion(place.heading.yaw_rad) * rotation;
  const Vec3 turn = rotation_vector(Eigen::Map<const Quat>(from).conjugate() * rotation);
  for (const Eigen::Index component : layout.axes) *out++ = turn[component];
  return out;
}

Eigen::VectorXd MotionExamples::vectors(std::span<const Place> places,
                                        const Reference& reference) const {
  const Eigen::Index n = num_freedoms(body_);
  Eigen::VectorXd out(n * static_cast<Eigen::Index>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i)
    put_vector(places[i], reference, out.data() + static_cast<Eigen::Index>(i) * n);
  return out;
}

BodyPose MotionExamples::mean_next(std::span<const int> frames,
                                   const Eigen::VectorXd& weights) const {
  std::vector<Place> places;
  for (const int frame : frames) places.push_back({frame, step(frame)});
  return mean_of(places, weights);
}

void MotionExamples::lay_out() {
  for (const Joint& joint : body_.joints()) {
    Layout layout{num_numbers_, joint.axes.size() == 3, {}};
    for (const Axis axis : joint.axes) layout.axes.push_back(static_cast<Eigen::Index>(axis));
    num_numbers_ += layout.is_ball ? 4 : static_cast<Eigen::Index>(joint.axes.size());
    layout_.push_back(std::move(layout));
  }
}

void MotionExamples::put_numbers(int joint, const Mat3& R_joint, double* out) const {
  const Joint& described = body_.joint(joint);
  const Layout& layout = layout_[static_cast<std::size_t>(joint)];
  out += layout.begin;
  if (!layout.is_ball) {
    joint_angles(described, R_joint, nullptr, out);
    return;
  }
  const Mat3& A = described.R_joint_axes;
  const Quat in_axes(A.transpose() * R_joint * A);
  std::copy_n(in_axes.coeffs().data(), 4, out);
}

bool MotionExamples::is_first(int frame) const {
  const Clip& clip = retrieval::clip_at(*database_, frame);
  return frame == (direction_ == Direction::forward ? clip.begin : clip.end - 1);
}

int MotionExamples::before(int frame) const {
  if (is_first(frame)) return frame;
  return direction_ == Direction::forward ? frame - 1 : frame + 1;
}

// Of each ball joint the rotation nearest to all, by their quaternions; of others the angles' mean.
BodyPose MotionExamples::mean_of(std::span<const Place> places,
                                 const Eigen::VectorXd& weights) const {
  BodyPose mean;
  const Eigen::VectorXd share = weights / weights.sum();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(num_numbers_);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double weight = share[static_cast<Eigen::Index>(k)];
    const int frame = places[k].frame;
    mean.root_position +=
        weight *
        (places[k].heading.origin +
         Vec3(0.0, scale_ * database_->root_motion()(frame, root_motion_column::height), 0.0));
    Eigen::VectorXd row = numbers_.row(frame).transpose().cast<double>();
    Eigen::Map<Quat> root(row.data());
    root = yaw_quaternion(places[k].heading.yaw_rad) * root;
    for (const Layout& layout : layout_)
      if (layout.is_ball && row.segment<4>(layout.begin).dot(sum.segment<4>(layout.begin)) < 0.0)
        row.segment<4>(layout.begin) *= -1.0;
    sum += weight * row;
  }
  for (int j = 0; j < body_.num_joints(); ++j) {
    const Layout& layout = layout_[static_cast<std::size_t>(j)];
    const Mat3& A = body_.joint(j).R_joint_axes;
    if (layout.is_ball)
      mean.rotations.push_back(
          A * Quat(Eigen::Vector4d(sum.segment<4>(layout.begin)).normalized()).toRotationMatrix() *
          A.transpose());
    else
      mean.rotations.push_back(joint_rotation(body_.joint(j), sum.data() + layout.begin));
  }
  return mean;
}

}  // namespace sparse_mocap::liu2011
