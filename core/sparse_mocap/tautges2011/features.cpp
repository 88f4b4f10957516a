// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/features.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sparse_mocap::tautges2011 {

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

std::vector<Tap> gaussian_taps(double centre, double sigma_frames, int first, int last) {
  std::vector<Tap> taps;
  double total = 0.0;
  for (int frame = first; frame <= last; ++frame) {
    const double z = (frame - centre) / sigma_frames;
    taps.push_back({frame, std::exp(-0.5 * z * z)});
    total += taps.back().weight;
  }
  for (auto& tap : taps) tap.weight /= total;
  return taps;
}

FeatureRows database_readings(const MotionDatabase& database,
                              const std::vector<WornSensor>& sensors) {
  FeatureRows readings(database.num_frames(), static_cast<Eigen::Index>(3 * sensors.size()));
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    const auto& names = database.site_names();
    const auto& wanted = all_sites()[static_cast<std::size_t>(sensors[s].site)].name;
    const auto at = std::find(names.begin(), names.end(), wanted);
    if (at == names.end())
      throw std::invalid_argument("the database has no readings of " + std::string(wanted));
    const auto column = static_cast<Eigen::Index>(3 * (at - names.begin()));
    auto read = readings.middleCols(static_cast<Eigen::Index>(3 * s), 3);
    if (sensors[s].quantity == Quantity::up) {
      read = database.gravity_direction().middleCols(column, 3);
      continue;
    }
    const auto place = static_cast<float>(sensors[s].place);
    read = (1.0F - place) * database.specific_force_pivot().middleCols(column, 3) +
           place * database.specific_force_end().middleCols(column, 3);
  }
  return readings;
}

void feature_at(const FeatureRows& readings, Eigen::Index begin, Eigen::Index end, Eigen::Index at,
                const FeatureLayout& layout, std::span<const float> weights,
                std::span<float> feature) {
  const auto columns = static_cast<std::size_t>(readings.cols());
  std::fill(feature.begin(), feature.end(), 0.0F);
  for (std::size_t p = 0; p < layout.parts.size(); ++p) {
    const auto part = feature.subspan(p * columns, columns);
    for (const Tap& tap : layout.parts[p]) {
      const auto row = std::clamp(at + tap.frame, begin, end - 1);
      const float* reading = readings.data() + row * readings.cols();
      const auto weight = static_cast<float>(tap.weight);
      for (std::size_t c = 0; c < columns; ++c) part[c] += weight * reading[c];
    }
    for (std::size_t c = 0; c < columns; ++c) part[c] *= weights[c];
  }
}

FeatureRows database_features(const MotionDatabase& database, const FeatureRows& readings,
                              const FeatureLayout& layout, std::span<const float> weights) {
  const int num_sensors = static_cast<int>(readings.cols() / 3);
  FeatureRows features(readings.rows(), layout.num_dimensions(num_sensors));
  const auto width = static_cast<std::size_t>(features.cols());
  for (const Clip& clip : database.clips())
    for (int frame = clip.begin; frame < clip.end; ++frame)
      feature_at(readings, clip.begin, clip.end, frame, layout, weights,
                 {features.data() + frame * features.cols(), width});
  return features;
}

}  // namespace sparse_mocap::tautges2011
