// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/phase_recognition.hpp"

#include <algorithm>

namespace sparse_mocap::eom2014 {
namespace {

constexpr double kLevelSlope = 0.5;  // in deviations of a channel's slopes

ReadingRows slopes_of(const ReadingRows& readings) {
  const Eigen::Index n = readings.rows();
  ReadingRows out = ReadingRows::Zero(n, 6);
  for (Eigen::Index t = 0; t < n; ++t) {
    const Eigen::Index before = std::max<Eigen::Index>(t - 1, 0), after = std::min(t + 1, n - 1);
    if (after > before)
      out.row(t) =
          (readings.row(after) - readings.row(before)) / static_cast<double>(after - before);
  }
  return out;
}

// Stretches of one phase.
std::vector<Symbols> stretches(const Symbols& symbols, const std::vector<Phase>& phases,
                               Phase phase) {
  std::vector<Symbols> out;
  for (std::size_t begin = 0, end = 0; begin < phases.size(); begin = end) {
    while (end < phases.size() && phases[end] == phases[begin]) ++end;
    if (phases[begin] == phase)
      out.emplace_back(symbols.middleRows(static_cast<Eigen::Index>(begin),
                                          static_cast<Eigen::Index>(end - begin)));
  }
  return out;
}

}  // namespace

PhaseRecognition PhaseRecognition::trained(const std::vector<ReadingRows>& readings,
                                           const std::vector<std::vector<Phase>>& phases) {
  PhaseRecognition out;
  Eigen::Matrix<double, 1, 6> squares = Eigen::Matrix<double, 1, 6>::Zero();
  double num_frames = 0.0;
  for (const auto& rows : readings) {
    squares += slopes_of(rows).colwise().squaredNorm();
    num_frames += static_cast<double>(rows.rows());
  }
  out.level_slope = kLevelSlope * (squares / num_frames).cwiseSqrt();
  for (int p = 0; p < kNumPhases; ++p) {
    std::vector<Symbols> sequences;
    for (std::size_t i = 0; i < readings.size(); ++i)
      for (auto& stretch : stretches(out.discrete(readings[i]), phases[i], static_cast<Phase>(p)))
        sequences.push_back(std::move(stretch));
    if (sequences.empty()) continue;
    out.phases.push_back(static_cast<Phase>(p));
    out.models.push_back(eom2014::trained(sequences, HmmSettings()));
  }
  return out;
}

Symbols PhaseRecognition::discrete(const ReadingRows& readings) const {
  const ReadingRows slopes = slopes_of(readings);
  Symbols symbols = Symbols::Ones(slopes.rows(), slopes.cols());
  for (Eigen::Index t = 0; t < slopes.rows(); ++t)
    for (Eigen::Index c = 0; c < slopes.cols(); ++c) {
      if (slopes(t, c) > level_slope[c]) symbols(t, c) = 2;
      if (slopes(t, c) < -level_slope[c]) symbols(t, c) = 0;
    }
  return symbols;
}

std::vector<Phase> PhaseRecognition::recognised(const ReadingRows& readings,
                                                int vote_frames) const {
  const Symbols symbols = discrete(readings);
  const Eigen::Index n = symbols.rows();
  const Eigen::Index length = std::min<Eigen::Index>(vote_frames, n);
  const auto num_phases = static_cast<Eigen::Index>(phases.size());
  // Where two phases have as many votes, the likelier one wins.
  constexpr double kTieBreak = 1e-6;
  Eigen::MatrixXd votes = Eigen::MatrixXd::Zero(n, num_phases);
  for (Eigen::Index begin = 0; begin + length <= n; ++begin) {
    const Symbols window = symbols.middleRows(begin, length);
    Eigen::RowVectorXd ballot(num_phases);
    for (Eigen::Index p = 0; p < num_phases; ++p)
      ballot[p] = models[static_cast<std::size_t>(p)].log_likelihood(window);
    Eigen::Index best = 0;
    ballot.maxCoeff(&best);
    ballot *= kTieBreak;
    ballot[best] += 1.0;
    votes.middleRows(begin, length).rowwise() += ballot;
  }
  std::vector<Phase> out;
  for (Eigen::Index t = 0; t < n; ++t) {
    Eigen::Index best = 0;
    votes.row(t).maxCoeff(&best);
    out.push_back(phases[static_cast<std::size_t>(best)]);
  }
  return out;
}

}  // namespace sparse_mocap::eom2014
