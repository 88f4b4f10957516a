// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/shared_heading.hpp"

#include <cmath>
#include <limits>

#include "sparse_mocap/base/ordered_work.hpp"
#include "sparse_mocap/base/quaternions.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::retrieval {
namespace {

const Site& site_of(int site) { return all_sites()[static_cast<std::size_t>(site)]; }

void put_axes(const Mat3& R, Eigen::Ref<Eigen::RowVectorXf> out) {
  out.head<3>() = R.col(0).transpose().cast<float>();
  out.tail<3>() = R.col(2).transpose().cast<float>();
}

}  // namespace

double common_yaw_rad(std::span<const Mat3> measured, std::span<const Mat3> modelled) {
  // sum a.(R_y b) = cosine * cos(yaw) + sine * sin(yaw)
  double cosine = 0.0, sine = 0.0;
  for (std::size_t s = 0; s < measured.size(); ++s) {
    if (!measured[s].allFinite()) continue;
    const Mat3 sum = measured[s] * modelled[s].transpose();
    cosine += sum(0, 0) + sum(2, 2);
    sine += sum(0, 2) - sum(2, 0);
  }
  return std::atan2(sine, cosine);
}

void share_heading(std::span<const int> sites, Eigen::Ref<Eigen::RowVectorXf> axes) {
  static thread_local std::vector<Mat3> turned, resting;
  turned.clear();
  resting.clear();
  for (std::size_t s = 0; s < sites.size(); ++s) {
    turned.push_back(
        rotation_of_axes(axes.segment<kAxesColumns>(static_cast<Eigen::Index>(s) * kAxesColumns)));
    resting.push_back(site_of(sites[s]).R_joint_sensor);
  }
  const Eigen::Matrix3f back =
      yaw_rotation(-common_yaw_rad(turned, resting)).cast<float>().transpose();
  for (Eigen::Index axis = 0; axis < axes.size(); axis += 3)
    axes.segment<3>(axis) = (axes.segment<3>(axis) * back).eval();
}

Mat3 rotation_of_axes(const Eigen::Ref<const Eigen::RowVectorXf>& axes) {
  Mat3 R;
  R.col(0) = axes.head<3>().transpose().cast<double>();
  R.col(2) = axes.tail<3>().transpose().cast<double>();
  R.col(1) = R.col(2).cross(R.col(0));
  return R;
}

Eigen::RowVectorXf axes_row(const Reading& reading, std::span<const Eigen::Index> sensors,
                            std::span<const int> sites) {
  Eigen::RowVectorXf row(kAxesColumns * static_cast<Eigen::Index>(sensors.size()));
  put_axes_row(reading, sensors, sites, row);
  return row;
}

void put_axes_row(const Reading& reading, std::span<const Eigen::Index> sensors,
                  std::span<const int> sites, Eigen::Ref<Eigen::RowVectorXf> row) {
  row.setConstant(std::numeric_limits<float>::quiet_NaN());
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    const Eigen::Vector4d orientation = reading.orientation.col(sensors[s]);
    if (orientation.allFinite() && orientation.norm() > 0.0)
      put_axes(quaternion_of(orientation).normalized().toRotationMatrix(),
               row.segment<kAxesColumns>(static_cast<Eigen::Index>(s) * kAxesColumns));
  }
  share_heading(sites, row);
}

FeatureRows database_axes(const MotionDatabase& database, std::span<const int> sites) {
  constexpr std::size_t kPiece = 256;
  FeatureRows rows(database.num_frames(), kAxesColumns * static_cast<Eigen::Index>(sites.size()));
  const Skeleton& skeleton = database.skeleton();
  in_pieces(static_cast<std::size_t>(rows.rows()), kPiece, 0, [&](std::size_t frame) {
    const auto at = static_cast<Eigen::Index>(frame);
    const Eigen::VectorXd angles = database.angles().row(at).transpose().cast<double>();
    JointTransforms pose;
    forward_kinematics(skeleton, Vec3::Zero(), angles, pose);
    Eigen::RowVectorXf row(rows.cols());
    for (std::size_t s = 0; s < sites.size(); ++s) {
      const Site& site = site_of(sites[s]);
      put_axes(pose.R_world_joint[site.orientation] * site.R_joint_sensor,
               row.segment<kAxesColumns>(static_cast<Eigen::Index>(s) * kAxesColumns));
    }
    share_heading(sites, row);
    rows.row(at) = row;
  });
  return rows;
}

}  // namespace sparse_mocap::retrieval
