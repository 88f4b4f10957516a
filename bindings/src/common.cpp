// SPDX-License-Identifier: GPL-3.0-or-later
#include "common.hpp"

#include <utility>

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

}  // namespace sparse_mocap::python
