// SPDX-License-Identifier: GPL-3.0-or-later
#include "common.hpp"

#include <utility>

#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::python {

py::str text_of(const std::string& text) {
  PyObject* decoded =
      PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace");
  if (decoded == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

Progress progress_from(const std::optional<py::function>& callback,
                       const std::optional<py::function>& details) {
  return Progress([callback, details](const ProgressReport& report) {
    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (details) (*details)(report);
    if (!callback) return true;
    const py::object answer =
        (*callback)(report.done, report.total, text_of(std::string(report.what)));
    return answer.is_none() || answer.cast<bool>();
  });
}

std::vector<Reading> readings_from(const Doubles& specific_force, std::size_t num_sensors) {
  require_shape(specific_force, {-1, static_cast<py::ssize_t>(num_sensors), 3}, "specific_force");
  const auto values = specific_force.unchecked<3>();
  std::vector<Reading> take;
  for (py::ssize_t t = 0; t < values.shape(0); ++t) {
    Reading reading(3, values.shape(1));
    for (py::ssize_t s = 0; s < values.shape(1); ++s)
      for (py::ssize_t k = 0; k < 3; ++k) reading(k, s) = values(t, s, k);
    take.push_back(std::move(reading));
  }
  return take;
}

std::vector<WornSensor> sensors_from(const std::vector<std::string>& sites,
                                     const std::optional<std::vector<double>>& places,
                                     const std::optional<std::vector<std::string>>& quantities) {
  if (places && places->size() != sites.size())
    throw py::value_error("places must have one entry a site");
  if (quantities && quantities->size() != sites.size())
    throw py::value_error("quantities must have one entry a site");
  std::vector<WornSensor> sensors;
  for (std::size_t s = 0; s < sites.size(); ++s) {
    const std::string quantity = quantities ? (*quantities)[s] : "specific_force";
    if (quantity != "specific_force" && quantity != "up")
      throw py::value_error("a quantity is 'specific_force' or 'up', not '" + quantity + "'");
    sensors.push_back({find_site(sites[s]), places ? (*places)[s] : 1.0,
                       quantity == "up" ? Quantity::up : Quantity::specific_force});
  }
  return sensors;
}

}  // namespace sparse_mocap::python
