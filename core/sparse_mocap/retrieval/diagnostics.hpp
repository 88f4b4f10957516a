// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "sparse_mocap/reconstruction/pose_estimate.hpp"
#include "sparse_mocap/retrieval/neighbourhood.hpp"
#include "sparse_mocap/retrieval/signals.hpp"

namespace sparse_mocap::retrieval {

// How well retrieved frames agree with the reading and with each other: sensor_misfit_mps2,
// spread_m, clip and database_frame; and the reading itself, specific_force_mps2. measured is the
// reading's row of signals, signal_rows the database's.
Diagnostics retrieval_diagnostics(const MotionDatabase& database, const WeightedPaths& weighted,
                                  std::span<const Signal> signals, const FeatureRows& signal_rows,
                                  const Eigen::RowVectorXf& measured);
void put_retrieval_diagnostics(const MotionDatabase& database, const WeightedPaths& weighted,
                               std::span<const Signal> signals, const FeatureRows& signal_rows,
                               const Eigen::Ref<const Eigen::RowVectorXf>& measured,
                               Diagnostics& out);

}  // namespace sparse_mocap::retrieval
