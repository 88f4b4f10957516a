// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <optional>
#include <string>
#include <vector>

#include "sparse_mocap/base/progress.hpp"
#include "sparse_mocap/motion/motion.hpp"
#include "sparse_mocap/reconstruction/method.hpp"

namespace sparse_mocap::python {

namespace py = pybind11;

// One function a file, each binds one concept.
void bind_errors(py::module_& m);
void bind_motion(py::module_& m);
void bind_retargeting(py::module_& m);
void bind_sensors(py::module_& m);
void bind_streams(py::module_& m);
void bind_calibration(py::module_& m);
void bind_timing(py::module_& m);
void bind_database(py::module_& m);
void bind_database_import(py::module_& m);
void bind_reconstruction(py::module_& m);

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

// Throws ValueError naming what was expected (-1: any length) and what came.
void require_shape(const Doubles& array, const std::vector<py::ssize_t>& expected,
                   const char* name);

// The text with what is not UTF-8 replaced, as in names of files that are older than it.
py::str text_of(const std::string& text);

// A new array of this shape.
py::array_t<double> new_array(const std::vector<py::ssize_t>& shape);

// Calls back into Python with the GIL; None goes on, False cancels. details gets the whole report,
// before callback is called.
Progress progress_from(const std::optional<py::function>& callback,
                       const std::optional<py::function>& details = std::nullopt);

// Readings (T, S, 3) as the core takes them.
std::vector<Reading> readings_from(const Doubles& specific_force, std::size_t num_sensors);

// places and quantities ("specific_force" or "up") have one entry a site, when they are given.
std::vector<WornSensor> sensors_from(
    const std::vector<std::string>& sites, const std::optional<std::vector<double>>& places,
    const std::optional<std::vector<std::string>>& quantities = std::nullopt);

}  // namespace sparse_mocap::python
