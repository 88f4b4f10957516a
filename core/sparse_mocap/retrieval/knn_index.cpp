// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/knn_index.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nanoflann.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "sparse_mocap/base/sort_keys.hpp"
#include "sparse_mocap/retrieval/block_scan.hpp"

namespace sparse_mocap::retrieval {
namespace {

constexpr std::size_t kLeafSize = 64;
// With fewer dimensions than this a kd-tree keeps more rows out than blocks do.
constexpr Eigen::Index kDimensionsOfBlocks = 7;

// A squared distance and the row it belongs to; ordered so that ties have one answer.
using Candidate = std::pair<float, std::uint32_t>;

// Collects the k smallest candidates in a buffer that is cut back whenever it is full: nanoflann's
// own result set keeps a sorted array, which costs O(k) for each insertion.
class NearestSet {
 public:
  using DistanceType = float;
  using IndexType = std::uint32_t;

  NearestSet(std::size_t k, std::vector<Candidate>& buffer) : k_(k), buffer_(buffer) {
    buffer_.clear();
    buffer_.reserve(4 * k);
  }

  std::size_t size() const { return buffer_.size(); }
  bool empty() const { return buffer_.empty(); }
  bool full() const { return buffer_.size() >= k_; }
  // The tree rounds its lower bounds and drops equal distances; the slack keeps both within reach.
  DistanceType worstDist() const {
    return std::nextafter(bound_.first * (1.0F + 1e-5F), std::numeric_limits<float>::infinity());
  }

  bool addPoint(DistanceType distance, IndexType row) {
    const Candidate candidate{distance, row};
    if (candidate < bound_) {
      buffer_.push_back(candidate);
      if (buffer_.size() == 4 * k_) cut();
    }
    return true;
  }

  void finish() {
    if (buffer_.size() > k_) cut();
    std::sort(buffer_.begin(), buffer_.end());
  }

 private:
  void cut() {
    const auto last = buffer_.begin() + static_cast<std::ptrdiff_t>(k_) - 1;
    std::nth_element(buffer_.begin(), last, buffer_.end());
    bound_ = *last;
    buffer_.resize(k_);
  }

  std::size_t k_;
  std::vector<Candidate>& buffer_;
  Candidate bound_{std::numeric_limits<float>::max(), std::numeric_limits<std::uint32_t>::max()};
};

// What nanoflann asks of a data set: rows by their place in a list.
struct Points {
  const FeatureRows& features;
  const std::vector<std::uint32_t>& rows;

  std::size_t kdtree_get_point_count() const { return rows.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t dimension) const {
    return features(rows[i], static_cast<Eigen::Index>(dimension));
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

// By Eigen, which adds up in four lanes; a plain loop may not be reordered and takes four times as
// long.
float squared_distance(const float* a, const float* b, std::size_t dimensions) {
  using Row = Eigen::Map<const Eigen::VectorXf>;
  const auto n = static_cast<Eigen::Index>(dimensions);
  return (Row(a, n) - Row(b, n)).squaredNorm();
}

// The squared distance in one go over a contiguous row.
struct RowDistance {
  using ElementType = float;
  using DistanceType = float;

  const Points& points;
  explicit RowDistance(const Points& data) : points(data) {}

  float evalMetric(const float* query, std::size_t i, std::size_t dimensions) const {
    const float* row = points.features.data() + points.rows[i] * points.features.cols();
    return squared_distance(query, row, dimensions);
  }
  template <typename A, typename B>
  float accum_dist(const A a, const B b, std::size_t) const {
    return (a - b) * (a - b);
  }
};

// Distances in the dimensions that a query has; the others are NaN.
class KnownValues {
 public:
  void ask(std::span<const float> query) {
    values_ =
        Eigen::Map<const Eigen::ArrayXf>(query.data(), static_cast<Eigen::Index>(query.size()));
    is_known_ = values_.isNaN().select(Eigen::ArrayXf::Zero(values_.size()), 1.0F);
    values_ = values_.isNaN().select(Eigen::ArrayXf::Zero(values_.size()), values_);
  }
  float squared_distance(const float* row) const {
    const Eigen::Map<const Eigen::ArrayXf> there(row, values_.size());
    return ((values_ - there) * is_known_).square().sum();
  }

 private:
  Eigen::ArrayXf values_, is_known_;
};

// A squared distance and a place in one number, which sorts as the pair does: floats that are not
// negative are ordered as their bits.
std::uint64_t key_of(float squared, std::uint32_t place) {
  return (static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(squared)) << 32) | place;
}

struct Found {
  std::vector<std::uint64_t> keys, scratch;
};

using NanoflannTree = nanoflann::KDTreeSingleIndexAdaptor<RowDistance, Points, -1, std::uint32_t>;

}  // namespace

struct KnnIndex::Searched {
  Searched(FeatureRows rows_of_features, const std::vector<bool>& is_searched)
      : features(std::move(rows_of_features)),
        rows(searched_rows(is_searched)),
        points{features, rows} {
    const auto dimensions = features.cols();
    if (dimensions >= kDimensionsOfBlocks) {
      blocks.emplace(features, rows);
      return;
    }
    tree.emplace(static_cast<int>(dimensions), points,
                 nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize));
    tree->buildIndex();
  }

