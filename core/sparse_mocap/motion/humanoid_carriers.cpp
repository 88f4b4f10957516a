// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/humanoid_carriers.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <limits>

namespace sparse_mocap {
namespace {

using namespace standard_joint;

std::size_t at(int j) { return static_cast<std::size_t>(j); }

// A way along the source's body: the joints one after another, each moving the stretch from its
// pivot to the next one's, and where the last stretch ends.
class Way {
 public:
  Way(const Skeleton& source, const JointTransforms& posture, int first, int last,
      const Vec3& end) {
    if (first < 0 || last < 0) return;
    joints_ = path_down(source, first, last);
    if (joints_.empty() && first != last) return;
    joints_.insert(joints_.begin(), first);
    for (const int j : joints_) knots_.push_back(posture.pivot[at(j)]);
    knots_.push_back(end);
    lengths_.push_back(0.0);
    for (std::size_t i = 0; i < joints_.size(); ++i)
      lengths_.push_back(lengths_.back() + (knots_[i + 1] - knots_[i]).norm());
  }

  // The joints that move the way from one point to another, each by its share.
  std::vector<Carrier> carriers(const Vec3& begin, const Vec3& end) const {
    constexpr double kNoShare = 1e-3;
    std::vector<Carrier> found;
    if (joints_.empty()) return found;
    const double from = place(begin, 0.0), to = place(end, from);
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const double share = std::min(to, lengths_[i + 1]) - std::max(from, lengths_[i]);
      if (share > kNoShare * (to - from) && share > 0.0) found.push_back({joints_[i], share});
    }
    double sum = 0.0;
    for (const auto& carrier : found) sum += carrier.weight;
    for (auto& carrier : found) carrier.weight /= sum;
    return found;
  }

 private:
  // How far along the way a point is, not before `least`.
  double place(const Vec3& point, double least) const {
    double best = least, nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const Vec3 stretch = knots_[i + 1] - knots_[i];
      const double length = lengths_[i + 1] - lengths_[i];
      const double along =
          length > 0.0 ? std::clamp((point - knots_[i]).dot(stretch) / length, 0.0, length) : 0.0;
      const Vec3 there = length > 0.0 ? Vec3(knots_[i] + stretch * along / length) : knots_[i];
      const double distance = (point - there).norm();
      if (lengths_[i] + along < least || distance >= nearest) continue;
      nearest = distance;
      best = lengths_[i] + along;
    }
    return best;
  }

  std::vector<int> joints_;
  std::vector<Vec3> knots_;      // one more than joints
  std::vector<double> lengths_;  // up to each knot
};

}  // namespace

Carriers find_carriers(const Skeleton& source, const SourceJoints& joints,
                       const StandardPoints& points, const JointTransforms& posture) {
  Carriers found;
  for (std::size_t j = 0; j < found.size(); ++j)
    if (joints.standard[j] >= 0) found[j] = {Carrier{joints.standard[j]}};
  const auto carry = [&](const Way& way, std::initializer_list<Index> bones) {
    for (const auto j : bones) {
      auto carriers = way.carriers(points.begin[j], points.end[j]);
      if (!carriers.empty()) found[j] = std::move(carriers);
    }
  };
  const auto way = [&](int first, int last, Index end) {
    return Way(source, posture, first, last, points.end[end]);
  };
  const auto& of = joints.standard;
  int top = -1;
  Index top_bone = thorax;
  for (const auto j : {lowerback, upperback, thorax, lowerneck, upperneck, head}) {
    if (of[j] < 0) continue;
    top = of[j];
    top_bone = j;
  }
  const Way trunk = way(of[root], top, top_bone);
  carry(trunk, {lowerback, upperback, thorax});
  if (of[head] >= 0 || of[lowerneck] >= 0) carry(trunk, {lowerneck, upperneck, head});
  const auto last = [](int below, int otherwise) { return below >= 0 ? below : otherwise; };
  carry(way(of[lfemur], last(joints.ankle[0], of[ltibia]), ltibia), {lfemur, ltibia});
  carry(way(of[rfemur], last(joints.ankle[1], of[rtibia]), rtibia), {rfemur, rtibia});
  carry(way(of[lhumerus], last(of[lwrist], of[lradius]), lradius), {lhumerus, lradius});
  carry(way(of[rhumerus], last(of[rwrist], of[rradius]), rradius), {rhumerus, rradius});
  return found;
}

Mat3 carried_rotation(const std::vector<Carrier>& carriers,
                      const std::vector<Mat3>& R_world_joint) {
  if (carriers.size() == 1)
    return R_world_joint[at(carriers[0].joint)] * carriers[0].R_joint_standard;
  Mat3 sum = Mat3::Zero();
  for (const auto& carrier : carriers)
    sum += carrier.weight * R_world_joint[at(carrier.joint)] * carrier.R_joint_standard;
  const Eigen::JacobiSVD<Mat3> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * Vec3(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
}

}  // namespace sparse_mocap
