// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common.hpp"

namespace sparse_mocap::python {

// What methods there are, what a reconstruction asks of one, and how one is trained.
void bind_methods(py::module_& m);

}  // namespace sparse_mocap::python
