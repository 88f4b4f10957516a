// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/knn_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <stdexcept>
#include <thread>

#include "support/refusals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::retrieval {
namespace {

using testing::Random;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// All rows sorted by (distance, row); double sums, so only near ties may differ from the index.
std::vector<Neighbour> brute_force(const FeatureRows& rows, const std::vector<float>& query, int k,
                                   const std::vector<bool>& is_searched = {}) {
  std::vector<std::pair<double, int>> all;
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    if (!is_searched.empty() && !is_searched[static_cast<std::size_t>(r)]) continue;
    double sum = 0.0;
    for (std::size_t d = 0; d < query.size(); ++d) {
      const double difference = double{query[d]} - double{rows(r, static_cast<Eigen::Index>(d))};
      if (!std::isnan(difference)) sum += difference * difference;
    }
    all.emplace_back(sum, static_cast<int>(r));
  }
  std::sort(all.begin(), all.end());
  all.resize(std::min(all.size(), static_cast<std::size_t>(k)));
  std::vector<Neighbour> out;
  for (const auto& [sum, row] : all) out.push_back({static_cast<float>(std::sqrt(sum)), row});
  return out;
}

FeatureRows random_rows(Random& random, Eigen::Index rows, Eigen::Index columns,
                        const std::function<double(Random&)>& draw) {
  FeatureRows out(rows, columns);
  for (auto& value : out.reshaped()) value = static_cast<float>(draw(random));
  return out;
}

std::vector<float> random_query(Random& random, Eigen::Index columns,
                                const std::function<double(Random&)>& draw) {
  std::vector<float> query(static_cast<std::size_t>(columns));
  for (auto& value : query) value = static_cast<float>(draw(random));
  return query;
}

// The index answers exactly as the brute force does, distances up to rounding.
void expect_same(const KnnIndex& index, const std::vector<float>& query, int k,
                 const std::vector<Neighbour>& expected) {
  std::vector<Neighbour> found;
  index.search(query, k, found);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].row, expected[i].row) << "at " << i << " of " << k;
    EXPECT_NEAR(found[i].distance, expected[i].distance, 1e-5F * (1.0F + expected[i].distance));
  }
}

// As above where so many rows are that some are nearly as far as the next: those may change places.
void expect_same_but_for_near_ties(const KnnIndex& index, const std::vector<float>& query, int k) {
  const auto expected = brute_force(index.features(), query, k);
  std::vector<Neighbour> found;
  index.search(query, k, found);
  ASSERT_EQ(found.size(), expected.size());
  std::set<int> rows;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto row = index.features().row(found[i].row).cast<double>();
    const Eigen::Map<const Eigen::RowVectorXf> asked(query.data(), row.size());
    const Eigen::RowVectorXd off = row - asked.cast<double>();
    const double distance = off.array().isNaN().select(0.0, off).matrix().norm();
    EXPECT_NEAR(found[i].distance, distance, 1e-6 * (1.0 + distance));
    ASSERT_NEAR(found[i].distance, expected[i].distance, 2e-6F * (1.0F + expected[i].distance));
    rows.insert(found[i].row);
  }
  EXPECT_EQ(rows.size(), found.size());
}

double smooth(Random& random) { return random.in(-20.0, 20.0) + random.in(0.0, 9.81); }
double on_grid(Random& random) { return random.below(3); }

TEST(KnnIndex, RefusesWhatItCannotSearch) {
  EXPECT_REFUSED(std::invalid_argument, "no rows to search", KnnIndex(FeatureRows(0, 3)));
  EXPECT_REFUSED(std::invalid_argument, "one flag a row",
                 KnnIndex(FeatureRows::Zero(3, 2), {true}));
  EXPECT_REFUSED(std::invalid_argument, "no rows to search",
                 KnnIndex(FeatureRows::Zero(2, 2), {false, false}));
  const KnnIndex index(FeatureRows::Zero(3, 2));
  std::vector<Neighbour> found;
  EXPECT_REFUSED(std::invalid_argument, "k must be positive",
                 index.search(std::vector<float>{0, 0}, 0, found));
  EXPECT_REFUSED(std::invalid_argument, "k must be positive",
                 index.search(std::vector<float>{0, 0}, -1, found));
  EXPECT_REFUSED(std::invalid_argument, "of the features' size",
                 index.search(std::vector<float>{0, 0, 0}, 1, found));
}

