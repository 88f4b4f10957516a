// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/eigen.h>

#include <algorithm>

#include "common.hpp"
#include "sparse_mocap/database/clip_check.hpp"
#include "sparse_mocap/formats/mapping_file.hpp"
#include "sparse_mocap/retargeting/foot_lock.hpp"
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

  std::string ankle(std::size_t side) const {
    const int joint = found.joints.ankle[side];
    return joint < 0 ? "" : rig.joint(joint).name;
  }

  std::map<std::string, std::string> extremities() const {
    std::map<std::string, std::string> names;
    for (std::size_t e = 0; e < found.extremities.size(); ++e)
      if (const int joint = found.extremities[e].joint; joint >= 0)
        names.emplace(extremity_names()[e], rig.joint(joint).name);
    return names;
  }

  std::vector<std::string> turned() const {
    std::vector<std::string> names;
    for (const int joint : turned_joints(found)) names.push_back(rig.joint(joint).name);
    return names;
  }
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

// What lock_feet returns, as arrays: stands (T, 2) of true and false.
std::pair<Motion, py::array_t<bool>> with_locked_feet(
    const Mapping& mapping, const Motion& motion,
    const Eigen::Ref<const Eigen::MatrixX2d>& contacts, double strength, double ankle_height_m,
    double least_certainty, double fastest_mps, double highest_m) {
  require_same_skeleton(mapping, motion);
  LockedFeet locked;
  {
    const py::gil_scoped_release release;
    locked = lock_feet(motion, mapping.found, contacts.transpose(),
                       {strength, ankle_height_m, {least_certainty, fastest_mps, highest_m}});
  }
  const auto num_frames = static_cast<py::ssize_t>(motion.num_frames());
  py::array_t<bool> stands(std::vector<py::ssize_t>{num_frames, 2});
  std::fill(stands.mutable_data(), stands.mutable_data() + stands.size(), false);
  auto rows = stands.mutable_unchecked<2>();
  for (py::ssize_t side = 0; side < 2; ++side)
    for (const Stand& stand : locked.stands[static_cast<std::size_t>(side)])
      for (py::ssize_t t = stand.begin; t < stand.end; ++t) rows(t, side) = true;
  return {std::move(locked.motion), std::move(stands)};
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

std::vector<std::string> faults_of(const Mapping& mapping, const Motion& motion,
                                   const Motion& standard) {
  require_same_skeleton(mapping, motion);
  std::vector<std::string> lines;
  for (const ClipFault& fault : check_clip(motion, mapping.found, standard))
    lines.push_back(fault.text);
  return lines;
}

using release = py::call_guard<py::gil_scoped_release>;

void bind_mapping_class(py::module_& m) {
  py::class_<Mapping>(
      m, "SkeletonMapping",
      R"doc(How a rig and the standard skeleton of 21 joints correspond, for both directions.

A rig is any skeleton of a human body: of a motion file or of an animator's character.)doc")
      .def_property_readonly("joints", &Mapping::joints,
                             "The rig's joint for each standard joint that it has.")
      .def_property_readonly("extremities", &Mapping::extremities,
                             "The rig's joint for each of feet, toes and hands that it has.")
      .def_property_readonly("turned_joints", &Mapping::turned,
                             "The rig's joints that to_rig turns; the others keep their rest.")
      .def_property_readonly(
          "ankles",
          [](const Mapping& mapping) { return std::pair(mapping.ankle(0), mapping.ankle(1)); },
          "The rig's joints at which its left and right foot begin; empty where it has none.")
      .def_property_readonly(
          "is_by_names", [](const Mapping& mapping) { return mapping.found.joints.is_by_names; },
          "False where limbs were recognised by their shape.")
      .def_property_readonly(
          "unit_scale", [](const Mapping& mapping) { return mapping.found.unit_scale; },
          "The rig's lengths times this are metres.")
      .def_property_readonly(
          "R_world_file",
          [](const Mapping& mapping) {
            auto out = new_array({3, 3});
            auto R = out.mutable_unchecked<2>();
            for (int row = 0; row < 3; ++row)
              for (int column = 0; column < 3; ++column)
                R(row, column) = mapping.found.R_world_file(row, column);
            return out;
          },
          "(3, 3) rotation from the rig's world to one with y up.")
      .def_property_readonly(
          "warnings", [](const Mapping& mapping) { return mapping.found.warnings; },
          "What was guessed about the rig, one line each.")
      .def("to_standard", &mapped_to_standard, py::arg("motion"), py::arg("skeleton") = py::none(),
           release(), R"doc(Returns the rig's motion on a standard skeleton, and warnings.

skeleton: the standard skeleton to use; None: one of the rig's proportions. Limbs point
where the rig's do; root translation is scaled by the ratio of leg lengths. Raises
ValueError for a motion of a skeleton with other joints.)doc")
      .def("to_rig", &mapped_to_rig, py::arg("motion"), release(),
           R"doc(Returns a motion of the standard skeleton on the rig, the reverse of to_standard.

Limbs point where the standard's do; joints that map to nothing keep their rest; root
translation is scaled by the ratio of leg lengths. Raises ValueError for a motion that is
not on a standard skeleton.)doc")
      .def("lock_feet", &with_locked_feet, py::arg("motion"), py::arg("contacts"), py::kw_only(),
           py::arg("strength"), py::arg("ankle_height_m"), py::arg("least_certainty") = 0.5,
           py::arg("fastest_mps") = 0.5, py::arg("highest_m") = 0.06,
           R"doc(Returns the rig's motion with feet that stay where they stand, and when they do.

contacts (T, 2): how certain it is that the left and the right foot stand, 0 to 1; the
floor is at y = 0. A foot stands while it is certain enough, slower than fastest_mps and no
more than highest_m above ankle_height_m, where the ankle is while the foot is flat.
strength is from 0 to 1. The second result is (T, 2) bool. Raises ValueError for a motion
of a skeleton with other joints.)doc")
      .def(
          "limb_errors_rad", &errors_of, py::arg("motion"), py::arg("standard"), release(),
          R"doc(Returns the mean and worst angle between a motion's limbs and those of its transfer.

By the standard joint of each thigh, shank, upper arm and forearm, over all frames;
standard is what to_standard made of the motion. Raises ValueError for a motion of a
skeleton with other joints.)doc")
      .def("faults", &faults_of, py::arg("motion"), py::arg("standard"), release(),
           R"doc(Returns what makes a motion doubtful, one line each, the worst first.

Limbs that stray from the file's, a body that lies or stands on its head in every frame, sides
that are mixed up, speeds that are no person's; standard is what to_standard made of it.)doc");
}

void bind_mapping_functions(py::module_& m) {
  m.def("map_skeleton", &map_motion, py::arg("motion"), py::arg("by_hand") = JointNames(),
        release(), R"doc(Returns the mapping of a motion's skeleton, with the rest poses aligned.

by_hand: the skeleton's joint for some standard ones; the others are found by their names, then
by their shape. Raises MappingError when it is not a human body.)doc");
  m.def(
      "standard_motion",
      [](const Motion& motion, const std::optional<Skeleton>& skeleton, const JointNames& by_hand) {
        return mapped_to_standard(map_motion(motion, by_hand), motion, skeleton);
      },
      py::arg("motion"), py::arg("skeleton") = py::none(), py::arg("by_hand") = JointNames(),
      release(), "Returns what map_skeleton and then to_standard return. Raises MappingError.");
  m.def("with_extremities", py::overload_cast<const Skeleton&>(&with_extremities),
        py::arg("skeleton"),
        R"doc(A standard skeleton with feet, toes and hands after its 21 joints.

Raises ValueError for another skeleton.)doc");
  m.def(
      "standard_joint_names",
      [] {
        return std::vector<std::string>(standard_joint_names().begin(),
                                        standard_joint_names().end());
      },
      "Returns the standard skeleton's 21 joints, the root first.");
}

void bind_mapping_files(py::module_& m) {
  m.def("read_mapping", &read_mapping, py::arg("path"),
        "Returns a file's mapping by hand, from standard joints to a rig's. Raises FormatError.");
  m.def("write_mapping", &write_mapping, py::arg("path"), py::arg("joints"),
        "Writes a mapping by hand atomically. Raises OSError.");
  m.def(
      "remembered_mapping", &remembered_mapping, py::arg("folder"), py::arg("skeleton"),
      R"doc(Returns the mapping by hand that a folder holds for a skeleton; empty when there is none.

Raises FormatError when its file cannot be read.)doc");
  m.def(
      "remembered_mapping_path", &remembered_mapping_path, py::arg("folder"), py::arg("skeleton"),
      "Returns where a folder holds the mapping of a skeleton, named after the skeleton's joints.");
}

}  // namespace

void bind_retargeting(py::module_& m) {
  bind_mapping_class(m);
  bind_mapping_functions(m);
  bind_mapping_files(m);
}

}  // namespace sparse_mocap::python