  std::vector<std::uint32_t> searched_rows(const std::vector<bool>& is_searched) const {
    if (!is_searched.empty() && static_cast<Eigen::Index>(is_searched.size()) != features.rows())
      throw std::invalid_argument("KnnIndex: one flag a row is needed");
    std::vector<std::uint32_t> selected;
    for (std::uint32_t r = 0; r < features.rows(); ++r)
      if (is_searched.empty() || is_searched[r]) selected.push_back(r);
    if (selected.empty()) throw std::invalid_argument("KnnIndex: no rows to search");
    return selected;
  }

  const float* row(std::uint32_t place) const {
    return features.data() + rows[place] * features.cols();
  }

  // Into the cache, all of a row.
  void fetch(const float* values) const {
    constexpr Eigen::Index kLine = 16;  // floats
    for (Eigen::Index i = 0; i < features.cols(); i += kLine) __builtin_prefetch(values + i);
    __builtin_prefetch(values + features.cols() - 1);
  }

  // The nearest k as keys: ascending, the places of equally far rows too.
  void search(std::span<const float> query, std::size_t k, Found& found) const {
    found.keys.clear();
    if (blocks) return search_blocks(query, k, found);
    static thread_local std::vector<Candidate> buffer;
    NearestSet nearest(k, buffer);
    if (std::any_of(query.begin(), query.end(), [](float v) { return std::isnan(v); })) {
      static thread_local KnownValues known;
      known.ask(query);
      for (std::uint32_t i = 0; i < rows.size(); ++i)
        nearest.addPoint(known.squared_distance(row(i)), i);
    } else {
      tree->findNeighbors(nearest, query.data(), {});
    }
    nearest.finish();
    for (const auto& [squared, place] : buffer) found.keys.push_back(key_of(squared, place));
  }

  void search_blocks(std::span<const float> query, std::size_t k, Found& found) const {
    static thread_local std::vector<std::uint32_t> places;
    blocks->near_rows(query, k, places);
    const bool all_known =
        std::none_of(query.begin(), query.end(), [](float v) { return std::isnan(v); });
    static thread_local KnownValues known;
    known.ask(query);
    for (std::size_t i = 0; i < places.size(); ++i) {
      constexpr std::size_t kAhead = 16;  // rows that are fetched into the cache meanwhile
      if (i + kAhead < places.size()) fetch(row(places[i + kAhead]));
      const float* values = row(places[i]);
      const float squared = all_known ? squared_distance(query.data(), values, query.size())
                                      : known.squared_distance(values);
      if (std::isfinite(squared)) found.keys.push_back(key_of(squared, places[i]));
    }
    // To sort a few keys too many takes less time than to find the last one that is wanted.
    if (found.keys.size() > 2 * k) {
      const auto last = found.keys.begin() + static_cast<std::ptrdiff_t>(k);
      std::nth_element(found.keys.begin(), last, found.keys.end());
      found.keys.erase(last, found.keys.end());
    }
    sort_keys(found.keys, found.scratch);
    if (found.keys.size() > k) found.keys.resize(k);
  }

  FeatureRows features;
  std::vector<std::uint32_t> rows;
  Points points;
  std::optional<NanoflannTree> tree;  // either this
  std::optional<BlockScan> blocks;    // or these
};

KnnIndex::KnnIndex(FeatureRows features, const std::vector<bool>& is_searched)
    : searched_(std::make_unique<Searched>(std::move(features), is_searched)) {}
KnnIndex::~KnnIndex() = default;
KnnIndex::KnnIndex(KnnIndex&&) noexcept = default;
KnnIndex& KnnIndex::operator=(KnnIndex&&) noexcept = default;

int KnnIndex::num_rows() const { return static_cast<int>(searched_->rows.size()); }
int KnnIndex::num_dimensions() const { return static_cast<int>(searched_->features.cols()); }
const FeatureRows& KnnIndex::features() const { return searched_->features; }

void KnnIndex::search(std::span<const float> query, int k, std::vector<Neighbour>& out) const {
  if (k < 1 || static_cast<int>(query.size()) != num_dimensions())
    throw std::invalid_argument("KnnIndex: k must be positive and the query of the features' size");
  static thread_local Found found;
  searched_->search(query, std::min(static_cast<std::size_t>(k), searched_->rows.size()), found);
  out.clear();
  // Rows are listed in ascending order, so place and row number sort alike.
  for (const std::uint64_t key : found.keys) {
    const auto squared = std::bit_cast<float>(static_cast<std::uint32_t>(key >> 32));
    const auto place = static_cast<std::uint32_t>(key);
    out.push_back({std::sqrt(squared), static_cast<int>(searched_->rows[place])});
  }
}

}  // namespace sparse_mocap::retrieval
