// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/calibration_poses.hpp"

#include <string>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap::liu2011 {
namespace {

using namespace standard_joint;

Mat3 turn(const Vec3& axis, double degrees) {
  return Eigen::AngleAxisd(degrees * kRadiansPerDegree, axis).toRotationMatrix();
}
Mat3 about_x(double degrees) { return turn(Vec3::UnitX(), degrees); }
Mat3 about_y(double degrees) { return turn(Vec3::UnitY(), degrees); }
Mat3 about_z(double degrees) { return turn(Vec3::UnitZ(), degrees); }

// In rest pose the arms are stretched out, the legs spread by kSpread_deg, and the hinge of an
// elbow is turned by kElbow_deg about the arm from the vertical.
constexpr double kSpread_deg = 20.0, kElbow_deg = 30.0;

// A pose that is put together limb by limb; turns are about the axes of the parent, which in rest
// pose are those of the world: x to the left, y up, z forward. side: 1 left, -1 right.
class Builder {
 public:
  explicit Builder(const Skeleton& skeleton)
      : skeleton_(skeleton), rotations_(kNumStandardJoints, Mat3::Identity()) {
    for (const double side : {1.0, -1.0}) leg(side, 0.0, 0.0);
  }

  // The arm, which first is bent at the elbow, forward where it hangs down, and then turned.
  Builder& arm(double side, const Mat3& R, double elbow_deg = 0.0) {
    const bool is_left = side > 0.0;
    rotations_[is_left ? lhumerus : rhumerus] = R * about_x(kElbow_deg);
    bend(is_left ? lradius : rradius, elbow_deg);
    return *this;
  }
  Builder& arms(const Mat3& left, const Mat3& right, double elbow_deg = 0.0) {
    return arm(1.0, left, elbow_deg).arm(-1.0, right, elbow_deg);
  }
  Builder& leg(double side, double forward_deg, double knee_deg) {
    const bool is_left = side > 0.0;
    rotations_[is_left ? lfemur : rfemur] = about_x(-forward_deg) * about_z(-side * kSpread_deg);
    bend(is_left ? ltibia : rtibia, knee_deg);
    return *this;
  }
  // From the hips; the legs stay where they are.
  Builder& bow(double degrees) {
    rotations_[root] = about_x(degrees);
    return leg(1.0, degrees, 0.0).leg(-1.0, degrees, 0.0);
  }
  // To the left, half of it in the lower and half in the upper back.
  Builder& lean(double degrees) {
    rotations_[lowerback] = rotations_[upperback] = about_z(-0.5 * degrees);
    return *this;
  }

  JointRotations pose() const { return reachable(skeleton_, rotations_); }

 private:
  void bend(Index joint, double degrees) {
    const double angle = degrees * kRadiansPerDegree;
    rotations_[joint] = joint_rotation(skeleton_.joint(joint), &angle);
  }

  const Skeleton& skeleton_;
  JointRotations rotations_;
};

std::vector<CalibrationPose> made_poses() {
  const Skeleton skeleton = make_standard_skeleton(template_bones());
  const auto begun = [&] { return Builder(skeleton); };
  const Mat3 out = Mat3::Identity();
  const Mat3 left_down = about_z(-90.0), right_down = about_z(90.0);
  const Mat3 left_forward = about_y(-90.0), right_forward = about_y(90.0);
  return {
      {"arms_out", "Stand upright, both arms stretched out to the sides, palms down",
       begun().arms(out, out).pose()},
      {"arms_forward", "Stand upright, both arms stretched forward, palms down",
       begun().arms(left_forward, right_forward).pose()},
      {"arms_up", "Stand upright, both arms stretched straight up, palms outward",
       begun().arms(right_down, left_down).pose()},
      {"elbows_bent",
       "Upper arms hang at the sides, both elbows bent by 90 degrees, forearms forward",
       begun().arms(left_down, right_down, 90.0).pose()},
      {"bow", "Bow by 45 degrees from the hips, back and knees straight, arms along the body",
       begun().bow(45.0).arms(left_down, right_down).pose()},
      {"left_knee_up", "Left thigh level, shank hanging, right arm stretched forward, left one out",
       begun().leg(1.0, 90.0, 90.0).arms(out, right_forward).pose()},
      {"right_knee_up",
       "Right thigh level, shank hanging, left arm stretched forward, right one out",
       begun().leg(-1.0, 90.0, 90.0).arms(left_forward, out).pose()},
      {"lean_left",
       "Lean by 30 degrees to the left at the waist, arms stretched out from the chest",
       begun().lean(30.0).arms(out, out).pose()},
  };
}

}  // namespace

const std::vector<CalibrationPose>& calibration_poses() {
  static const auto poses = made_poses();
  return poses;
}

int find_calibration_pose(std::string_view name) {
  std::string known;
  for (std::size_t i = 0; i < calibration_poses().size(); ++i) {
    if (calibration_poses()[i].name == name) return static_cast<int>(i);
    known += (i == 0 ? "" : ", ") + std::string(calibration_poses()[i].name);
  }
  throw ConfigError("unknown calibration pose '" + std::string(name) + "'; known are " + known);
}

}  // namespace sparse_mocap::liu2011
