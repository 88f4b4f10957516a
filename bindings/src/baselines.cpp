// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/methods/baselines.hpp"

#include "common.hpp"
#include "readings.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap::python {
namespace {

using Database = std::shared_ptr<MotionDatabase>;

// Runs work, which must not touch Python, and gives its result to NumPy.
template <typename Work>
py::array_t<std::int64_t> without_gil(const Work& work) {
  std::vector<int> values;
  {
    const py::gil_scoped_release release;
    values = work();
  }
  py::array_t<std::int64_t> out(static_cast<py::ssize_t>(values.size()));
  std::copy(values.begin(), values.end(), out.mutable_data());
  return out;
}

}  // namespace

void bind_baselines(py::module_& m) {
  m.def(
      "playback_best_path",
      [](const Database& database, const Readings& take, const std::vector<int>& excluded_clips) {
        return without_gil([&] {
          return playback_best_path(*database, take.sensors, take.readings, excluded_clips);
        });
      },
      py::arg("database"), py::arg("take"), py::arg("excluded_clips") = std::vector<int>{},
      R"doc(Returns for each of T readings the database frame at the end of the best path, (T,).

A baseline that plays back the database: the paths are those of the online lazy neighbourhood
graph. excluded_clips, by index, and copies at other tempos are not used.)doc");
  m.def(
      "nearest_windows",
      [](const Database& database, const Readings& take, int window,
         const std::vector<int>& excluded_clips) {
        return without_gil([&] {
          return nearest_windows(*database, take.sensors, take.readings, window, excluded_clips);
        });
      },
      py::arg("database"), py::arg("take"), py::arg("window") = 10,
      py::arg("excluded_clips") = std::vector<int>{},
      R"doc(Returns for each of T readings the database frame whose past readings are nearest, (T,).

A baseline after an idea of Slyper and Hodgins 2008; compares the last `window` readings.
excluded_clips, by index, and copies at other tempos are not used.)doc");
  m.def(
      "nearest_poses",
      [](const Database& database, const Doubles& positions,
         const std::vector<int>& excluded_clips) {
        require_shape(positions, {-1, kNumStandardJoints, 3}, "positions");
        const Eigen::MatrixXd columns = Eigen::Map<const Eigen::MatrixXd>(
            positions.data(), 3 * kNumStandardJoints, positions.shape(0));
        return without_gil([&] { return nearest_poses(*database, columns, excluded_clips); });
      },
      py::arg("database"), py::arg("positions"), py::arg("excluded_clips") = std::vector<int>{},
      R"doc(Returns for each pose the database frame whose pose is nearest, (T,).

positions (T, 21, 3) m are in the heading frame. No retrieval from the database can be closer.
excluded_clips, by index, and copies at other tempos are not used.)doc");
  m.def(
      "graph_times",
      [](const Database& database, const Readings& take, int window,
         const std::vector<int>& excluded_clips) {
        if (window < 1) throw py::value_error("window must be at least 1");
        GraphTimes times;
        {
          const py::gil_scoped_release release;
          times = graph_times(*database, take.sensors, take.readings, window, excluded_clips);
        }
        return py::make_tuple(times.online_s, times.anew_s, times.same);
      },
      py::arg("database"), py::arg("take"), py::arg("window"),
      py::arg("excluded_clips") = std::vector<int>{},
      R"doc(Returns what paths cost a reading: s online, s when made anew, and how often they agree.

The online lazy neighbourhood graph of Tautges et al. 2011 beside one that is made anew for each
reading from the last `window` of them; processor time of the process in the graphs alone. The last
figure is the share of readings with the same end of the best path.)doc");
}

}  // namespace sparse_mocap::python
