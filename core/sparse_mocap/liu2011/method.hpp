// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/reconstruction/method_info.hpp"

namespace sparse_mocap::liu2011 {

// The method as the registry lists it. It departs from the paper in this:
// - The sensors' own distance counts in the search (preset paper: it does not).
// - Residuals of equation (8) go together, with their covariance, where positions are all that is
//   measured (preset paper: sigma_d alone).
// - Rotations are vectors about the mean of the examples, and the root is told in the heading frame
//   of the pose before, where the paper is silent.
// - The Lorentzian is scaled so that it is equation (11) for small errors, one term a sensor and
//   quantity.
// - Deviations of equation (8) have a floor, weights of equation (6) a scale.
// - The K closest examples are searched for exactly, which is as fast as the paper's graph.
MethodEntry method();

}  // namespace sparse_mocap::liu2011
