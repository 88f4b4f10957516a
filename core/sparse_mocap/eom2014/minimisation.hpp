// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>

#include "sparse_mocap/base/progress.hpp"

namespace sparse_mocap::eom2014 {

// The value at a point, and into *gradient, unless that is null, how it changes. Not finite where
// there is no value.
using Function = std::function<double(const Eigen::VectorXd& at, Eigen::VectorXd* gradient)>;

// The minimum that L-BFGS reaches from a start. Reports each iteration as `what`. Throws Cancelled.
Eigen::VectorXd minimum(const Function& function, const Eigen::VectorXd& start, int max_iterations,
                        double tolerance, const Progress& progress, std::string_view what);

}  // namespace sparse_mocap::eom2014
