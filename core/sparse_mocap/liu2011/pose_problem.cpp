// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/pose_problem.hpp"

#include <ceres/dynamic_autodiff_cost_function.h>
#include <ceres/normal_prior.h>
#include <ceres/problem.h>
#include <ceres/rotation.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <array>
#include <cmath>
#include <limits>

#include "sparse_mocap/liu2011/calibration_poses.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::liu2011 {
namespace {

constexpr double kMounting_rad = 3.0;  // prior deviations that only keep the equations regular
constexpr double kPlace_m = 10.0, kYaw_rad = 10.0;
constexpr int kMostIterations = 60;

const Skeleton& directions() {
  static const Skeleton skeleton = make_standard_skeleton(template_bones());
  return skeleton;
}

const Site& site_of(const Sensor& sensor) {
  return all_sites()[static_cast<std::size_t>(sensor.site)];
}

std::vector<int> chain_to(int joint) {
  std::vector<int> chain;
  for (int j = joint; j >= 0; j = directions().joint(j).parent) chain.insert(chain.begin(), j);
  return chain;
}

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <typename T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;

template <typename T>
Matrix3<T> rotation_of(const Vector3<T>& vector) {
  Matrix3<T> R;
  ceres::AngleAxisToRotationMatrix(vector.data(), R.data());
  return R;
}

// A joint's rotation when it misses the shown one by a turn about each of its axes, in its frame.
template <typename T>
Matrix3<T> missed_rotation(const Mat3& shown, const Joint& joint, const T* steps) {
  Vector3<T> turn = Vector3<T>::Zero();
  for (std::size_t a = 0; a < joint.axes.size(); ++a)
    turn += (joint.R_joint_axes * unit(joint.axes[a])).template cast<T>() * steps[a];
  return shown.template cast<T>() * rotation_of(turn);
}

// f(s, p_j; q_i) - t_i^j and f(s, o_j; q_i) - r_i^j, in deviations.
class SensorResidual {
 public:
  SensorResidual(const Sensor& sensor, const HeldSensor& held, const JointRotations& shown,
                 const Mat3& R_joint_sensor, const PoseCalibrationSettings& settings)
      : sensor_(sensor),
        held_(held),
        shown_(shown),
        R_joint_sensor_(R_joint_sensor),
        to_carrier_(chain_to(site_of(sensor).carrier)),
        to_turning_(chain_to(site_of(sensor).orientation)),
        per_m_(1.0 / settings.position_m),
        per_rad_(1.0 / (settings.orientation_deg * kRadiansPerDegree)) {}

  // Parameters: lengths, yaw, offset, a further turn of the mounting, place, missed.
  template <typename T>
  bool operator()(T const* const* x, T* residual) const {
    const Vector3<T> up(T(0.0), T(1.0), T(0.0));
    const Matrix3<T> R_world = rotation_of<T>(up * x[1][0]);
    Vector3<T> end = Vector3<T>::Zero(), last_bone = Vector3<T>::Zero();
    Matrix3<T> R = Matrix3<T>::Identity();
    for (const int j : to_carrier_) {
      R = R * turned_joint(j, x[5]);
      if (j > 0)
        last_bone = R * (directions().joint(j).bone.normalized().template cast<T>() * x[0][j - 1]);
      end += last_bone;
    }
    end += T(sensor_.position_along_bone - 1.0) * last_bone;
    Matrix3<T> R_turning = Matrix3<T>::Identity();
    for (const int j : to_turning_) R_turning = R_turning * turned_joint(j, x[5]);
    Eigen::Map<Vector3<T>> off(residual), turn(residual + 3);
    off.setZero();
    turn.setZero();
    if (held_.has_position)
      off = (R_world * (end + R_turning * Eigen::Map<const Vector3<T>>(x[2])) +
             Eigen::Map<const Vector3<T>>(x[4]) - held_.position.template cast<T>()) *
            T(per_m_);
    if (held_.has_orientation) {
      const Matrix3<T> predicted = R_world * R_turning * R_joint_sensor_.template cast<T>() *
                                   rotation_of<T>(Eigen::Map<const Vector3<T>>(x[3]));
      const Matrix3<T> between = held_.R_world_sensor.transpose().template cast<T>() * predicted;
      ceres::RotationMatrixToAngleAxis(between.data(), turn.data());
      turn *= T(per_rad_);
    }
    return true;
  }

 private:
  template <typename T>
  Matrix3<T> turned_joint(int j, const T* missed) const {
    return missed_rotation(shown_[static_cast<std::size_t>(j)], directions().joint(j),
                           missed + directions().angle_begin(j));
  }

