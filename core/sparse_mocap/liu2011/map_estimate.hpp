// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sparse_mocap/liu2011/body_pose.hpp"
#include "sparse_mocap/liu2011/worn_sensors.hpp"

namespace sparse_mocap::liu2011 {

// How much what sensors say counts: equations (11) and (12).
struct ControlWeights {
  double sigma_position_m = 0.01;        // sigma_data of positions
  double sigma_orientation_rad = 0.035;  // and of orientations
  double robustness = 3.0;               // c: errors beyond c sigma_data count ever less
};

// The Lorentzian of equation (12) as a robust form of equation (11), of one residual r:
//   c^2 log(1 + |r|^2 / (2 c^2 sigma_data^2))
// which is |r|^2 / (2 sigma_data^2) for small r, and equation (12) with sigma = c sigma_data times
// c^2.
double robust_cost(double squared_norm, double sigma, double robustness);

// What is known of a pose before the sensors are asked: a normal distribution of its vector q about
// a reference pose, E_prior = |whitening q - target|^2 / 2. Equation (14) has one row a degree of
// freedom, 1 / sigma_d.
struct PosePrior {
  BodyPose reference;
  Eigen::MatrixXd whitening;
  Eigen::VectorXd target;
};

// E = E_control + E_prior of equation (10), and its Gauss-Newton equations for a step of the pose.
class PosteriorEnergy {
 public:
  // All must outlive the energy.
  PosteriorEnergy(const Skeleton& body, std::span<const Observation> observed,
                  const ControlWeights& weights, const PosePrior& prior)
      : body_(body), observed_(observed), weights_(weights), prior_(prior) {}

  struct Equations {
    double value = 0.0;
    Eigen::VectorXd gradient;  // d value / d step
    Eigen::MatrixXd hessian;   // Gauss-Newton, the Lorentzian by its weight at the pose
  };

  double control(const BodyPose& pose) const;  // equation (11), (12)
  double value(const BodyPose& pose) const;    // equation (10)
  Equations equations(const BodyPose& pose) const;

 private:
  void add_control(const BodyPose& pose, Equations& out) const;
  void add_prior(const BodyPose& pose, Equations& out) const;

  const Skeleton& body_;
  std::span<const Observation> observed_;
  const ControlWeights& weights_;
  const PosePrior& prior_;
};

struct Estimate {
  BodyPose pose;
  double value = 0.0;
  int iterations = 0;
};

// The pose of least energy near a start, by Levenberg-Marquardt.
Estimate nearest_minimum(const Skeleton& body, const PosteriorEnergy& energy, BodyPose start,
                         int max_iterations);

// Whether a control term is more than that of sensors that are all off by c sigma_data.
bool is_off_track(std::span<const Observation> observed, const ControlWeights& weights,
                  double control);

// The pose of section 6.3. The Lorentzian hardly pulls where sensors are far off, so if they still
// are at the minimum near the start, a wider one leads there as well; the lower minimum wins.
Estimate map_estimate(const Skeleton& body, std::span<const Observation> observed,
                      const ControlWeights& weights, const PosePrior& prior, const BodyPose& start,
                      int max_iterations);

}  // namespace sparse_mocap::liu2011
