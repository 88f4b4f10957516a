// SPDX-License-Identifier: GPL-3.0-or-later
//
// exact_knn SIZE DIMENSIONS [QUERIES]: compares the K = 4096 nearest rows of recorded motion with
// those that a scan of all rows finds, for half of the queries among rows that are rounded, so that
// many are equally far; every other query has a sensor that is silent. Ends with code 1 when they
// differ.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "recorded.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::testing {
namespace {

using retrieval::FeatureRows;
using retrieval::KnnIndex;
using retrieval::Neighbour;

constexpr int kNeighbours = 4096;

// Squared, in the dimensions that a query has, in numbers that hardly round.
double squared_distance(const FeatureRows& rows, Eigen::Index row,
                        const Eigen::RowVectorXf& query) {
  double sum = 0.0;
  for (Eigen::Index d = 0; d < query.size(); ++d) {
    if (std::isnan(query[d])) continue;
    const double difference = static_cast<double>(query[d]) - static_cast<double>(rows(row, d));
    sum += difference * difference;
  }
  return sum;
}

constexpr double kRounding = 1e-5;  // of floats, as a part of a squared distance

// A query, what was found for it, and what is wrong with that ("" where nothing is).
struct Asked {
  Eigen::RowVectorXf query;
  std::vector<Neighbour> found;
  std::vector<bool> is_found;  // of all rows
  double farthest = 0.0;       // squared distance of the last row found
  std::string problem;
};

// Whether an answer is ascending by distance and row, with the right distances. Of rows that are
// equally far the first ones win, where floats hold all distances exactly (is_whole).
std::string fault_of_order(const FeatureRows& rows, bool is_whole, const Asked& asked) {
  if (static_cast<int>(asked.found.size()) != kNeighbours) return "another number of rows";
  double before = 0.0;
  for (std::size_t i = 0; i < asked.found.size(); ++i) {
    const auto [distance, row] = asked.found[i];
    const double exact = squared_distance(rows, row, asked.query);
    if (i > 0 && asked.found[i - 1].distance > distance) return "not in order";
    if (is_whole && i > 0 && before == exact && asked.found[i - 1].row > row)
      return "equally far rows not in order";
    before = exact;
    const auto squared = static_cast<double>(distance) * static_cast<double>(distance);
    if (std::abs(squared - exact) > kRounding * (exact + 1e-6)) return "a wrong distance";
  }
  return "";
}

// Whether a row that was left out belongs to the answer.
std::string fault_of_row(const FeatureRows& rows, bool is_whole, const Asked& asked,
                         Eigen::Index row) {
  if (asked.is_found[static_cast<std::size_t>(row)]) return "";
  const double exact = squared_distance(rows, row, asked.query);
  if (exact < asked.farthest * (1.0 - kRounding)) return "a nearer row is left out";
  const bool is_earlier = row < asked.found.back().row;
  return is_whole && exact == asked.farthest && is_earlier ? "an earlier row is left out" : "";
}

// Looks at all rows, for many queries at once. Most rows are far away: what |r|^2 - 2 r.q + |q|^2
// comes to in floats tells, with much room for its rounding.
void look_for_rows_left_out(const FeatureRows& rows, bool is_whole, std::vector<Asked>& all) {
  constexpr Eigen::Index kPiece = 4096;     // rows
  constexpr float kRoundingOfSums = 1e-4F;  // as a part of the sums' terms
  const auto count = static_cast<Eigen::Index>(all.size());
  Eigen::MatrixXf is_known(rows.cols(), count), queries(rows.cols(), count);
  Eigen::RowVectorXf limits(count);
  for (Eigen::Index q = 0; q < count; ++q) {
    const auto column = all[static_cast<std::size_t>(q)].query.transpose().array();
    is_known.col(q) = (!column.isNaN()).cast<float>();
    queries.col(q) = column.isNaN().select(Eigen::ArrayXf::Zero(rows.cols()), column);
    limits[q] = static_cast<float>(all[static_cast<std::size_t>(q)].farthest);
  }
  const Eigen::RowVectorXf lengths = queries.colwise().squaredNorm();
  for (Eigen::Index begin = 0; begin < rows.rows(); begin += kPiece) {
    const auto piece = rows.middleRows(begin, std::min(kPiece, rows.rows() - begin));
    const Eigen::MatrixXf squares = piece.cwiseAbs2() * is_known;
    const Eigen::MatrixXf products = piece * queries;
    for (Eigen::Index q = 0; q < count; ++q) {
      Asked& asked = all[static_cast<std::size_t>(q)];
      const auto sums = squares.col(q).array() + lengths[q];
      const auto is_near = sums - 2.0F * products.col(q).array() <=
                           limits[q] * (1.0F + kRoundingOfSums) + kRoundingOfSums * sums;
      for (Eigen::Index i = 0; i < piece.rows() && asked.problem.empty(); ++i)
        if (is_near[i]) asked.problem = fault_of_row(rows, is_whole, asked, begin + i);
    }
  }
}

// To even numbers: squares of their differences are whole.
FeatureRows rounded(const FeatureRows& rows) { return (rows.array() * 0.5F).round() * 2.0F; }

// Every other query lacks a sensor.
Asked asked_of(const FeatureRows& queries, int number, Random& random) {
  Asked asked{queries.row(random.below(static_cast<int>(queries.rows()))), {}, {}, 0.0, ""};
  if (number % 2 == 0) return asked;
  const int silent = 3 * random.below(4);
  for (Eigen::Index part = 0; part < queries.cols(); part += 12)
    asked.query.segment<3>(part + silent).setConstant(NAN);
  return asked;
}

int compare(const FeatureRows& rows, bool is_whole, const FeatureRows& queries, int num_queries) {
  constexpr int kAtOnce = 64;  // queries
  const KnnIndex index{FeatureRows(rows)};
  Random random(1);
  int num_wrong = 0;
  for (int begin = 0; begin < num_queries; begin += kAtOnce) {
    std::vector<Asked> all;
    for (int q = begin; q < std::min(begin + kAtOnce, num_queries); ++q) {
      Asked& asked = all.emplace_back(asked_of(queries, q, random));
      index.search({asked.query.data(), static_cast<std::size_t>(rows.cols())}, kNeighbours,
                   asked.found);
      asked.is_found.resize(static_cast<std::size_t>(rows.rows()));
      for (const auto& [distance, row] : asked.found)
        asked.is_found[static_cast<std::size_t>(row)] = true;
      asked.farthest = squared_distance(rows, asked.found.back().row, asked.query);
      asked.problem = fault_of_order(rows, is_whole, asked);
    }
    look_for_rows_left_out(rows, is_whole, all);
    for (std::size_t q = 0; q < all.size(); ++q) {
      if (all[q].problem.empty()) continue;
      if (num_wrong++ == 0)
        std::cout << "query " << begin + static_cast<int>(q) << ": " << all[q].problem << '\n';
    }
  }
  return num_wrong;
}

int run(const std::string& size, int dimensions, int num_queries) {
  const auto [rows, queries] = searched_rows(size, dimensions, 1);
  const int plain = compare(rows, false, queries, num_queries / 2);
  const int tied = compare(rounded(rows), true, rounded(queries), num_queries / 2);
  std::cout << size << ", " << dimensions << " dimensions, " << rows.rows() << " rows, "
            << num_queries << " queries: " << plain << " and, with ties, " << tied << " wrong\n";
  return plain + tied == 0 ? 0 : 1;
}

}  // namespace
}  // namespace sparse_mocap::testing

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: exact_knn SIZE DIMENSIONS [QUERIES]\n";
    return 2;
  }
  try {
    return sparse_mocap::testing::run(argv[1], std::atoi(argv[2]),
                                      argc > 3 ? std::atoi(argv[3]) : 10'000);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
