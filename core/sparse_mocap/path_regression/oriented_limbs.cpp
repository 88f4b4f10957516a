// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/oriented_limbs.hpp"

#include <algorithm>

#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"
#include "sparse_mocap/retrieval/shared_heading.hpp"
#include "sparse_mocap/sensors/common_yaw.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::path_regression {
namespace {

// Points of a pose by joint.
class PosePoints {
 public:
  PosePoints(const Skeleton& skeleton, double lever_m, Eigen::VectorXd& points)
      : skeleton_(skeleton), lever_m_(lever_m), points_(points) {}

  Mat3 turn(int joint) const { return points_.segment<9>(tips(joint)).reshaped(3, 3) / lever_m_; }
  void set_turn(int joint, const Mat3& R) {
    points_.segment<9>(tips(joint)) = lever_m_ * R.reshaped();
  }
  Vec3 end(int joint) const { return points_.segment<3>(3 * joint); }

  // Puts the joint's bone where its pivot is, and moves what hangs on it along.
  void set_bone(int joint, const Vec3& bone) {
    const int parent = skeleton_.joint(joint).parent;
    move(joint, (parent < 0 ? Vec3::Zero().eval() : end(parent)) + bone - end(joint));
  }

 private:
  Eigen::Index tips(int joint) const { return 3 * skeleton_.num_joints() + 9 * joint; }

  void move(int joint, const Vec3& by) {
    points_.segment<3>(3 * joint) += by;
    for (int child = joint + 1; child < skeleton_.num_joints(); ++child)
      if (skeleton_.joint(child).parent == joint) move(child, by);
  }

  const Skeleton& skeleton_;
  double lever_m_;
  Eigen::VectorXd& points_;
};

const Site& site_of(const retrieval::Signal& signal) {
  return all_sites()[static_cast<std::size_t>(signal.site)];
}

// A sensor and how it is turned, in the heading that all share.
struct Turned {
  const Site* site;
  Mat3 R_shared_site;
};

void put_turned_sensors(std::span<const retrieval::Signal> signals,
                        const Eigen::Ref<const Eigen::RowVectorXf>& row,
                        std::vector<Turned>& found) {
  found.clear();
  for (std::size_t s = 0; s < signals.size(); ++s) {
    if (signals[s].channel != Channel::orientation) continue;
    const Mat3 R = retrieval::rotation_of_axes(
        row.segment<retrieval::kAxesColumns>(3 * static_cast<Eigen::Index>(s)));
    // Its axes may be means, which are a little short and not quite at right angles.
    if (R.allFinite()) found.push_back({&site_of(signals[s]), Quat(R).normalized().matrix()});
    ++s;  // its second axis
  }
  std::sort(found.begin(), found.end(), [](const Turned& a, const Turned& b) {
    return a.site->orientation < b.site->orientation;  // from the root outwards
  });
}

void place(const Skeleton& skeleton, const Site& site, const Mat3& R_heading_site,
           PosePoints& pose) {
  const Mat3 R_joint = R_heading_site * site.R_joint_sensor.transpose();
  pose.set_turn(site.orientation, R_joint);
  if (site.carrier != site.orientation) {  // it turns with the palm, and x is along the forearm
    const double length = skeleton.joint(site.carrier).bone.norm();
    const Vec3 before = pose.turn(site.carrier) * skeleton.joint(site.carrier).bone;
    const Vec3 along = length * R_heading_site.col(0);
    const Mat3 by = Quat::FromTwoVectors(before, along).toRotationMatrix();
    pose.set_turn(site.carrier, by * pose.turn(site.carrier));
    pose.set_bone(site.carrier, along);
  }
  pose.set_bone(site.orientation, R_joint * skeleton.joint(site.orientation).bone);
  for (int child = 0; child < skeleton.num_joints(); ++child) {
    const Joint& joint = skeleton.joint(child);
    if (joint.parent != site.orientation || !joint.axes.empty()) continue;
    pose.set_turn(child, R_joint);  // hips turn with the pelvis
    pose.set_bone(child, R_joint * joint.bone);
  }
}

}  // namespace

void put_posed_sensors(const Skeleton& skeleton, std::span<const retrieval::Signal> signals,
                       double lever_m, const Eigen::VectorXd& points, std::vector<Mat3>& R) {
  for (Mat3& each : R) each.setZero();
  for (const auto& signal : signals) {
    if (signal.channel != Channel::orientation) continue;
    const Site& site = site_of(signal);
    const auto tips = 3 * skeleton.num_joints() + 9 * site.orientation;
    const Mat3 R_heading_joint = points.segment<9>(tips).reshaped(3, 3) / lever_m;
    R[static_cast<std::size_t>(signal.sensor)] = R_heading_joint * site.R_joint_sensor;
  }
}

int place_oriented_limbs(const Skeleton& skeleton, std::span<const retrieval::Signal> signals,
                         const Eigen::Ref<const Eigen::RowVectorXf>& row, double lever_m,
                         Eigen::VectorXd& points) {
  static thread_local std::vector<Turned> sensors;
  static thread_local std::vector<Mat3> measured, retrieved;
  put_turned_sensors(signals, row, sensors);
  if (sensors.empty()) return 0;
  PosePoints pose(skeleton, lever_m, points);
  measured.clear();
  retrieved.clear();
  for (const Turned& sensor : sensors) {
    measured.push_back(sensor.R_shared_site);
    retrieved.push_back(pose.turn(sensor.site->orientation) * sensor.site->R_joint_sensor);
  }
  const Mat3 R_heading_shared = yaw_rotation(-common_yaw_rad(measured, retrieved));
  for (const Turned& sensor : sensors)
    place(skeleton, *sensor.site, R_heading_shared * sensor.R_shared_site, pose);
  return static_cast<int>(sensors.size());
}

}  // namespace sparse_mocap::path_regression
