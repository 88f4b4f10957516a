// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparse_mocap::retrieval {

// Sorts rows into blocks of near rows: places in the list such that each `block_rows` of them, one
// after another, are a cell of a kd-tree (the last block may be shorter). The same on any number of
// threads (0: one a processor).
std::vector<std::uint32_t> block_order(
    const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>& features,
    std::span<const std::uint32_t> listed, std::size_t block_rows, int num_threads);

}  // namespace sparse_mocap::retrieval
