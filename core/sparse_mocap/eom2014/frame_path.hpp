// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace sparse_mocap::eom2014 {

// How likely each training frame is at each instant (instants x training frames, rows sum to 1),
// by the forward-backward algorithm over the training frames as the states of a hidden Markov
// model: the performer goes on at half to double the training's tempo, seldom jumps elsewhere, and
// features lie about those of the frame with a standard deviation of `width`. Features are rows;
// `begins` are the first frames of the training's sequences.
Eigen::MatrixXd frame_posterior(const Eigen::MatrixXd& features, const Eigen::MatrixXd& training,
                                const std::vector<int>& begins, double width);

}  // namespace sparse_mocap::eom2014
