// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/skeleton.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>

#include "support/refusals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::Random;
using testing::template_skeleton;

Joint joint(std::string name, int parent, Vec3 offset, Vec3 bone, std::vector<Axis> axes) {
  return {std::move(name), parent, offset, bone, Mat3::Identity(), std::move(axes)};
}

Joint bare(std::string name, int parent, std::vector<Axis> axes = {}) {
  return joint(std::move(name), parent, Vec3::Zero(), Vec3::Zero(), std::move(axes));
}

Skeleton random_tree(Random& random, int num_joints) {
  static const std::vector<std::vector<Axis>> choices{
      {}, {Axis::y}, {Axis::z, Axis::x}, {Axis::x, Axis::y, Axis::z}, {Axis::y, Axis::x, Axis::z}};
  std::vector<Joint> joints;
  for (int j = 0; j < num_joints; ++j)
    joints.push_back({"j" + std::to_string(j), j == 0 ? -1 : random.below(j), random.vector(0.5),
                      random.vector(0.5), random.rotation().toRotationMatrix(),
                      choices[static_cast<std::size_t>(random.below(5))]});
  return Skeleton(joints);
}

// The ends of all joints of a pose, stacked.
Eigen::VectorXd ends_of(const Skeleton& skeleton, const Eigen::VectorXd& angles) {
  JointTransforms pose;
  forward_kinematics(skeleton, Vec3(0.1, 0.2, 0.3), angles, pose);
  Eigen::VectorXd ends(3 * skeleton.num_joints());
  for (Eigen::Index j = 0; j < skeleton.num_joints(); ++j)
    ends.segment<3>(3 * j) = pose.end[static_cast<std::size_t>(j)];
  return ends;
}

TEST(Skeleton, RefusesWhatIsNotATree) {
  const auto refuses = [](std::vector<Joint> joints, std::string_view text) {
    EXPECT_REFUSED(std::invalid_argument, text, Skeleton{std::move(joints)});
  };
  const Joint root = bare("root", -1);
  refuses({bare("", -1)}, "name empty or repeated: ''");
  refuses({root, bare("root", 0)}, "name empty or repeated: 'root'");
  refuses({root, bare("a", -1)}, "must precede it");
  refuses({bare("a", 0)}, "must precede it");
  refuses({root, bare("a", 1)}, "must precede it");
  refuses({root, bare("a", 2), bare("b", 0)}, "must precede it");
}

TEST(Skeleton, RefusesWhatIsNotFiniteAndRepeatedAxes) {
  const auto refuses = [](std::string_view text, const std::function<void(Joint&)>& damage) {
    Joint root = joint("root", -1, Vec3::Zero(), Vec3::Zero(), {});
    damage(root);
    EXPECT_REFUSED(std::invalid_argument, text, Skeleton({root}));
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refuses("are not finite", [&](Joint& j) { j.bone.x() = nan; });
  refuses("are not finite",
          [&](Joint& j) { j.offset_parent.z() = std::numeric_limits<double>::infinity(); });
  refuses("are not finite", [&](Joint& j) { j.R_joint_axes(1, 2) = nan; });
  refuses("repeats an axis", [&](Joint& j) { j.axes = {Axis::x, Axis::y, Axis::x}; });
  refuses("repeats an axis", [&](Joint& j) { j.axes = {Axis::x, Axis::y, Axis::z, Axis::x}; });
}

TEST(Skeleton, KnowsItsJointsByNameAndWhereTheirAnglesBegin) {
  const Skeleton skeleton({bare("root", -1, {Axis::x, Axis::y, Axis::z}), bare("stiff", 0),
                           bare("hinge", 1, {Axis::y})});
  EXPECT_EQ(skeleton.find("hinge"), 2);
  EXPECT_EQ(skeleton.find("Hinge"), -1);
  EXPECT_EQ(skeleton.num_angles(), 4);
  EXPECT_EQ(skeleton.angle_begin(0), 0);
  EXPECT_EQ(skeleton.angle_begin(1), 3);
  EXPECT_EQ(skeleton.angle_begin(2), 3);
  EXPECT_EQ(Skeleton().num_joints(), 0);
}

// Worked by hand: quarter turns about z, then y, then x along a chain with offsets and bones.
TEST(ForwardKinematics, FollowsAHandWorkedChain) {
  const Skeleton chain({joint("a", -1, Vec3(9, 9, 9), Vec3(0, 2, 0), {Axis::z}),
                        joint("b", 0, Vec3(1, 0, 0), Vec3(0, 0, 3), {Axis::y}),
                        joint("c", 1, Vec3(0, 1, 0), Vec3(0, 1, 0), {Axis::x})});
  JointTransforms pose;
  forward_kinematics(chain, Vec3(10, 20, 30), Eigen::Vector3d::Constant(kPi / 2), pose);
  EXPECT_LT((pose.pivot[0] - Vec3(10, 20, 30)).norm(), 1e-12);
  EXPECT_LT((pose.end[0] - Vec3(8, 20, 30)).norm(), 1e-12);    // up becomes -x
  EXPECT_LT((pose.pivot[1] - Vec3(8, 21, 30)).norm(), 1e-12);  // x becomes y
  EXPECT_LT((pose.end[1] - Vec3(8, 24, 30)).norm(), 1e-12);    // z becomes x, then y
  EXPECT_LT((pose.pivot[2] - Vec3(7, 24, 30)).norm(), 1e-12);
  EXPECT_LT((pose.end[2] - Vec3(7, 25, 30)).norm(), 1e-12);  // y becomes z, x, then y
}

TEST(ForwardKinematics, TurnsAnglesInTheJointsOwnAxes) {
  Joint hinge = joint("hinge", -1, Vec3::Zero(), Vec3(0, 1, 0), {Axis::x});
  hinge.R_joint_axes = Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()).toRotationMatrix();  // x is y
  JointTransforms pose;
  forward_kinematics(Skeleton({hinge}), Vec3::Zero(), Eigen::VectorXd::Constant(1, 0.7), pose);
  EXPECT_LT(
      (pose.R_world_joint[0] - Eigen::AngleAxisd(0.7, Vec3::UnitY()).toRotationMatrix()).norm(),
      1e-12);
  EXPECT_LT((pose.end[0] - Vec3(0, 1, 0)).norm(), 1e-12);
}

