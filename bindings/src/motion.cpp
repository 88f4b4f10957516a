// SPDX-License-Identifier: GPL-3.0-or-later
#include "common.hpp"
#include "sparse_mocap/base/text_scanner.hpp"
#include "sparse_mocap/formats/acclaim_writer.hpp"
#include "sparse_mocap/formats/bvh.hpp"
#include "sparse_mocap/formats/motion_file.hpp"
#include "sparse_mocap/motion/extremities.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap::python {
namespace {

py::array_t<double> vectors(const Skeleton& skeleton, Vec3 Joint::*member) {
  auto out = new_array({skeleton.num_joints(), 3});
  auto rows = out.mutable_unchecked<2>();
  for (int j = 0; j < skeleton.num_joints(); ++j)
    for (int k = 0; k < 3; ++k) rows(j, k) = (skeleton.joint(j).*member)[k];
  return out;
}

py::array_t<double> root_positions(const Motion& motion) {
  auto out = new_array({motion.num_frames(), 3});
  auto rows = out.mutable_unchecked<2>();
  for (int t = 0; t < motion.num_frames(); ++t)
    for (int k = 0; k < 3; ++k) rows(t, k) = motion.root_positions[static_cast<std::size_t>(t)][k];
  return out;
}

py::array_t<double> rotations(const Motion& motion) {
  auto out = new_array({motion.num_frames(), motion.skeleton.num_joints(), 4});
  auto rows = out.mutable_unchecked<3>();
  for (int t = 0; t < motion.num_frames(); ++t) {
    for (int j = 0; j < motion.skeleton.num_joints(); ++j) {
      const Quat& q = motion.rotation(t, j);
      rows(t, j, 0) = q.w();
      rows(t, j, 1) = q.x();
      rows(t, j, 2) = q.y();
      rows(t, j, 3) = q.z();
    }
  }
  return out;
}

py::array_t<double> angles_of(const Skeleton& skeleton, const Doubles& joint_rotations,
                              const std::optional<Doubles>& reference) {
  require_shape(joint_rotations, {-1, skeleton.num_joints(), 4}, "rotations");
  const py::ssize_t frames = joint_rotations.shape(0);
  if (reference) require_shape(*reference, {frames, skeleton.num_angles()}, "reference");
  auto out = new_array({frames, skeleton.num_angles()});
  const double* q = joint_rotations.data();
  for (py::ssize_t t = 0; t < frames; ++t) {
    double* angles = out.mutable_data(t, 0);
    const double* near = reference ? reference->data(t, 0) : nullptr;
    for (int j = 0; j < skeleton.num_joints(); ++j, q += 4) {
      const int begin = skeleton.angle_begin(j);
      joint_angles(skeleton.joint(j), Quat(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix(),
                   near == nullptr ? nullptr : near + begin, angles + begin);
    }
  }
  return out;
}

// The joints that the file moves besides the root, and where to.
std::vector<std::pair<int, py::array_t<double>>> offset_tracks(const Motion& motion) {
  std::vector<std::pair<int, py::array_t<double>>> tracks;
  for (const auto& track : motion.offset_tracks) {
    auto out = new_array({motion.num_frames(), 3});
    auto rows = out.mutable_unchecked<2>();
    for (int t = 0; t < motion.num_frames(); ++t)
      for (int k = 0; k < 3; ++k) rows(t, k) = track.offset_parent[static_cast<std::size_t>(t)][k];
    tracks.emplace_back(track.joint, std::move(out));
  }
  return tracks;
}

Motion make_motion(const Skeleton& skeleton, double frame_time_s, const Doubles& positions,
                   const Doubles& joint_rotations) {
  const py::ssize_t frames = positions.ndim() > 0 ? positions.shape(0) : 0;
  require_shape(positions, {-1, 3}, "root_positions");
  require_shape(joint_rotations, {frames, skeleton.num_joints(), 4}, "rotations");
  if (!(frame_time_s > 0.0)) throw py::value_error("frame_time_s must be positive");
  Motion motion;
  motion.skeleton = skeleton;
  motion.frame_time_s = frame_time_s;
  const auto p = positions.unchecked<2>();
  const auto q = joint_rotations.unchecked<3>();
  for (py::ssize_t t = 0; t < frames; ++t) {
    motion.root_positions.emplace_back(p(t, 0), p(t, 1), p(t, 2));
    for (py::ssize_t j = 0; j < q.shape(1); ++j)
      motion.rotations.push_back(Quat(q(t, j, 0), q(t, j, 1), q(t, j, 2), q(t, j, 3)).normalized());
  }
  return motion;
}

// Of where the joints turn and end in rest pose.
Skeleton skeleton_at_rest(const std::vector<std::string>& names, const std::vector<int>& parents,
                          const Doubles& pivots, const Doubles& ends) {
  const auto num_joints = static_cast<py::ssize_t>(names.size());
  if (parents.size() != names.size()) throw py::value_error("parents must be one for each name");
  require_shape(pivots, {num_joints, 3}, "pivots");
  require_shape(ends, {num_joints, 3}, "ends");
  const auto p = pivots.unchecked<2>();
  const auto e = ends.unchecked<2>();
  std::vector<Joint> joints(names.size());
  for (py::ssize_t j = 0; j < num_joints; ++j) {
    Joint& joint = joints[static_cast<std::size_t>(j)];
    joint.name = names[static_cast<std::size_t>(j)];
    joint.parent = parents[static_cast<std::size_t>(j)];
    joint.axes = {Axis::z, Axis::x, Axis::y};
    const Vec3 pivot(p(j, 0), p(j, 1), p(j, 2));
    joint.bone = Vec3(e(j, 0), e(j, 1), e(j, 2)) - pivot;
    const auto q = static_cast<py::ssize_t>(joint.parent);
    if (q >= 0 && q < j) joint.offset_parent = pivot - Vec3(e(q, 0), e(q, 1), e(q, 2));
  }
  return Skeleton(std::move(joints));
}

PositionFrame frame_named(const std::string& name) {
  if (name == "heading") return PositionFrame::heading;
  if (name == "root") return PositionFrame::root;
  if (name == "world") return PositionFrame::world;
  throw py::value_error("frame must be heading, root or world, got '" + name + "'");
}

py::array_t<double> positions_of(const Motion& motion, const std::string& frame_name) {
  const PositionFrame frame = frame_named(frame_name);
  if (frame == PositionFrame::heading && !has_extremities(motion.skeleton) &&
      motion.skeleton.num_joints() != kNumStandardJoints)
    throw py::value_error("the heading frame needs a motion on the standard skeleton");
  Eigen::MatrixXd columns;
  {
    const py::gil_scoped_release release;
    columns = joint_positions(motion, frame);
  }
  // Column-major 3J x T is row-major T x J x 3.
  auto out = new_array({motion.num_frames(), motion.skeleton.num_joints(), 3});
  std::copy(columns.data(), columns.data() + columns.size(), out.mutable_data());
  return out;
}

Axis axis_named(const std::string& name) {
  if (name == "x") return Axis::x;
  if (name == "y") return Axis::y;
  if (name == "z") return Axis::z;
  throw py::value_error("up must be x, y or z, got '" + name + "'");
}

// A reader written in Python gives the motion and its warnings, as read_motion does. The function
// is shared, since threads that do not hold the GIL copy the options.
FurtherReader reader_from(const py::function& function) {
  const auto shared = std::make_shared<py::function>(function);
  return [shared](const std::filesystem::path& path, const ReadOptions&) {
    const py::gil_scoped_acquire acquire;
    try {
      auto [motion, texts] = (*shared)(path).cast<std::pair<Motion, std::vector<std::string>>>();
      MotionFile file{std::move(motion), {}};
      for (const auto& text : texts) file.warnings.push_back({{path}, text});
      return file;
    } catch (const py::error_already_set& error) {
      const std::string begin = path.string() + ": ";
      std::string text = py::str(error.value()).cast<std::string>();
      if (text.starts_with(begin)) text.erase(0, begin.size());
      throw FormatError({path}, text);
    }
  };
}

ReadOptions read_options(double amc_rate_hz, std::optional<double> unit_m, const std::string& up,
                         const std::optional<std::filesystem::path>& asf, bool allow_no_frames,
                         std::optional<double> rate_hz,
                         const std::map<std::string, py::function>& further_readers) {
  ReadOptions options;
  options.amc_rate_hz = amc_rate_hz;
  options.unit_m = unit_m;
  options.up = axis_named(up);
  options.asf = asf.value_or(std::filesystem::path());
  options.allow_no_frames = allow_no_frames;
  options.rate_hz = rate_hz;
  for (const auto& [ending, function] : further_readers)
    options.further_readers.emplace(ending, reader_from(function));
  options.validate();
  return options;
}

std::pair<Motion, std::vector<std::string>> read_motion(const std::filesystem::path& path,
                                                        const ReadOptions& options) {
  MotionFile file = read_motion_file(path, options);
  std::vector<std::string> warnings;
  for (const auto& warning : file.warnings) warnings.push_back(warning.message());
  return {std::move(file.motion), std::move(warnings)};
}

py::array_t<double> pivots_of(const Motion& motion) {
  auto out = new_array({motion.num_frames(), motion.skeleton.num_joints(), 3});
  auto cells = out.mutable_unchecked<3>();
  for (int t = 0; t < motion.num_frames(); ++t) {
    const JointTransforms transforms = motion.transforms(t);
    for (int j = 0; j < motion.skeleton.num_joints(); ++j)
      for (int k = 0; k < 3; ++k) cells(t, j, k) = transforms.pivot[static_cast<std::size_t>(j)][k];
  }
  return out;
}

void bind_skeleton(py::module_& m) {
  py::class_<Skeleton>(
      m, "Skeleton",
      "A joint tree: pivot = end_parent + R_parent offset, end = pivot + R_joint bone.")
      .def(py::init(&skeleton_at_rest), py::arg("names"), py::arg("parents"), py::arg("pivots"),
           py::arg("ends"),
           R"doc(pivots and ends (J, 3) m: where the joints turn and end in rest pose, in the world.

parents (J,) are smaller than their joint's own index, -1 for the first. Raises ValueError
when they are not, or a name is repeated.)doc")
      .def_property_readonly(
          "names",
          [](const Skeleton& s) {
            std::vector<std::string> names;
            for (const auto& joint : s.joints()) names.push_back(joint.name);
            return names;
          },
          "The J joints' names, the root first.")
      .def_property_readonly(
          "parents",
          [](const Skeleton& s) {
            std::vector<int> parents;
            for (const auto& joint : s.joints()) parents.push_back(joint.parent);
            return parents;
          },
          "(J,) index of each joint's parent, smaller than its own; -1 for the root.")
      .def_property_readonly(
          "offsets", [](const Skeleton& s) { return vectors(s, &Joint::offset_parent); },
          "(J, 3) m, from the parent's end to the pivot, in the parent's frame.")
      .def_property_readonly(
          "bones", [](const Skeleton& s) { return vectors(s, &Joint::bone); },
          "(J, 3) m, from pivot to end, in the joint's frame (the world's in rest pose).")
      .def("angles", &angles_of, py::arg("rotations"), py::arg("reference") = py::none(),
           R"doc(Returns the angles (T, A) rad that turn the joints by rotations (T, J, 4) w x y z.

Of angles that mean the same rotation these are the nearest to reference (T, A), by default
0. Raises ValueError for other shapes.)doc");
}

void bind_motion_class(py::module_& m) {
  using release = py::call_guard<py::gil_scoped_release>;
  py::class_<Motion>(m, "Motion", "What a skeleton does, sampled evenly.")
      .def(py::init(&make_motion), py::arg("skeleton"), py::arg("frame_time_s"),
           py::arg("root_positions"), py::arg("rotations"),
           "root_positions (T, 3) m; rotations (T, J, 4) w x y z, relative to the parent.")
      .def_property_readonly(
          "skeleton", [](const Motion& motion) { return motion.skeleton; }, "A copy of it.")
      .def_readonly("frame_time_s", &Motion::frame_time_s, "From one frame to the next.")
      .def_property_readonly("num_frames", &Motion::num_frames, "T.")
      .def_property_readonly("root_positions", &root_positions,
                             "(T, 3) m, world, pivot of the root.")
      .def_property_readonly("rotations", &rotations,
                             "(T, J, 4) rotation of each joint relative to its parent, w x y z.")
      .def_property_readonly(
          "offset_tracks", &offset_tracks,
          "Joints that the file moves besides the root, and (T, 3) m their offset in every frame.")
      .def("joint_positions", &positions_of, py::arg("frame") = "world",
           "(T, J, 3) m, the joints' ends; frame: 'heading' (standard skeleton), 'root', 'world'.")
      .def("pivot_positions", &pivots_of, "(T, J, 3) m, world, what the joints turn about.")
      .def(
          "without_extremities", [](const Motion& motion) { return without_extremities(motion); },
          "The motion of the 21 standard joints alone; one of another skeleton as it is.")
      .def("resampled", &resampled, py::arg("rate_hz"), release(),
           R"doc(The motion sampled at a new rate: rotations by slerp, positions by interpolation.

A zero-phase Gaussian low-pass comes first where the rate goes down.)doc")
      .def("trimmed", &trimmed, py::arg("begin"), py::arg("end"), "The frames [begin, end).")
      .def("reversed", &reversed, "The same movement played backwards.")
      .def(
          "mirrored",
          [](const Motion& motion) { return mirrored(motion, left_right_pairs(motion.skeleton)); },
          "The movement seen in a mirror at x = 0: left and right joints change places.");
}

void bind_motion_files(py::module_& m) {
  using release = py::call_guard<py::gil_scoped_release>;
  py::class_<ReadOptions>(m, "ReadOptions", R"doc(What motion files do not say of themselves.

amc_rate_hz: frames per second of .amc files; unit_m: metres a unit of the file (None: what an .asf
says, 0.01 for .bvh); up: the file's up axis, what is read has y up; asf: the skeleton of .amc files
(None: the one found beside each); allow_no_frames: a skeleton alone, also an .asf, is a motion
without frames; rate_hz: the rate whatever the file says; further_readers: functions that read files
of other endings and return the motion and warnings.)doc")
      .def(py::init(&read_options), py::kw_only(), py::arg("amc_rate_hz") = 120.0,
           py::arg("unit_m") = py::none(), py::arg("up") = "y", py::arg("asf") = py::none(),
           py::arg("allow_no_frames") = false, py::arg("rate_hz") = py::none(),
           py::arg("further_readers") = std::map<std::string, py::function>(),
           "Raises ConfigError naming what is out of its range.");
  m.def("read_motion", &read_motion, py::arg("path"), py::arg("options") = ReadOptions(), release(),
        R"doc(The file's motion on its own skeleton, and warnings. Raises FormatError.)doc");
  m.def("write_bvh", &write_bvh, py::arg("path"), py::arg("motion"), release(),
        "Writes atomically, in centimetres.");
  m.def(
      "write_acclaim", &write_acclaim, py::arg("path"), py::arg("motion"), release(),
      R"doc(Writes path (.amc) and the skeleton beside it (.asf), each atomically, in inches / 0.45.

Offsets of joints become fixed bones. Raises FormatError for what Acclaim cannot hold.)doc");
}

}  // namespace

void bind_motion(py::module_& m) {
  bind_skeleton(m);
  bind_motion_class(m);
  bind_motion_files(m);
}

}  // namespace sparse_mocap::python
