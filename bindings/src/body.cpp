// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/body.hpp"

#include "common.hpp"

namespace sparse_mocap::python {
namespace {

Body make_body(const Doubles& bones, const std::string& performer) {
  require_shape(bones, {kNumStandardJoints, 3}, "bones");
  const auto rows = bones.unchecked<2>();
  Body body{performer, {}};
  for (py::ssize_t j = 0; j < kNumStandardJoints; ++j)
    body.bones[static_cast<std::size_t>(j)] = {rows(j, 0), rows(j, 1), rows(j, 2)};
  check_body(body);
  return body;
}

py::array_t<double> bones_array(const Body& body) {
  auto out = new_array({kNumStandardJoints, 3});
  auto rows = out.mutable_unchecked<2>();
  for (py::ssize_t j = 0; j < kNumStandardJoints; ++j)
    for (int k = 0; k < 3; ++k) rows(j, k) = body.bones[static_cast<std::size_t>(j)][k];
  return out;
}

}  // namespace

void bind_body(py::module_& m) {
  py::class_<Body>(m, "Body",
                   "The body of a performer: a standard skeleton of their proportions. Immutable.")
      .def(py::init(&make_body), py::arg("bones"), py::arg("performer") = "",
           "Takes bones as below. Raises ConfigError for lengths that nobody has.")
      .def_readonly("performer", &Body::performer, "A name, may be empty.")
      .def_property_readonly("bones", &bones_array,
                             "(21, 3) m, from pivot to end of each standard joint in rest pose.")
      .def_property_readonly("skeleton", &Body::skeleton, "The standard skeleton with these bones.")
      .def_property_readonly(
          "height_m", [](const Body& body) { return standing_height_m(body.bones); },
          "How tall somebody with these bones stands, sole to crown.");
  m.def("body_of_height", &body_of_height, py::arg("height_m"),
        "A medium body scaled to a standing height. Raises ConfigError unless it is 0.5 to 2.5 m.");
}

}  // namespace sparse_mocap::python