TEST(KnnIndex, FindsWhatBruteForceFinds) {
  Random random(1);
  for (const Eigen::Index columns : {12, 24}) {
    const FeatureRows rows = random_rows(random, 5000, columns, smooth);
    const KnnIndex index(rows);
    EXPECT_EQ(index.num_rows(), 5000);
    EXPECT_EQ(index.num_dimensions(), columns);
    for (const int k : {1, 2, 63, 64, 65, 500, 4096}) {
      const auto query = random_query(random, columns, smooth);
      expect_same(index, query, k, brute_force(rows, query, k));
    }
  }
}

// Readings wander: near rows follow one another, few directions carry most of the variation.
FeatureRows wandering_rows(Random& random, Eigen::Index rows, Eigen::Index columns) {
  const Eigen::MatrixXd mix = random.matrix(columns, 5, 1.0);
  FeatureRows out(rows, columns);
  Eigen::VectorXd now = random.column(5, 10.0);
  for (Eigen::Index r = 0; r < rows; ++r) {
    now = 0.95 * now + random.column(5, 4.0);
    out.row(r) = (mix * now + random.column(columns, 0.5)).transpose().cast<float>();
  }
  return out;
}

TEST(KnnIndex, FindsWhatBruteForceFindsInReadingsThatWander) {
  Random random(9);
  for (const Eigen::Index columns : {6, 7, 12, 24, 48}) {
    const KnnIndex index(wandering_rows(random, 20'000, columns));
    const FeatureRows queries = wandering_rows(random, 20, columns);
    for (const auto& row : queries.rowwise()) {
      const std::vector<float> query(row.begin(), row.end());
      for (const int k : {1, 256, 4096}) expect_same_but_for_near_ties(index, query, k);
    }
  }
}

TEST(KnnIndex, FindsWhatBruteForceFindsWithSilentSensors) {
  Random random(12);
  for (const Eigen::Index columns : {12, 24}) {
    const KnnIndex index(wandering_rows(random, 20'000, columns));
    const FeatureRows queries = wandering_rows(random, 12, columns);
    for (Eigen::Index q = 0; q < queries.rows(); ++q) {
      std::vector<float> query(queries.row(q).begin(), queries.row(q).end());
      const Eigen::Index silent = q % 4;  // of four sensors, three axes in every twelve columns
      for (Eigen::Index d = 0; d < columns; ++d)
        if (d % 12 / 3 == silent || (q >= 8 && d % 12 / 3 == (silent + 1) % 4))
          query[static_cast<std::size_t>(d)] = kNan;
      for (const int k : {1, 256, 4096}) expect_same_but_for_near_ties(index, query, k);
    }
  }
}

TEST(KnnIndex, FindsAllInBlocksOfFarValues) {
  Random random(13);
  FeatureRows rows = random_rows(random, 20'000, 12, smooth);
  for (Eigen::Index r = 0; r < rows.rows(); r += 100) rows.row(r) *= 1e4F;  // coarse codes
  const KnnIndex index(rows);
  for (const int k : {1, 100, 4096})
    expect_same_but_for_near_ties(index, random_query(random, 12, smooth), k);
}

TEST(KnnIndex, AnswersAQueryOfNothing) {
  Random random(14);
  const KnnIndex index(random_rows(random, 1000, 12, smooth));
  expect_same(index, std::vector<float>(12, kNan), 3, {{0.0F, 0}, {0.0F, 1}, {0.0F, 2}});
}

TEST(KnnIndex, FindsAllWhereTheRowsOfTheSampleAreNearer) {
  Random random(10);
  FeatureRows rows = random_rows(random, 16'000, 12, smooth);
  for (Eigen::Index r = 0; r < rows.rows(); r += 32) rows.row(r) *= 1e-3F;
  const KnnIndex index(rows);
  const std::vector<float> query(12, 0.0F);
  for (const int k : {1, 400, 600, 4096}) expect_same_but_for_near_ties(index, query, k);
}

TEST(KnnIndex, OrdersManyExactTiesByRow) {
  Random random(2);
  for (const Eigen::Index columns : {2, 3, 12}) {
    const FeatureRows rows = random_rows(random, 4000, columns, on_grid);
    const KnnIndex index(rows);
    for (const int k : {1, 7, 100, 333, 1000}) {
      const auto query = random_query(random, columns, on_grid);
      expect_same(index, query, k, brute_force(rows, query, k));
    }
  }
}

TEST(KnnIndex, OrdersRowsThatAllEqualTheQuery) {
  Random random(3);
  FeatureRows rows = FeatureRows::Constant(3000, 12, 1.5F);
  for (int r = 0; r < 100; ++r) rows(random.below(3000), random.below(12)) = 0.0F;
  const KnnIndex index(rows);
  const std::vector<float> query(12, 1.5F);
  for (const int k : {1, 3, 64, 200, 2999})
    expect_same(index, query, k, brute_force(rows, query, k));
}

TEST(KnnIndex, GivesAllRowsWhenAskedForMore) {
  Random random(4);
  const FeatureRows rows = random_rows(random, 50, 12, smooth);
  const auto query = random_query(random, 12, smooth);
  expect_same(KnnIndex(rows), query, 1000, brute_force(rows, query, 50));
  const FeatureRows single = rows.topRows(1);
  expect_same(KnnIndex(single), query, 5, brute_force(single, query, 1));
}

TEST(KnnIndex, NeverGivesExcludedRows) {
  Random random(5);
  const FeatureRows rows = random_rows(random, 3000, 12, smooth);
  std::vector<bool> is_searched;
  for (int r = 0; r < 3000; ++r) is_searched.push_back(random.below(3) == 0);
  const KnnIndex index(rows, is_searched);
  EXPECT_EQ(index.num_rows(), std::count(is_searched.begin(), is_searched.end(), true));
  for (const int k : {1, 100, 5000}) {
    const auto query = random_query(random, 12, smooth);
    expect_same(index, query, k, brute_force(rows, query, k, is_searched));
  }
}

TEST(KnnIndex, LeavesSilentDimensionsOut) {
  Random random(6);
  const FeatureRows rows = random_rows(random, 2000, 12, on_grid);
  const KnnIndex index(rows);
  for (int silent = 1; silent <= 12; ++silent) {
    auto query = random_query(random, 12, on_grid);
    std::fill(query.begin(), query.begin() + silent, kNan);
    expect_same(index, query, 300, brute_force(rows, query, 300));
  }
}

TEST(KnnIndex, FindsNeighboursOfAQueryFarAway) {
  Random random(7);
  const FeatureRows rows = random_rows(random, 1000, 12, on_grid);
  const KnnIndex index(rows);
  std::vector<float> query(12, 0.0F);
  query[3] = 1000.0F;
  std::vector<Neighbour> found;
  index.search(query, 100, found);
  const auto expected = brute_force(rows, query, 100);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_NEAR(found[i].distance, expected[i].distance, 1e-3F);
}

TEST(KnnIndex, AnswersAQueryThatIsInfinite) {
  Random random(11);
  const KnnIndex index(random_rows(random, 1000, 12, smooth));
  std::vector<float> query(12, 0.0F);
  query[5] = std::numeric_limits<float>::infinity();
  std::vector<Neighbour> found;
  index.search(query, 100, found);
  EXPECT_LE(found.size(), 100U);
}

TEST(KnnIndex, AnswersSeveralThreadsAtOnce) {
  Random random(8);
  const FeatureRows rows = random_rows(random, 3000, 12, smooth);
  KnnIndex built(rows);
  const KnnIndex index = std::move(built);
  std::vector<std::thread> threads;
  for (unsigned seed = 0; seed < 4; ++seed)
    threads.emplace_back([&, seed] {
      Random own(100 + seed);
      for (int trial = 0; trial < 20; ++trial) {
        const auto query = random_query(own, 12, smooth);
        expect_same(index, query, 50, brute_force(rows, query, 50));
      }
    });
  for (auto& thread : threads) thread.join();
}

}  // namespace
}  // namespace sparse_mocap::retrieval
