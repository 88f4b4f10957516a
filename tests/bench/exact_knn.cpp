// SPDX-License-Identifier: GPL-3.0-or-later
//
// exact_knn SIZE DIMENSIONS [QUERIES]: compares the K = 4096 nearest rows of recorded motion with
// those that a scan of all rows finds, for half of the queries among rows that are rounded, so that
// many are equally far; every other query has a sensor that is silent. Ends with code 1 when they
// differ.
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

// What is wrong with an answer, "" where nothing is: ascending by distance and row, distances
// right, no row that was left out nearer than the last one.
// Of rows that are equally far the first ones win, where floats hold all distances exactly.
std::string fault(const FeatureRows& rows, bool is_whole, const Eigen::RowVectorXf& query,
                  const std::vector<Neighbour>& found) {
  constexpr double kRounding = 1e-5;  // of floats, as a part of a squared distance
  if (static_cast<int>(found.size()) != kNeighbours) return "another number of rows";
  std::vector<bool> is_found(static_cast<std::size_t>(rows.rows()), false);
  double before = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto [distance, row] = found[i];
    const double exact = squared_distance(rows, row, query);
    if (i > 0 && found[i - 1].distance > distance) return "not in order";
    if (is_whole && i > 0 && before == exact && found[i - 1].row > row)
      return "equally far rows not in order";
    before = exact;
    const auto squared = static_cast<double>(distance) * static_cast<double>(distance);
    if (std::abs(squared - exact) > kRounding * (exact + 1e-6)) return "a wrong distance";
    is_found[static_cast<std::size_t>(row)] = true;
  }
  const double farthest = squared_distance(rows, found.back().row, query);
  const auto near = static_cast<float>(farthest * (1.0 + 10.0 * kRounding));
  const Eigen::RowVectorXf is_known = query.array().isNaN().select(
      Eigen::RowVectorXf::Zero(query.size()), Eigen::RowVectorXf::Ones(query.size()));
  const Eigen::RowVectorXf asked =
      query.array().isNaN().select(Eigen::RowVectorXf::Zero(query.size()), query);
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    // In floats first: most rows are far away.
    if ((rows.row(r) - asked).cwiseProduct(is_known).squaredNorm() > near) continue;
    if (is_found[static_cast<std::size_t>(r)]) continue;
    const double exact = squared_distance(rows, r, query);
    if (exact < farthest * (1.0 - kRounding)) return "a nearer row is left out";
    if (is_whole && exact == farthest && r < found.back().row) return "an earlier row is left out";
  }
  return "";
}

// To even numbers: squares of their differences are whole.
FeatureRows rounded(const FeatureRows& rows) { return (rows.array() * 0.5F).round() * 2.0F; }

int compare(const FeatureRows& rows, bool is_whole, const FeatureRows& queries, int num_queries) {
  const KnnIndex index{FeatureRows(rows)};
  const auto num_columns = rows.cols();
  Random random(1);
  std::vector<Neighbour> found;
  int num_wrong = 0;
  for (int q = 0; q < num_queries; ++q) {
    Eigen::RowVectorXf query = queries.row(random.below(static_cast<int>(queries.rows())));
    if (q % 2 == 1) {
      const int silent = 3 * random.below(4);
      for (Eigen::Index part = 0; part < num_columns; part += 12)
        query.segment<3>(part + silent).setConstant(NAN);
    }
    index.search({query.data(), static_cast<std::size_t>(num_columns)}, kNeighbours, found);
    const std::string problem = fault(rows, is_whole, query, found);
    if (problem.empty()) continue;
    if (num_wrong++ == 0) std::cout << "query " << q << ": " << problem << '\n';
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
