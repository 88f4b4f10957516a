// SPDX-License-Identifier: GPL-3.0-or-later
#include "common.hpp"
#include "sparse_mocap/formats/mapping_file.hpp"
#include "sparse_mocap/retargeting/limb_errors.hpp"
#include "sparse_mocap/retargeting/to_rig.hpp"
#include "sparse_mocap/retargeting/to_standard.hpp"

namespace sparse_mocap::python {
namespace {

// A mapping and the rig that it was found for.
struct Mapping {
  Skeleton rig;
  SkeletonMapping found;

  JointNames joints() const { return mapped_joint_names(rig, found); }
};

Mapping map_motion(const Motion& motion, const JointNames& by_hand) {
  return {motion.skeleton, map_skeleton(motion, by_hand)};
}

// A mapping holds indices into its skeleton.
void require_same_skeleton(const Mapping& mapping, const Motion& motion) {
  const auto is_same = [](const Joint& a, const Joint& b) {
    return a.name == b.name && a.parent == b.parent;
  };
  if (!std::equal(mapping.rig.joints().begin(), mapping.rig.joints().end(),
                  motion.skeleton.joints().begin(), motion.skeleton.joints().end(), is_same))
    throw std::invalid_argument("the mapping was found for a skeleton with other joints");
}

std::pair<Motion, std::vector<std::string>> mapped_to_standard(
    const Mapping& mapping, const Motion& motion, const std::optional<Skeleton>& skeleton) {
  require_same_skeleton(mapping, motion);
  std::vector<std::string> warnings = mapping.found.warnings;
  const Skeleton target = skeleton ? *skeleton : make_standard_skeleton(mapping.found.bones);
  Motion out = to_standard(motion, mapping.found, target, &warnings);
  return {std::move(out), std::move(warnings)};
}

Motion mapped_to_rig(const Mapping& mapping, const Motion& standard_motion) {
  return to_rig(standard_motion, mapping.found, mapping.rig);
}

std::map<std::string, std::pair<double, double>> errors_of(const Mapping& mapping,
                                                           const Motion& motion,
                                                           const Motion& standard) {
  require_same_skeleton(mapping, motion);
  const LimbErrors errors = limb_errors(motion, mapping.found, standard);
  std::map<std::string, std::pair<double, double>> out;
  for (std::size_t i = 0; i < kLimbBones.size(); ++i)
    out[std::string(standard_joint_names()[kLimbBones[i]])] = {errors.mean_rad[i],
                                                               errors.worst_rad[i]};
  return out;
}

}  // namespace

void bind_retargeting(py::module_& m) {
  using release = py::call_guard<py::gil_scoped_release>;
  py::class_<Mapping>(m, "SkeletonMapping")
      .def_property_readonly("joints", &Mapping::joints)
      .def_property_readonly(
          "is_by_names", [](const Mapping& mapping) { return mapping.found.joints.is_by_names; })
      .def_property_readonly("unit_scale",
                             [](const Mapping& mapping) { return mapping.found.unit_scale; })
      .def_property_readonly("R_world_file",
                             [](const Mapping& mapping) {
                               auto out = new_array({3, 3});
                               auto R = out.mutable_unchecked<2>();
                               for (int row = 0; row < 3; ++row)
                                 for (int column = 0; column < 3; ++column)
                                   R(row, column) = mapping.found.R_world_file(row, column);
                               return out;
                             })
      .def_property_readonly("warnings",
                             [](const Mapping& mapping) { return mapping.found.warnings; })
      .def("to_standard", &mapped_to_standard, py::arg("motion"), py::arg("skeleton") = py::none(),
           release())
      .def("to_rig", &mapped_to_rig, py::arg("motion"), release())
      .def("limb_errors_rad", &errors_of, py::arg("motion"), py::arg("standard"), release());
  m.def("map_skeleton", &map_motion, py::arg("motion"), py::arg("by_hand") = JointNames(),
        release());
  m.def(
      "standard_motion",
      [](const Motion& motion, const std::optional<Skeleton>& skeleton, const JointNames& by_hand) {
        return mapped_to_standard(map_motion(motion, by_hand), motion, skeleton);
      },
      py::arg("motion"), py::arg("skeleton") = py::none(), py::arg("by_hand") = JointNames(),
      release());
  m.def("standard_joint_names", [] {
    return std::vector<std::string>(standard_joint_names().begin(), standard_joint_names().end());
  });
  m.def("read_mapping", &read_mapping, py::arg("path"));
  m.def("write_mapping", &write_mapping, py::arg("path"), py::arg("joints"));
  m.def("remembered_mapping", &remembered_mapping, py::arg("folder"), py::arg("skeleton"));
  m.def("remembered_mapping_path", &remembered_mapping_path, py::arg("folder"),
        py::arg("skeleton"));
}

}  // namespace sparse_mocap::python
