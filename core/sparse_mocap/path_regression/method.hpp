// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/reconstruction/method_info.hpp"

namespace sparse_mocap::path_regression {

// The project's own method as the registry lists it. It began as Tautges et al. 2011 and departs
// from it in this:
// - Features: smoothed readings and how they change, in place of the reading itself; sensors on
//   legs count more; gravity directions of sensors with a gyroscope are searched as well.
// - Copies of the clips at other tempos are searched, too.
// - Paths: a reading counts less with each one after it, in place of a window of M readings; a
//   skipped reading costs less. In whole takes paths are followed in both directions.
// - Weights: a softmax of the rewards, in place of equation (1).
// - Retrieved poses are moved along a local ridge regression from readings to poses.
// - Energy: squared distances of points (joint ends and, so that twist counts, the tips of the
//   joints' axes) in place of square-rooted ones of angles and positions; no control term; the
//   movement since the frame before is the database's own step in place of a Taylor expansion; a
//   term for the inclination of limbs with a gyroscope; standing feet stay in place, and the root's
//   path and heading are part of the fit.
// - Minimisation: over joint rotations, not angles in a local subspace. Live one frame after the
//   other is fitted, those before it given; of whole takes all frames at once.
// - Numbers of neighbours and paths are limited by shares of the database.
MethodEntry method();

}  // namespace sparse_mocap::path_regression
