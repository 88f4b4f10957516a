// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/liu2011/body_pose.hpp"

namespace sparse_mocap::liu2011 {

// Which way clips are played.
enum class Direction { forward, backward };

// The database's frames as a performer with a given body would have moved, quickly looked up.
//
// The frame before one is the one before it in its clip as it is played; the first frame of a clip
// stands in for those before it.
class MotionExamples {
 public:
  // The body is a standard skeleton; root motion is scaled by the length of its legs. Vectors can
  // be made of frames of those clips alone whose frames are used: one flag a frame, or all.
  MotionExamples(std::shared_ptr<const MotionDatabase> database, Skeleton body,
                 Direction direction = Direction::forward, const std::vector<bool>& is_used = {});

  const MotionDatabase& database() const { return *database_; }
  const Skeleton& body() const { return body_; }
  int num_frames() const { return database_->num_frames(); }

  // The frame's pose in its own heading frame, the root on the vertical axis.
  BodyPose pose(int frame) const;
  // The heading frame of a frame in that of the frame before.
  HeadingFrame step(int frame) const;
  // The frame's pose in the heading frame of the frame before.
  BodyPose next(int frame) const { return step(frame).to_parent(pose(frame)); }

  // The `count` frames before a frame, the newest first, and their heading frames in that of the
  // newest.
  struct Place {
    int frame = 0;
    HeadingFrame heading;
  };
  std::vector<Place> history(int frame, int count) const;

  // A pose to which others are compared, as pose_vector() does, prepared for many.
  struct Reference {
    Vec3 root_position = Vec3::Zero();
    std::vector<double> numbers;
  };
  Reference reference(const BodyPose& pose) const;
  // pose_vector() of a placed frame about the reference: num_freedoms numbers.
  void put_vector(const Place& place, const Reference& reference, double* out) const;
  // Its two parts: the root's position and rotation, num_root_freedoms() numbers, and all joints
  // beyond, which do not depend on the place.
  void put_root(const Place& place, const Reference& reference, double* out) const;
  void put_joints(int frame, const Reference& reference, double* out) const;
  Eigen::Index num_root_freedoms() const;
  // The same of poses one after another.
  Eigen::VectorXd vectors(std::span<const Place> places, const Reference& reference) const;

  // The weighted mean of frames' next().
  BodyPose mean_next(std::span<const int> frames, const Eigen::VectorXd& weights) const;
  // The mean over the database of poses in their own heading frames.
  const BodyPose& mean() const { return mean_; }

 private:
  static constexpr int kMostMeanFrames = 2000;

  // Where a joint's numbers are: a quaternion in the frame of its axes (x y z w) of those with
  // three axes, angles of the others.
  struct Layout {
    Eigen::Index begin = 0;
    bool is_ball = false;
    std::vector<Eigen::Index> axes;  // of a ball: which component of a vector each number is
  };

  void lay_out();
  double* put_turns(std::size_t joint, const Place& place, const Reference& reference,
                    double* out) const;
  void put_numbers(int joint, const Mat3& R_joint, double* out) const;
  bool is_first(int frame) const;
  int before(int frame) const;
  HeadingFrame recorded_step(int frame) const;
  BodyPose mean_of(std::span<const Place> places, const Eigen::VectorXd& weights) const;

  std::shared_ptr<const MotionDatabase> database_;
  Skeleton body_;
  Direction direction_;
  double scale_ = 1.0;  // of root motion
  std::vector<Layout> layout_;
  Eigen::Index num_numbers_ = 0;
  Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> numbers_;  // a row a frame
  BodyPose mean_;
};

}  // namespace sparse_mocap::liu2011
