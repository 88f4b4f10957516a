// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "sparse_mocap/eom2014/training_sequence.hpp"
#include "sparse_mocap/reconstruction/method.hpp"

namespace sparse_mocap::eom2014 {

// A take's only sensor. Gaps are bridged in straight lines. Throws ConfigError for a take of less
// than a second, or of which more than half is missing.
ReadingRows reading_rows(const std::vector<Reading>& take, double rate_hz);

// What brings readings to m/s^2 and rad/s: some phones tell g or degrees a second.
struct Units {
  double to_mps2 = 1.0;
  double to_radps = 1.0;

  ReadingRows converted(ReadingRows readings) const;
};

// Told by the size of gravity and how fast limbs can turn; what is converted is added to the notes.
// Throws ConfigError for accelerations without gravity.
Units units_of(const ReadingRows& readings, std::vector<std::string>& notes);

// Each channel by a Gaussian filter (Eom et al. 2014, section 4.1).
ReadingRows smoothed(const ReadingRows& readings, double sigma_frames);

// The readings of a sensor that is turned: R_site_sensor takes its axes to those of its site.
ReadingRows turned(const ReadingRows& readings, const Mat3& R_site_sensor);

// Mean and deviation of each channel.
struct ReadingScale {
  Eigen::Matrix<double, 1, 6> mean, deviation;

  static ReadingScale of(const ReadingRows& readings);
};

// What a mapping sees of each reading: the scaled readings from `window` before it to `window`
// after it, those beyond the ends like the last. frames x 6 (2 window + 1), of a length near 1.
Eigen::MatrixXd features(const ReadingRows& readings, const ReadingScale& scale, int window);
// Of several sequences after one another, which begin at these rows; windows end where they do.
Eigen::MatrixXd sequence_features(const ReadingRows& readings, const std::vector<int>& begins,
                                  const ReadingScale& scale, int window);

// Squared distances between the rows of two matrices, rows of a x rows of b.
Eigen::MatrixXd squared_distances(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace sparse_mocap::eom2014