void expect_jacobian_of_differences(const Skeleton& skeleton, const Eigen::VectorXd& angles) {
  JointTransforms pose;
  forward_kinematics(skeleton, Vec3(0.1, 0.2, 0.3), angles, pose);
  const Eigen::MatrixXd jacobian = position_jacobian(skeleton, angles, pose);
  ASSERT_EQ(jacobian.rows(), 3 * skeleton.num_joints());
  ASSERT_EQ(jacobian.cols(), skeleton.num_angles());
  constexpr double h = 1e-5;
  for (Eigen::Index a = 0; a < angles.size(); ++a) {
    Eigen::VectorXd more = angles, less = angles;
    more[a] += h;
    less[a] -= h;
    const Eigen::VectorXd numeric = (ends_of(skeleton, more) - ends_of(skeleton, less)) / (2 * h);
    EXPECT_LT((jacobian.col(a) - numeric).cwiseAbs().maxCoeff(), 1e-9) << "angle " << a;
  }
}

TEST(PositionJacobian, EqualsCentralDifferencesOnTheStandardSkeleton) {
  Random random(1);
  const Skeleton skeleton = template_skeleton();
  for (int trial = 0; trial < 10; ++trial)
    expect_jacobian_of_differences(skeleton, random.column(skeleton.num_angles(), 2.0));
}

TEST(PositionJacobian, EqualsCentralDifferencesOnAnyTree) {
  Random random(2);
  for (int trial = 0; trial < 10; ++trial) {
    const Skeleton skeleton = random_tree(random, 12);
    expect_jacobian_of_differences(skeleton, random.column(skeleton.num_angles(), 3.0));
  }
}

// Poses written with other angles: full turns and the other triple of three-axis joints.
Eigen::VectorXd rewritten(const Skeleton& skeleton, Eigen::VectorXd angles, Random& random) {
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const int begin = skeleton.angle_begin(j);
    if (skeleton.joint(j).axes.size() == 3 && random.below(2) == 1) {
      angles[begin] += kPi;
      angles[begin + 1] = kPi - angles[begin + 1];
      angles[begin + 2] += kPi;
    }
  }
  for (auto& angle : angles) angle += 2.0 * kPi * (random.below(5) - 2);
  return angles;
}

TEST(UnwindPose, FindsTheReferenceAgainAndKeepsThePose) {
  Random random(3);
  const Skeleton skeleton = template_skeleton();
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::VectorXd reference = random.column(skeleton.num_angles(), 3.0);
    const Eigen::VectorXd near = reference + random.column(skeleton.num_angles(), 0.2);
    Eigen::VectorXd angles = rewritten(skeleton, near, random);
    const Eigen::VectorXd before = ends_of(skeleton, angles);
    unwind_pose(skeleton, reference, angles);
    EXPECT_LT((ends_of(skeleton, angles) - before).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((angles - near).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(UnwindPose, NeverLeavesAPoseFartherFromTheReference) {
  Random random(4);
  const Skeleton skeleton = random_tree(random, 15);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::VectorXd reference = random.column(skeleton.num_angles(), 3.0);
    const Eigen::VectorXd start = random.column(skeleton.num_angles(), 9.0);
    Eigen::VectorXd angles = start;
    unwind_pose(skeleton, reference, angles);
    EXPECT_LE((angles - reference).norm(), (start - reference).norm() + 1e-12);
    EXPECT_LT((ends_of(skeleton, angles) - ends_of(skeleton, start)).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace sparse_mocap
