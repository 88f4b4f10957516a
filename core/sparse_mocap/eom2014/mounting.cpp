// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/mounting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparse_mocap::eom2014 {
namespace {

constexpr int kMostCompared = 150;        // instants of a take
constexpr Eigen::Index kMostKnown = 450;  // readings of a model
constexpr int kWindow = 4;                // of what is compared, to both sides
constexpr double kCoarseStep_rad = 10.0 * kRadiansPerDegree;
constexpr double kFineStep_rad = 2.0 * kRadiansPerDegree;
constexpr double kBetter = 0.9;        // misfit by a turn, as a part of that without
constexpr double kOppositeSign = 0.7;  // by the opposite sign

// Every so many rows, so that about so many are left.
Eigen::MatrixXd thinned(const Eigen::MatrixXd& rows, Eigen::Index most) {
  const Eigen::Index by = std::max<Eigen::Index>(1, rows.rows() / most);
  Eigen::MatrixXd out((rows.rows() + by - 1) / by, rows.cols());
  for (Eigen::Index i = 0; i < out.rows(); ++i) out.row(i) = rows.row(i * by);
  return out;
}

class Comparison {
 public:
  Comparison(const ReadingRows& readings, const KnownReadings& known, int most_compared)
      : readings_(readings), scale_(known.scale), most_compared_(most_compared) {
    known_ = thinned(sequence_features(known.rows, known.begins, scale_, kWindow), kMostKnown);
  }

  double operator()(const Mat3& R_site_sensor) const {
    const Eigen::MatrixXd own =
        thinned(features(turned(readings_, R_site_sensor), scale_, kWindow), most_compared_);
    return squared_distances(own, known_).rowwise().minCoeff().cwiseSqrt().mean();
  }

 private:
  const ReadingRows& readings_;
  const ReadingScale& scale_;
  Eigen::Index most_compared_;
  Eigen::MatrixXd known_;
};

// The turn that brings readings nearest, with the sign that they have.
SensorTurn best_turn(const ReadingRows& readings, const KnownReadings& known, int most_compared) {
  const Comparison misfit(readings, known, most_compared);
  const Vec3 axis = known.scale.mean.head<3>().transpose().normalized();
  const Vec3 felt = readings.leftCols<3>().colwise().mean().transpose();
  const Mat3 upright = Quat::FromTwoVectors(felt, axis).toRotationMatrix();
  const auto turn_by = [&](double turn_rad) -> Mat3 {
    return Eigen::AngleAxisd(turn_rad, axis).toRotationMatrix() * upright;
  };
  SensorTurn best;
  best.misfit = std::numeric_limits<double>::infinity();
  const auto consider = [&](double turn_rad) {
    const double found = misfit(turn_by(turn_rad));
    if (found < best.misfit) best = {turn_by(turn_rad), turn_rad, false, found};
  };
  for (double turn = -kPi; turn < kPi; turn += kCoarseStep_rad) consider(turn);
  const double coarse = best.turn_rad;
  for (double by = -kCoarseStep_rad; by <= kCoarseStep_rad; by += kFineStep_rad)
    consider(coarse + by);
  const double unturned = misfit(Mat3::Identity());
  if (best.misfit > kBetter * unturned) return {Mat3::Identity(), 0.0, false, unturned};
  return best;
}

}  // namespace

double misfit_of(const ReadingRows& readings, const KnownReadings& known) {
  return Comparison(readings, known, kMostCompared)(Mat3::Identity());
}

ReadingRows SensorTurn::corrected(ReadingRows readings) const {
  if (is_negated) readings.leftCols<3>() *= -1.0;
  return turned(readings, R_site_sensor);
}

SensorTurn estimated_turn(const ReadingRows& readings, const KnownReadings& known,
                          int most_compared) {
  const SensorTurn as_it_is = best_turn(readings, known, most_compared);
  ReadingRows negated = readings;
  negated.leftCols<3>() *= -1.0;
  SensorTurn other = best_turn(negated, known, most_compared);
  other.is_negated = true;
  return other.misfit < kOppositeSign * as_it_is.misfit ? other : as_it_is;
}

}  // namespace sparse_mocap::eom2014
