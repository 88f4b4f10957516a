// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "sparse_mocap/motion/skeleton.hpp"
#include "sparse_mocap/reconstruction/method.hpp"
#include "sparse_mocap/tautges2011/energy.hpp"

namespace sparse_mocap::tautges2011 {

// What sensors of the direction against gravity say of the limbs that carry them: how far a limb's
// end is above its beginning (m), squared errors. Beyond the paper, whose sensors have no
// gyroscope. Silent sensors, and those on trunk and head, take no part. num_paths: columns that the
// energy's weights ask for.
KernelTerm inclination_term(const Skeleton& skeleton, const Reading& reading,
                            const std::vector<WornSensor>& sensors, double weight,
                            Eigen::Index num_paths);

}  // namespace sparse_mocap::tautges2011
