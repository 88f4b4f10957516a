// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/shared_heading.hpp"

#include <algorithm>
#include <limits>

#include "sparse_mocap/base/ordered_work.hpp"
#include "sparse_mocap/base/quaternions.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/sensors/common_yaw.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::retrieval {
namespace {

const Site& site_of(int site) { return all_sites()[static_cast<std::size_t>(site)]; }

void put_axes(const Mat3& R, Eigen::Ref<Eigen::RowVectorXf> out) {
  out.head<3>() = R.col(0).transpose().cast<float>();
  out.tail<3>() = R.col(2).transpose().cast<float>();
}

}  // namespace

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

namespace {

// The orientations that real sensors at these sites told, null where there are none.
std::vector<const ScaledRows*> told_orientations(const MotionDatabase& database,
                                                 std::span<const int> sites) {
  std::vector<const ScaledRows*> told;
  const auto& names = database.site_names();
  for (const int site : sites) {
    const auto at = std::find(names.begin(), names.end(), site_of(site).name);
    const ScaledRows* rows =
        at == names.end()
            ? nullptr
            : &database.site(static_cast<std::size_t>(at - names.begin())).orientation;
    told.push_back(rows != nullptr && rows->rows() > 0 ? rows : nullptr);
  }
  return told;
}

// R_heading_sensor in a row: as a real sensor told it, else as the pose has it.
Mat3 orientation_in(const ScaledRows* told, Eigen::Index row, const JointTransforms& pose,
                    const Site& site) {
  if (told != nullptr) {
    const Eigen::Vector4d wxyz = told->row(row).transpose().cast<double>();
    if (wxyz.norm() > 0.0) return quaternion_of(wxyz).normalized().toRotationMatrix();
  }
  return pose.R_world_joint[site.orientation] * site.R_joint_sensor;
}

}  // namespace

FeatureRows database_axes(const MotionDatabase& database, std::span<const int> sites) {
  constexpr std::size_t kPiece = 256;
  FeatureRows rows(database.num_frames(), kAxesColumns * static_cast<Eigen::Index>(sites.size()));
  const Skeleton& skeleton = database.skeleton();
  const auto told = told_orientations(database, sites);
  in_pieces(static_cast<std::size_t>(rows.rows()), kPiece, 0, [&](std::size_t frame) {
    const auto at = static_cast<Eigen::Index>(frame);
    const Eigen::VectorXd angles = database.angles().row(at).transpose().cast<double>();
    JointTransforms pose;
    forward_kinematics(skeleton, Vec3::Zero(), angles, pose);
    Eigen::RowVectorXf row(rows.cols());
    for (std::size_t s = 0; s < sites.size(); ++s) {
      put_axes(orientation_in(told[s], at, pose, site_of(sites[s])),
               row.segment<kAxesColumns>(static_cast<Eigen::Index>(s) * kAxesColumns));
    }
    share_heading(sites, row);
    rows.row(at) = row;
  });
  return rows;
}

}  // namespace sparse_mocap::retrieval