  const Sensor& sensor_;
  const HeldSensor& held_;
  const JointRotations& shown_;
  Mat3 R_joint_sensor_;
  std::vector<int> to_carrier_, to_turning_;
  double per_m_, per_rad_;
};

ceres::CostFunction* normal_prior(const Eigen::MatrixXd& whitening, const Eigen::VectorXd& mean) {
  return new ceres::NormalPrior(whitening, mean);
}

ceres::CostFunction* normal_prior(Eigen::Index size, double deviation) {
  return normal_prior(Eigen::MatrixXd::Identity(size, size) / deviation,
                      Eigen::VectorXd::Zero(size));
}

const JointRotations& shown_in(const HeldPose& held) {
  return calibration_poses()[static_cast<std::size_t>(held.pose)].rotations;
}

void add_priors(const PoseProblem& problem, double imitation_rad, PoseUnknowns& x,
                std::vector<Vec3>& turns, ceres::Problem& out) {
  const Eigen::MatrixXd whitening = problem.lengths.covariance().llt().matrixL().solve(
      Eigen::MatrixXd::Identity(kNumBoneLengths, kNumBoneLengths));
  out.AddResidualBlock(normal_prior(whitening, problem.lengths.mean_m), nullptr,
                       x.lengths_m.data());
  out.AddResidualBlock(normal_prior(1, kYaw_rad), nullptr, &x.yaw_rad);
  for (std::size_t j = 0; j < problem.sensors.size(); ++j) {
    out.AddResidualBlock(normal_prior(3, problem.settings.offset_m), nullptr, x.offset_m[j].data());
    out.AddResidualBlock(normal_prior(3, kMounting_rad), nullptr, turns[j].data());
  }
  for (std::size_t i = 0; i < problem.held.size(); ++i) {
    out.AddResidualBlock(normal_prior(3, kPlace_m), nullptr, x.place_m[i].data());
    out.AddResidualBlock(normal_prior(x.missed[i].size(), imitation_rad), nullptr,
                         x.missed[i].data());
  }
}

void add_sensors(const PoseProblem& problem, PoseUnknowns& x, std::vector<Vec3>& turns,
                 ceres::Problem& out) {
  for (std::size_t i = 0; i < problem.held.size(); ++i)
    for (std::size_t j = 0; j < problem.sensors.size(); ++j) {
      const HeldSensor& held = problem.held[i].sensors[j];
      if (!held.has_position && !held.has_orientation) continue;
      auto* cost = new ceres::DynamicAutoDiffCostFunction<SensorResidual, 8>(
          new SensorResidual(problem.sensors[j], held, shown_in(problem.held[i]),
                             x.R_joint_sensor[j], problem.settings));
      for (const int size : {kNumBoneLengths, 1, 3, 3, 3, kNumStandardAngles})
        cost->AddParameterBlock(size);
      cost->SetNumResiduals(6);
      out.AddResidualBlock(
          cost, nullptr,
          std::vector<double*>{x.lengths_m.data(), &x.yaw_rad, x.offset_m[j].data(),
                               turns[j].data(), x.place_m[i].data(), x.missed[i].data()});
    }
}

std::vector<double*> blocks_of(PoseUnknowns& x, std::vector<Vec3>& turns) {
  std::vector<double*> blocks{x.lengths_m.data(), &x.yaw_rad};
  for (auto& offset : x.offset_m) blocks.push_back(offset.data());
  for (auto& turn : turns) blocks.push_back(turn.data());
  for (auto& place : x.place_m) blocks.push_back(place.data());
  for (auto& missed : x.missed) blocks.push_back(missed.data());
  return blocks;
}

// (J^T J)^-1 of all whitened residuals.
Eigen::MatrixXd covariance(ceres::Problem& problem, const std::vector<double*>& blocks) {
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = blocks;
  ceres::CRSMatrix sparse;
  problem.Evaluate(options, nullptr, nullptr, nullptr, &sparse);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
  for (int row = 0; row < sparse.num_rows; ++row)
    for (int k = sparse.rows[static_cast<std::size_t>(row)];
         k < sparse.rows[static_cast<std::size_t>(row) + 1]; ++k)
      jacobian(row, sparse.cols[static_cast<std::size_t>(k)]) =
          sparse.values[static_cast<std::size_t>(k)];
  const Eigen::MatrixXd information = jacobian.transpose() * jacobian;
  return information.llt().solve(Eigen::MatrixXd::Identity(sparse.num_cols, sparse.num_cols));
}

Mat3 mean_rotation(const Mat3& sum) {
  const Eigen::JacobiSVD<Mat3> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0.0) U.col(2) = -U.col(2);
  return U * svd.matrixV().transpose();
}

