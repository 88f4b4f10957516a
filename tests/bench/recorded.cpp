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

constexpr int kCopies = 8;  // of the largest database, to make the size 5m
constexpr Eigen::Index kQueryEach = 7;

std::filesystem::path folder() {
  const char* variable = std::getenv("SPARSE_MOCAP_BENCH_DATABASES");
  return variable == nullptr ? std::filesystem::path() : std::filesystem::path(variable);
}

FeatureRows features_of(const MotionDatabase& database, int dimensions) {
  const auto signals = retrieval::compared_signals(paper_sensors(), false);
  FeatureRows rows = retrieval::database_signals(database, signals);
  if (dimensions == 12) return rows;
  const auto config = path_regression::live_config();
  const retrieval::FeatureLayout layout(config.features, database.rate_hz());
  std::vector<float> weights;
  for (const auto& signal : signals)
    weights.insert(weights.end(), 3,
                   retrieval::is_on_leg(signal) ? static_cast<float>(config.leg_weight) : 1.0F);
  return retrieval::database_features(database, rows, layout, weights);
}

// Rows as if the motion had gone at another tempo, and a little differently.
FeatureRows warped(const FeatureRows& rows, float tempo, unsigned seed) {
  Random random(seed);
  const auto count = static_cast<Eigen::Index>(static_cast<float>(rows.rows() - 1) / tempo);
  FeatureRows out(count, rows.cols());
  for (Eigen::Index r = 0; r < count; ++r) {
    const float at = static_cast<float>(r) * tempo;
    const auto before = static_cast<Eigen::Index>(at);
    const float share = at - static_cast<float>(before);
    out.row(r) = (1.0F - share) * rows.row(before) + share * rows.row(before + 1);
    for (auto& value : out.row(r)) value += static_cast<float>(random.in(-0.3, 0.3));
  }
  return out;
}

FeatureRows many_copies(const FeatureRows& rows) {
  FeatureRows out(0, rows.cols());
  for (int c = 0; c < kCopies; ++c) {
    const FeatureRows copy =
        warped(rows, 0.8F + 0.06F * static_cast<float>(c), static_cast<unsigned>(c));
    out.conservativeResize(out.rows() + copy.rows(), Eigen::NoChange);
    out.bottomRows(copy.rows()) = copy;
  }
  return out;
}

}  // namespace

std::vector<std::string> recorded_sizes() {
  std::vector<std::string> sizes;
  if (folder().empty()) return sizes;
  for (const char* size : {"30k", "100k", "300k", "680k"})
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

SearchedRows searched_rows(const std::string& size, int dimensions) {
  const bool is_copied = size == "5m";
  const std::string recorded = is_copied ? recorded_sizes().back() : size;
  SearchedRows out{features_of(*recorded_database(recorded), dimensions), {}};
  if (is_copied) out.rows = many_copies(out.rows);
  const FeatureRows all = features_of(*MotionDatabase::open(recorded_path("queries")), dimensions);
  out.queries.resize(all.rows() / kQueryEach, all.cols());
  for (Eigen::Index q = 0; q < out.queries.rows(); ++q)
    out.queries.row(q) = all.row(q * kQueryEach);
  return out;
}

}  // namespace sparse_mocap::testing
