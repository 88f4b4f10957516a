// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/reconstruction/method_info.hpp"

namespace sparse_mocap::eom2014 {

// H. Eom, B. Choi, J. Noh: Data-Driven Reconstruction of Human Locomotion Using a Single
// Smartphone. Computer Graphics Forum 33 (2014). What the paper leaves open is settled so:
// - W has its best value in closed form, alpha_1 and beta_1 are 1, since W tells the scale, and
//   latent points have Lawrence's prior: without these equation 6 has no maximum.
// - Equation 7 without W. The root moves by the velocity process, given two latent points.
// - Phases come from the feet that leave the floor. Their hidden Markov models have three states,
//   from left to right.
// - Preset paper: perceptrons see one reading, as published. The default follows the likeliest path
//   through the training frames instead.
MethodEntry method();

}  // namespace sparse_mocap::eom2014
