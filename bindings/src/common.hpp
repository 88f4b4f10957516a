// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/stl/filesystem.h>

#include <optional>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "sparse_mocap/base/progress.hpp"
#include "sparse_mocap/motion/motion.hpp"

namespace sparse_mocap::python {

// One function a file, each binds one concept.
void bind_errors(py::module_& m);
void bind_motion(py::module_& m);
void bind_body(py::module_& m);
void bind_retargeting(py::module_& m);
void bind_sensors(py::module_& m);
void bind_streams(py::module_& m);
void bind_calibration(py::module_& m);
void bind_pose_calibration(py::module_& m);
void bind_timing(py::module_& m);
void bind_rotations(py::module_& m);
void bind_readings(py::module_& m);
void bind_model(py::module_& m);
void bind_database(py::module_& m);
void bind_database_import(py::module_& m);
void bind_baselines(py::module_& m);
void bind_reconstruction(py::module_& m);

// The text with what is not UTF-8 replaced, as in names of files that are older than it.
py::str text_of(const std::string& text);

// Calls back into Python with the GIL; None goes on, False cancels. details gets the whole report,
// before callback is called.
Progress progress_from(const std::optional<py::function>& callback,
                       const std::optional<py::function>& details = std::nullopt);

}  // namespace sparse_mocap::python
