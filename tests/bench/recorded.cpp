// SPDX-License-Identifier: GPL-3.0-or-later
#include "recorded.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "sparse_mocap/path_regression/config.hpp"
#include "sparse_mocap/retrieval/features.hpp"
#include "sparse_mocap/retrieval/signals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::testing {
namespace {

using retrieval::FeatureRows;

std::filesystem::path folder() {
  const char* variable = std::getenv("SPARSE_MOCAP_BENCH_DATABASES");
  return variable == nullptr ? std::filesystem::path() : std::filesystem::path(variable);
}

FeatureRows features_of(const MotionDatabase& database, int dimensions) {
  const auto signals = retrieval::compared_signals(paper_sensors(), false);
  FeatureRows rows = retrieval::database_signals(database, signals);
  if (dimensions == 12) return rows;
  const auto config = path_regression::live_config();
  auto parts = config.features;
  if (dimensions == 48)
    parts.insert(parts.end(), config.regression_features.begin(),
                 config.regression_features.begin() + 2);
  const retrieval::FeatureLayout layout(parts, database.rate_hz());
  std::vector<float> weights;
  for (const auto& signal : signals)
    weights.insert(weights.end(), 3,
                   retrieval::is_on_leg(signal) ? static_cast<float>(config.leg_weight) : 1.0F);
  return retrieval::database_features(database, rows, layout, weights);
}

}  // namespace

std::vector<std::string> recorded_sizes() {
  std::vector<std::string> sizes;
  if (folder().empty()) return sizes;
  for (const char* size : {"30k", "100k", "300k", "680k", "5m"})
    if (std::filesystem::exists(recorded_path(size))) sizes.emplace_back(size);
  return sizes;
}

std::filesystem::path recorded_path(const std::string& size) { return folder() / (size + ".smdb"); }

std::shared_ptr<const MotionDatabase> recorded_database(const std::string& size) {
  static std::string kept_size;
  static std::shared_ptr<const MotionDatabase> kept;
  if (kept_size != size) {
    kept = MotionDatabase::open(recorded_path(size));
    kept_size = size;
  }
  return kept;
}

std::vector<Reading> recorded_performances() {
  const auto database = MotionDatabase::open(recorded_path("queries"));
  std::vector<Reading> all;
  for (int clip = 0; clip < static_cast<int>(database->clips().size()); ++clip)
    for (auto& reading : readings_of(*database, clip, paper_sensors())) {
      for (auto* channel : {&reading.angular_velocity, &reading.gravity_direction})
        channel->setConstant(NAN);
      all.push_back(std::move(reading));
    }
  return all;
}

SearchedRows searched_rows(const std::string& size, int dimensions, int query_each) {
  SearchedRows out{features_of(*recorded_database(size), dimensions), {}};
  const FeatureRows all = features_of(*MotionDatabase::open(recorded_path("queries")), dimensions);
  out.queries.resize(all.rows() / query_each, all.cols());
  for (Eigen::Index q = 0; q < out.queries.rows(); ++q)
    out.queries.row(q) = all.row(q * query_each);
  return out;
}

}  // namespace sparse_mocap::testing
