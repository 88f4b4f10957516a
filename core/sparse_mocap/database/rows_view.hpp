// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace sparse_mocap {

// Rows as they lie in a file: one after another.
template <typename Scalar>
using RowsView =
    Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
using FloatRows = RowsView<float>;

// Rows of whole numbers, those of each clip with a scale of their own: what row, () and rows_of
// give are the numbers times the scale. They view the rows, which must stay where they are.
class ScaledRows {
 public:
  ScaledRows() = default;
  // scales: one a clip; clip_of_row: one a row.
  ScaledRows(const RowsView<std::int16_t>& values, const float* scales,
             const std::int32_t* clip_of_row)
      : values_(values.data()),
        rows_(values.rows()),
        cols_(values.cols()),
        scales_(scales),
        clip_of_row_(clip_of_row) {}

  Eigen::Index rows() const { return rows_; }
  Eigen::Index cols() const { return cols_; }
  RowsView<std::int16_t> values() const { return {values_, rows_, cols_}; }
  float scale(Eigen::Index row) const { return scales_[clip_of_row_[row]]; }

  float operator()(Eigen::Index row, Eigen::Index column) const {
    return static_cast<float>(values_[row * cols_ + column]) * scale(row);
  }
  auto row(Eigen::Index n) const {
    using Row = Eigen::Map<const Eigen::Matrix<std::int16_t, 1, Eigen::Dynamic>>;
    return Row(values_ + n * cols_, cols_).template cast<float>() * scale(n);
  }
  // Rows [begin, begin + count), which must be of one clip.
  auto rows_of_clip(Eigen::Index begin, Eigen::Index count) const {
    return RowsView<std::int16_t>(values_ + begin * cols_, count, cols_).template cast<float>() *
           scale(begin);
  }
  // A copy of all rows.
  Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> all() const {
    Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> out(rows(), cols());
    for (Eigen::Index n = 0; n < rows(); ++n) out.row(n) = row(n);
    return out;
  }

 private:
  const std::int16_t* values_ = nullptr;
  Eigen::Index rows_ = 0, cols_ = 0;
  const float* scales_ = nullptr;
  const std::int32_t* clip_of_row_ = nullptr;
};

}  // namespace sparse_mocap
