// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "sparse_mocap/readings/reading.hpp"

namespace sparse_mocap::eom2014 {

// How fast a take's only sensor turns about the vertical (rad/s), however it sits on its limb. NaN
// where it does not say which way is up. Of accelerations with the opposite sign, the opposite.
double turning_rate(const Reading& reading);

// What a model says of how the body turns in each frame (rad/s), with the measured turning over a
// second and more in place of the model's: over a cycle the limb turns as the body does, within
// one it turns differently. Frames that were not measured (NaN) stay.
Eigen::VectorXd turned_as_measured(const Eigen::VectorXd& modelled, const Eigen::VectorXd& measured,
                                   double rate_hz);

}  // namespace sparse_mocap::eom2014
