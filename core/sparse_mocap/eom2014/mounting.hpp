// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/eom2014/known_readings.hpp"

namespace sparse_mocap::eom2014 {

// How a sensor sits on its limb, told from how it moved.
struct SensorTurn {
  Mat3 R_site_sensor = Mat3::Identity();
  double turn_rad = 0.0;    // about the limb
  bool is_negated = false;  // accelerations have the opposite sign, as iPhones give them
  double misfit = 0.0;      // see misfit_of()

  // The readings of a sensor that sits as its site says.
  ReadingRows corrected(ReadingRows readings) const;
};

// How far readings are from the nearest of those that the model was trained on, on average, in
// deviations.
double misfit_of(const ReadingRows& readings, const KnownReadings& known);

// The turn under which readings come nearest to those that the model was trained on: what is felt
// on average, gravity most of all, gives two of the angles, and the misfit the one about it. Small
// improvements do not count, so that a sensor that sits as it should keeps its axes.
// Accelerations of the opposite sign are tried as well.
//
// most_compared: of so many instants, evenly over the readings.
SensorTurn estimated_turn(const ReadingRows& readings, const KnownReadings& known,
                          int most_compared = 150);

}  // namespace sparse_mocap::eom2014