// The best mounting and places for a heading, and how badly they fit.
double fit_heading(const PoseProblem& problem, std::span<const JointTransforms> poses,
                   PoseUnknowns& x) {
  const double per_m2 = 1.0 / std::pow(problem.settings.offset_m, 2);
  const Mat3 R_world = yaw_rotation(x.yaw_rad);
  double cost = 0.0;
  std::vector<Vec3> sums(problem.held.size(), Vec3::Zero());
  for (std::size_t j = 0; j < problem.sensors.size(); ++j) {
    const auto turning = static_cast<std::size_t>(site_of(problem.sensors[j]).orientation);
    Mat3 sum = Mat3::Zero();
    for (std::size_t i = 0; i < problem.held.size(); ++i)
      if (problem.held[i].sensors[j].has_orientation)
        sum += (R_world * poses[i].R_world_joint[turning]).transpose() *
               problem.held[i].sensors[j].R_world_sensor;
    if (sum.isZero()) continue;
    x.R_joint_sensor[j] = mean_rotation(sum);
    for (std::size_t i = 0; i < problem.held.size(); ++i)
      if (problem.held[i].sensors[j].has_orientation)
        cost += (R_world * poses[i].R_world_joint[turning] * x.R_joint_sensor[j] -
                 problem.held[i].sensors[j].R_world_sensor)
                    .squaredNorm();
  }
  for (std::size_t i = 0; i < problem.held.size(); ++i) {
    std::vector<Vec3> off;
    for (std::size_t j = 0; j < problem.sensors.size(); ++j) {
      const auto carrier = static_cast<std::size_t>(site_of(problem.sensors[j]).carrier);
      if (problem.held[i].sensors[j].has_position)
        off.push_back(problem.held[i].sensors[j].position - R_world * poses[i].end[carrier]);
    }
    x.place_m[i].setZero();
    for (const Vec3& one : off) x.place_m[i] += one / static_cast<double>(off.size());
    for (const Vec3& one : off) cost += per_m2 * (one - x.place_m[i]).squaredNorm();
  }
  return cost;
}

}  // namespace

PoseUnknowns first_unknowns(const PoseProblem& problem) {
  constexpr int kHeadings = 36;
  const Skeleton mean = make_standard_skeleton(bones_of_lengths(problem.lengths.mean_m));
  std::vector<JointTransforms> poses(problem.held.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
    forward_kinematics(mean, Vec3::Zero(), shown_in(problem.held[i]), poses[i]);
  PoseUnknowns start;
  start.lengths_m = problem.lengths.mean_m;
  start.offset_m.assign(problem.sensors.size(), Vec3::Zero());
  for (const Sensor& sensor : problem.sensors)
    start.R_joint_sensor.push_back(site_of(sensor).R_joint_sensor);
  start.place_m.assign(poses.size(), Vec3::Zero());
  start.missed.assign(poses.size(), Eigen::VectorXd::Zero(kNumStandardAngles));
  PoseUnknowns best;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kHeadings; ++k) {
    start.yaw_rad = 2.0 * kPi * k / kHeadings;
    const double cost = fit_heading(problem, poses, start);
    if (cost >= least) continue;
    least = cost;
    best = start;
  }
  return best;
}

Eigen::MatrixXd solve_poses(const PoseProblem& problem, double imitation_rad, PoseUnknowns& x) {
  std::vector<Vec3> turns(problem.sensors.size(), Vec3::Zero());
  ceres::Problem equations;
  add_priors(problem, imitation_rad, x, turns, equations);
  add_sensors(problem, x, turns, equations);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = kMostIterations;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &equations, &summary);
  const Eigen::MatrixXd out = covariance(equations, blocks_of(x, turns));
  for (std::size_t j = 0; j < turns.size(); ++j)
    x.R_joint_sensor[j] = x.R_joint_sensor[j] * rotation_of<double>(turns[j]);
  return out;
}

JointRotations held_rotations(const JointRotations& shown, const Eigen::VectorXd& missed) {
  JointRotations out;
  for (int j = 0; j < kNumStandardJoints; ++j)
    out.push_back(missed_rotation(shown[static_cast<std::size_t>(j)], directions().joint(j),
                                  missed.data() + directions().angle_begin(j)));
  return out;
}

}  // namespace sparse_mocap::liu2011
