// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

namespace sparse_mocap {

struct AlignmentSettings {
  double largest_lag_s = 1.0;
  double window_s = 1.5;  // of the event that both sensors saw
};

// How much later the second sensor's clock shows what both saw.
struct TimeLag {
  double lag_s = 0.0;        // subtract it from the second sensor's times
  double correlation = 0.0;  // -1 to 1, at this lag
  double runner_up = 0.0;    // the best correlation at another lag
  double event_s = 0.0;      // the middle of the event, on the first sensor's clock

  // Whether something common was found, and only one lag fits it.
  bool is_found() const { return correlation > 0.7 && runner_up < 0.9 * correlation; }
};

// The lag between two sensors' magnitudes (of specific force or of angular velocity) by normalised
// cross-correlation around the strongest common event, a clap or a jump; the peak is refined by a
// parabola. Times ascend, one value each. Throws std::invalid_argument when sizes differ or the
// recordings do not overlap by the window.
TimeLag align_in_time(std::span<const double> first_times_s, std::span<const double> first,
                      std::span<const double> second_times_s, std::span<const double> second,
                      AlignmentSettings settings = {});

}  // namespace sparse_mocap
