// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/reconstruction/method_info.hpp"

namespace sparse_mocap::tautges2011 {

// The method as the registry lists it.
MethodEntry method();

}  // namespace sparse_mocap::tautges2011
