// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/features.hpp"

#include <algorithm>
#include <cmath>

namespace sparse_mocap::retrieval {
namespace {

// Normalised to the sum `gain`.
void append_taps(const SmoothedSignals& smoothed, double rate_hz, std::vector<Tap>& taps) {
  const auto begin = static_cast<std::ptrdiff_t>(taps.size());
  const int first = static_cast<int>(std::lround(smoothed.from_s * rate_hz));
  const int last = static_cast<int>(std::lround(smoothed.to_s * rate_hz));
  double total = 0.0;
  for (int frame = first; frame <= last; ++frame) {
    const double z = (frame - smoothed.centre_s * rate_hz) / (smoothed.sigma_s * rate_hz);
    taps.push_back({frame, std::exp(-0.5 * z * z)});
    total += taps.back().weight;
  }
  for (auto tap = taps.begin() + begin; tap != taps.end(); ++tap)
    tap->weight *= smoothed.gain / total;
}

// Columns [begin, begin + N) of a part: the taps' weighted sum of the rows that they look at.
template <int N>
void put_columns(std::span<const Tap> taps, std::span<const float* const> rows, std::size_t begin,
                 std::span<const float> weights, std::span<float> part) {
  using Columns = Eigen::Array<float, N, 1>;
  Columns sum = Columns::Zero();
  for (std::size_t i = 0; i < taps.size(); ++i)
    sum += static_cast<float>(taps[i].weight) * Eigen::Map<const Columns>(rows[i] + begin);
  Eigen::Map<Columns>(part.data() + begin) = sum * Eigen::Map<const Columns>(&weights[begin]);
}

}  // namespace

FeatureLayout::FeatureLayout(const std::vector<FeaturePart>& described, double rate_hz) {
  parts.assign(described.size(), {});
  for (std::size_t p = 0; p < described.size(); ++p)
    for (const auto& smoothed : described[p]) append_taps(smoothed, rate_hz, parts[p]);
}

int FeatureLayout::look_ahead() const {
  int frames = 0;
  for (const auto& part : parts)
    for (const Tap& tap : part) frames = std::max(frames, tap.frame);
  return frames;
}

int FeatureLayout::reach_back() const {
  int frames = 0;
  for (const auto& part : parts)
    for (const Tap& tap : part) frames = std::max(frames, -tap.frame);
  return frames;
}

void feature_at(const SignalWindow& window, const FeatureLayout& layout,
                std::span<const float> weights, std::span<float> feature) {
  const auto& rows = window.rows;
  const auto columns = static_cast<std::size_t>(rows.cols());
  static thread_local std::vector<const float*> rows_of_taps;
  for (std::size_t p = 0; p < layout.parts.size(); ++p) {
    const auto part = feature.subspan(p * columns, columns);
    const std::vector<Tap>& taps = layout.parts[p];
    rows_of_taps.clear();
    for (const Tap& tap : taps) {
      const auto row = std::clamp(window.at + tap.frame, window.begin, window.end - 1);
      rows_of_taps.push_back(rows.data() + row * rows.cols());
    }
    std::size_t c = 0;
    for (; c + 4 <= columns; c += 4) put_columns<4>(taps, rows_of_taps, c, weights, part);
    for (; c < columns; ++c) put_columns<1>(taps, rows_of_taps, c, weights, part);
  }
}

FeatureRows database_features(const MotionDatabase& database, const FeatureRows& signals,
                              const FeatureLayout& layout, std::span<const float> weights) {
  const int num_signals = static_cast<int>(signals.cols() / 3);
  FeatureRows features(signals.rows(), layout.num_dimensions(num_signals));
  const auto width = static_cast<std::size_t>(features.cols());
  for (const Clip& clip : database.clips())
    for (int frame = clip.begin; frame < clip.end; ++frame)
      feature_at({signals, clip.begin, clip.end, frame}, layout, weights,
                 {features.data() + frame * features.cols(), width});
  return features;
}

}  // namespace sparse_mocap::retrieval
