// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/knn_index.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nanoflann.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

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

  std::size_t num_wanted() const { return k_; }
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

  void search(std::span<const float> query, NearestSet& nearest) const {
    if (std::any_of(query.begin(), query.end(), [](float v) { return std::isnan(v); }))
      return scan_known_dimensions(query, nearest);
    if (tree) {
      tree->findNeighbors(nearest, query.data(), {});
      return;
    }
    static thread_local std::vector<std::uint32_t> places;
    blocks->near_rows(query, nearest.num_wanted(), places);
    for (const auto place : places)
      nearest.addPoint(squared_distance(query.data(), row(place), query.size()), place);
  }

  // Silent dimensions change the metric, which neither cells nor boxes know of.
  void scan_known_dimensions(std::span<const float> query, NearestSet& nearest) const {
    const auto size = static_cast<Eigen::Index>(query.size());
    const Eigen::Map<const Eigen::ArrayXf> asked(query.data(), size);
    const Eigen::ArrayXf is_known = asked.isNaN().select(Eigen::ArrayXf::Zero(size), 1.0F);
    const Eigen::ArrayXf known = asked.isNaN().select(Eigen::ArrayXf::Zero(size), asked);
    for (std::uint32_t i = 0; i < rows.size(); ++i) {
      const Eigen::Map<const Eigen::ArrayXf> values(row(i), size);
      nearest.addPoint(((known - values) * is_known).square().sum(), i);
    }
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
  static thread_local std::vector<Candidate> buffer;
  const auto count = std::min(static_cast<std::size_t>(k), searched_->rows.size());
  NearestSet nearest(count, buffer);
  searched_->search(query, nearest);
  nearest.finish();
  out.clear();
  // Rows are listed in ascending order, so place and row number sort alike.
  for (const auto& [squared, place] : buffer)
    out.push_back({std::sqrt(squared), static_cast<int>(searched_->rows[place])});
}

}  // namespace sparse_mocap::retrieval
