// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sparse_mocap/base/conventions.hpp"

namespace sparse_mocap {

enum class Axis { x, y, z };

Vec3 unit(Axis axis);

// One joint with the bone that it moves.
//
// A joint turns about its pivot, which sits at offset_parent from its parent's end; its end (the
// position of the joint in this project) lies at bone from the pivot. Acclaim bones have a zero
// offset and a bone, BVH joints an offset and a zero bone; everything else treats both alike:
//   pivot = end_parent + R_world_parent * offset_parent
//   end   = pivot + R_world_joint * bone
//   R_world_joint = R_world_parent * R_joint
struct Joint {
  std::string name;
  int parent = -1;                       // smaller than the joint's own index; -1: the root
  Vec3 offset_parent = Vec3::Zero();     // m, frame of the parent
  Vec3 bone = Vec3::Zero();              // m, frame of the joint
  Mat3 R_joint_axes = Mat3::Identity();  // the frame in which the joint's angles turn
  // The angles' axes, outermost first: the joint turns by
  // R_joint = A * R(axes[0], a0) * R(axes[1], a1) * ... * A^T with A = R_joint_axes.
  std::vector<Axis> axes;
};

// A tree of joints; a parent always precedes its children and joint 0 is the only root.
class Skeleton {
 public:
  Skeleton() = default;
  // Throws std::invalid_argument when a parent does not precede its child, a second root exists, a
  // name is empty or repeated, or a length is not finite.
  explicit Skeleton(std::vector<Joint> joints);

  int num_joints() const { return static_cast<int>(joints_.size()); }
  int num_angles() const { return num_angles_; }
  const Joint& joint(int index) const { return joints_[static_cast<std::size_t>(index)]; }
  const std::vector<Joint>& joints() const { return joints_; }
  // The index of the first angle of a joint in a pose vector.
  int angle_begin(int index) const { return angle_begins_[static_cast<std::size_t>(index)]; }
  // The index of the joint with this name, -1 if there is none.
  int find(std::string_view name) const;

 private:
  std::vector<Joint> joints_;
  std::vector<int> angle_begins_;
  int num_angles_ = 0;
};

// Where the joints are in one frame, all in the world frame (m).
struct JointTransforms {
  std::vector<Mat3> R_world_joint;
  std::vector<Vec3> pivot;
  std::vector<Vec3> end;
};

// R_joint for the joint's angles (rad, in the order of its axes).
Mat3 joint_rotation(const Joint& joint, const double* angles);

// The angles (rad) whose joint_rotation is closest to R_joint. Exact when the rotation can be
// reached: three different axes always can, fewer only within their subgroup. Of the two triples
// that give one rotation the one nearer to reference (null: zero; may be angles itself) is taken.
void joint_angles(const Joint& joint, const Mat3& R_joint, const double* reference, double* angles);

// Replaces a pose's angles by those that mean the same pose and lie nearest to reference: a full
// turn more or less, and of each three-axis joint's two triples the nearer one.
void unwind_pose(const Skeleton& skeleton, const Eigen::VectorXd& reference,
                 Eigen::Ref<Eigen::VectorXd> angles);

// Forward kinematics from joint rotations. position_root is the pivot of the root.
void forward_kinematics(const Skeleton& skeleton, const Vec3& position_root,
                        const std::vector<Mat3>& R_joint, JointTransforms& out);

// As above with other offsets than the skeleton's own, one a joint: some files move them.
void forward_kinematics(const Skeleton& skeleton, const std::vector<Vec3>& offset_parent,
                        const Vec3& position_root, const std::vector<Mat3>& R_joint,
                        JointTransforms& out);

// Forward kinematics of a pose vector (rad, all joints' angles one after another).
void forward_kinematics(const Skeleton& skeleton, const Vec3& position_root,
                        const Eigen::VectorXd& angles, JointTransforms& out);

// The joints' ends one after another: 3 joints (m).
Eigen::VectorXd stacked_ends(const JointTransforms& transforms);

// Where the joints are when no joint is turned and the root is at the origin.
JointTransforms rest_pose(const Skeleton& skeleton);

// d(end of every joint, stacked x y z) / d(angles): 3 joints x angles (m/rad), at the pose that
// transforms holds; the root's pivot stays where it is.
Eigen::MatrixXd position_jacobian(const Skeleton& skeleton, const Eigen::VectorXd& angles,
                                  const JointTransforms& transforms);

}  // namespace sparse_mocap
