// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/joint_mapping.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <limits>

namespace sparse_mocap {
namespace {

using namespace standard_joint;

std::size_t at(int j) { return static_cast<std::size_t>(j); }

// Joints one after another along a rig's body, each turning the stretch from its pivot to the next
// one's, and where the last stretch ends.
class JointChain {
 public:
  JointChain(const Skeleton& rig, const JointTransforms& pose, int first, int last,
             const Vec3& end) {
    if (first < 0 || last < 0) return;
    joints_ = path_down(rig, first, last);
    if (joints_.empty() && first != last) return;
    joints_.insert(joints_.begin(), first);
    for (const int j : joints_) knots_.push_back(pose.pivot[at(j)]);
    knots_.push_back(end);
    lengths_.push_back(0.0);
    for (std::size_t i = 0; i < joints_.size(); ++i)
      lengths_.push_back(lengths_.back() + (knots_[i + 1] - knots_[i]).norm());
  }

  // The joints that turn the stretch from one point to another, each weighted by its share of it.
  std::vector<MappedJoint> joints_between(const Vec3& begin, const Vec3& end) const {
    constexpr double kNoShare = 1e-3;
    std::vector<MappedJoint> found;
    if (joints_.empty()) return found;
    const double from = distance_along(begin, 0.0), to = distance_along(end, from);
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const double share = std::min(to, lengths_[i + 1]) - std::max(from, lengths_[i]);
      if (share > kNoShare * (to - from) && share > 0.0) found.push_back({joints_[i], share});
    }
    double sum = 0.0;
    for (const auto& mapped : found) sum += mapped.weight;
    for (auto& mapped : found) mapped.weight /= sum;
    return found;
  }

 private:
  // How far along the chain a point is, not before `least`.
  double distance_along(const Vec3& point, double least) const {
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

JointMapping find_joint_mapping(const Skeleton& rig, const BodyJoints& joints,
                                const BonePositions& bones, const JointTransforms& pose) {
  JointMapping found;
  for (std::size_t j = 0; j < found.size(); ++j)
    if (joints.standard[j] >= 0) found[j] = {MappedJoint{joints.standard[j]}};
  const auto map = [&](const JointChain& chain, std::initializer_list<Index> standard) {
    for (const auto j : standard) {
      auto mapped = chain.joints_between(bones.begin[j], bones.end[j]);
      if (!mapped.empty()) found[j] = std::move(mapped);
    }
  };
  const auto chain = [&](int first, int last, Index end) {
    return JointChain(rig, pose, first, last, bones.end[end]);
  };
  const auto& of = joints.standard;
  int top = -1;
  Index top_bone = thorax;
  for (const auto j : {lowerback, upperback, thorax, lowerneck, upperneck, head}) {
    if (of[j] < 0) continue;
    top = of[j];
    top_bone = j;
  }
  const JointChain trunk = chain(of[root], top, top_bone);
  map(trunk, {lowerback, upperback, thorax});
  if (of[head] >= 0 || of[lowerneck] >= 0) map(trunk, {lowerneck, upperneck, head});
  const auto last = [](int below, int otherwise) { return below >= 0 ? below : otherwise; };
  map(chain(of[lfemur], last(joints.ankle[0], of[ltibia]), ltibia), {lfemur, ltibia});
  map(chain(of[rfemur], last(joints.ankle[1], of[rtibia]), rtibia), {rfemur, rtibia});
  map(chain(of[lhumerus], last(of[lwrist], of[lradius]), lradius), {lhumerus, lradius});
  map(chain(of[rhumerus], last(of[rwrist], of[rradius]), rradius), {rhumerus, rradius});
  return found;
}

Mat3 mapped_rotation(const std::vector<MappedJoint>& joints,
                     const std::vector<Mat3>& R_world_joint) {
  if (joints.size() == 1) return R_world_joint[at(joints[0].joint)] * joints[0].R_joint_standard;
  Mat3 sum = Mat3::Zero();
  for (const auto& mapped : joints)
    sum += mapped.weight * R_world_joint[at(mapped.joint)] * mapped.R_joint_standard;
  return nearest_rotation(sum);
}

Mat3 nearest_rotation(const Mat3& sum) {
  const Eigen::JacobiSVD<Mat3> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * Vec3(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
}

}  // namespace sparse_mocap
