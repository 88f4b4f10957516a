// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/errors.hpp"

#include <pybind11/gil_safe_call_once.h>

#include <cerrno>
#include <system_error>

#include "common.hpp"
#include "sparse_mocap/retargeting/mapping_error.hpp"

namespace sparse_mocap::python {
namespace {

py::object& format_error_class() {
  static py::gil_safe_call_once_and_store<py::object> storage;
  return storage
      .call_once_and_store_result([] {
        return py::reinterpret_steal<py::object>(PyErr_NewExceptionWithDoc(
            "sparse_mocap._core.FormatError",
            "The input is at fault; str() is one line: where, what, what to do.", PyExc_ValueError,
            nullptr));
      })
      .get_stored();
}

void set_format_error(const FormatError& error) {
  const py::object instance = format_error_class()(text_of(error.what()));
  instance.attr("path") = text_of(error.location().path.string());
  instance.attr("line") = error.location().line;
  instance.attr("column") = error.location().column;
  PyErr_SetObject(format_error_class().ptr(), instance.ptr());
}

// The C library of this module need not be Python's, so that they share no errno, and the error may
// be one of the system's own instead.
void set_os_error(const std::filesystem::filesystem_error& error) {
  const std::error_condition condition = error.code().default_error_condition();
  const int number = condition.category() == std::generic_category() ? condition.value() : EIO;
  const py::object instance = py::reinterpret_borrow<py::object>(PyExc_OSError)(
      number, py::module_::import("os").attr("strerror")(number), py::str(py::cast(error.path1())));
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(instance.ptr())), instance.ptr());
}

}  // namespace

void bind_errors(py::module_& m) {
  py::object& format_error = format_error_class();
  format_error.attr("path") = "";
  format_error.attr("line") = 0;
  format_error.attr("column") = 0;
  m.attr("FormatError") = format_error;
  // NOLINTNEXTLINE(performance-unnecessary-value-param): pybind11 asks for this signature
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const FormatError& error) {
      set_format_error(error);
    } catch (const std::filesystem::filesystem_error& error) {
      set_os_error(error);
    }
  });
  py::register_exception<ConfigError>(m, "ConfigError", PyExc_ValueError).doc() =
      "A setting is outside what it may be; str() names it, its value and its range.";
  py::register_exception<MappingError>(m, "MappingError", PyExc_ValueError).doc() =
      "A skeleton is not recognised as a human body; str() says why.";
  py::register_exception<Cancelled>(m, "Cancelled").doc() = "The progress callback asked to stop.";
}

}  // namespace sparse_mocap::python
