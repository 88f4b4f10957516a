// SPDX-License-Identifier: GPL-3.0-or-later
#include "common.hpp"
#include "sparse_mocap/base/conventions.hpp"

PYBIND11_MODULE(_core, m) {
  using namespace sparse_mocap;
  m.doc() =
      R"doc(The compiled core. Shapes: T frames, J joints, S sensors. SI units, quaternions w x y z.

Long calls release the GIL. ``progress(done, total, what)`` is called with the GIL held and cancels
the call by returning False (the call then raises Cancelled and leaves nothing behind).)doc";
  m.attr("__version__") = SPARSE_MOCAP_VERSION;
  m.attr("GRAVITY_MPS2") = kGravity_mps2;
  python::bind_errors(m);
  python::bind_motion(m);
  python::bind_body(m);
  python::bind_retargeting(m);
  python::bind_sensors(m);
  python::bind_streams(m);
  python::bind_calibration(m);
  python::bind_timing(m);
  python::bind_rotations(m);
  python::bind_readings(m);
  python::bind_model(m);
  python::bind_pose_calibration(m);
  python::bind_database(m);
  python::bind_database_import(m);
  python::bind_reconstruction(m);
  python::bind_baselines(m);
}
