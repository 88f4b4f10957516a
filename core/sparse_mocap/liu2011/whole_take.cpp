// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/whole_take.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

#include "sparse_mocap/base/ordered_work.hpp"
#include "sparse_mocap/liu2011/map_estimate.hpp"

namespace sparse_mocap::liu2011 {
namespace {

constexpr int kSweeps = 4, kSteps = 3;
constexpr double kRootPerAngle_m = 0.3;  // as far as an angle turns what hangs on it

BodyPose pose_of(const PoseEstimate& estimate) {
  BodyPose pose{estimate.root_position, {}};
  for (const Quat& q : estimate.rotations) pose.rotations.push_back(q.toRotationMatrix());
  return pose;
}

// What the other poses say of one: a second difference of which it has the factor `own`, the rest
// being the neighbours' vectors about it.
struct Difference {
  double own;
  std::array<std::pair<int, double>, 2> others;  // frames from it, factors
};
constexpr std::array<Difference, 3> kDifferences{Difference{1.0, {{{-1, -2.0}, {-2, 1.0}}}},
                                                 Difference{-2.0, {{{-1, 1.0}, {1, 1.0}}}},
                                                 Difference{1.0, {{{1, -2.0}, {2, 1.0}}}}};

// The prior of a frame, given the others: about the pose itself, one row a degree of freedom.
PosePrior prior_of(const Skeleton& body, const std::vector<BodyPose>& poses, std::size_t t,
                   const BodyPose& mean, const Config& config) {
  const Eigen::Index n = num_freedoms(body);
  const double per_agreement = 1.0 / std::pow(config.agreement_deg * kRadiansPerDegree, 2);
  const double per_evenness = 1.0 / std::pow(config.evenness_deg * kRadiansPerDegree, 2);
  double weight = per_agreement;
  Eigen::VectorXd pull = per_agreement * pose_vector(body, poses[t], mean);
  for (const Difference& difference : kDifferences) {
    Eigen::VectorXd rest = Eigen::VectorXd::Zero(n);
    bool is_inside = true;
    for (const auto& [away, factor] : difference.others) {
      const auto other = static_cast<std::ptrdiff_t>(t) + away;
      is_inside = is_inside && other >= 0 && other < static_cast<std::ptrdiff_t>(poses.size());
      if (is_inside)
        rest += factor * pose_vector(body, poses[t], poses[static_cast<std::size_t>(other)]);
    }
    if (!is_inside) continue;
    weight += per_evenness * difference.own * difference.own;
    pull -= per_evenness * difference.own * rest;
  }
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(n);  // metres count as angles
  scale.head<3>().setConstant(1.0 / kRootPerAngle_m);
  const Eigen::VectorXd whitening = std::sqrt(weight) * scale;
  return {poses[t], whitening.asDiagonal(), whitening.cwiseProduct(pull / weight)};
}

}  // namespace

BodyPose middle(const Skeleton& body, const BodyPose& a, const BodyPose& b) {
  return moved(body, a, 0.5 * pose_vector(body, a, b));
}

void refine(const Skeleton& body, const std::vector<std::vector<Observation>>& observed,
            const Config& config, std::vector<BodyPose>& poses) {
  const std::vector<BodyPose> means = poses;
  const ControlWeights control = config.control();
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const std::size_t t = sweep % 2 == 0 ? i : poses.size() - 1 - i;
      const PosePrior prior = prior_of(body, poses, t, means[t], config);
      const PosteriorEnergy energy(body, observed[t], control, prior);
      poses[t] = nearest_minimum(body, energy, poses[t], kSteps).pose;
    }
}

WholeTakeReconstructor::WholeTakeReconstructor(const Config& config, const MethodContext& context)
    : config_(config),
      worn_(worn_sensors(context.body.value_or(context.database->skeleton()), context.sensors)),
      forward_(config, context),
      backward_(config, context, Direction::backward),
      num_threads_(context.num_threads) {}

std::vector<PoseEstimate> WholeTakeReconstructor::solve(const std::vector<Reading>& take,
                                                        const Progress& progress) {
  const std::vector<Reading> reversed(take.rbegin(), take.rend());
  std::array<std::vector<PoseEstimate>, 2> ways;
  std::atomic<std::size_t> num_solved = 0;
  const auto solved = [&](std::size_t way, const std::stop_token& stop) {
    Reconstructor& method = way == 0 ? forward_ : backward_;
    const Progress stopping([&](const ProgressReport&) {
      ++num_solved;
      return !stop.stop_requested();
    });
    return solve_live(method, way == 0 ? take : reversed, stopping);
  };
  work_in_order(
      2, num_threads_, solved,
      [&](std::size_t way, std::vector<PoseEstimate> found) { ways[way] = std::move(found); },
      [&](std::size_t) { progress.report(num_solved, 3 * take.size(), "reconstructing"); });
  std::reverse(ways[1].begin(), ways[1].end());
  progress.report(2 * take.size(), 3 * take.size(), "smoothing");
  std::vector<BodyPose> poses;
  std::vector<std::vector<Observation>> observed;
  for (std::size_t t = 0; t < take.size(); ++t) {
    poses.push_back(middle(skeleton(), pose_of(ways[0][t]), pose_of(ways[1][t])));
    observed.push_back(observations(take[t], worn_, {}));
  }
  refine(skeleton(), observed, config_, poses);
  std::vector<PoseEstimate> estimates = std::move(ways[0]);
  for (std::size_t t = 0; t < take.size(); ++t) {
    estimates[t].root_position = poses[t].root_position;
    for (std::size_t j = 0; j < poses[t].rotations.size(); ++j)
      estimates[t].rotations[j] = Quat(poses[t].rotations[j]).normalized();
    estimates[t].contacts = 0.5 * (estimates[t].contacts + ways[1][t].contacts);
  }
  return estimates;
}

}  // namespace sparse_mocap::liu2011
