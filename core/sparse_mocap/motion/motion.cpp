// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace sparse_mocap {
namespace {

std::size_t rotation_index(const Motion& motion, int frame, int joint) {
  return static_cast<std::size_t>(frame) * static_cast<std::size_t>(motion.skeleton.num_joints()) +
         static_cast<std::size_t>(joint);
}

Vec3 mirrored_vector(const Vec3& v) { return {-v.x(), v.y(), v.z()}; }

// R seen in the mirror: M R M with M = diag(-1, 1, 1).
Quat mirrored_rotation(const Quat& q) { return {q.w(), q.x(), -q.y(), -q.z()}; }

Mat3 mirrored_axes(const Mat3& R) { return mirrored_rotation(Quat(R)).toRotationMatrix(); }

// Every name this one may have on the other side.
std::vector<std::string> mirrored_names(const std::string& name) {
  std::vector<std::string> names;
  const auto swap_word = [&](const std::string& from, const std::string& to) {
    const auto at = name.find(from);
    if (at != std::string::npos)
      names.push_back(name.substr(0, at) + to + name.substr(at + from.size()));
  };
  for (const auto& [l, r] : std::array<std::pair<const char*, const char*>, 3>{
           {{"left", "right"}, {"Left", "Right"}, {"LEFT", "RIGHT"}}}) {
    swap_word(l, r);
    swap_word(r, l);
  }
  const auto swap_letter = [&](std::size_t at) {
    static const std::string kLetters = "lrLR";
    static const std::string kSwapped = "rlRL";
    const auto which = kLetters.find(name[at]);
    if (which == std::string::npos) return;
    std::string other = name;
    other[at] = kSwapped[which];
    names.push_back(other);
  };
  swap_letter(0);
  swap_letter(name.size() - 1);
  for (std::size_t i = 1; i + 1 < name.size(); ++i)
    if (name[i - 1] == '_' || name[i - 1] == ':' || name[i - 1] == '.') swap_letter(i);
  return names;
}

// Where a sample time lies between frames of an evenly sampled motion.
struct Bracket {
  int frame = 0;
  double fraction = 0.0;
};

Bracket bracket(double time_s, double frame_time_s, int num_frames) {
  const double position = std::clamp(time_s / frame_time_s, 0.0, num_frames - 1.0);
  const int frame = std::min(static_cast<int>(position), std::max(num_frames - 2, 0));
  return {frame, num_frames > 1 ? position - frame : 0.0};
}

// Gaussian weights at whole frames around a centre; one weight when sigma is zero.
std::vector<double> gaussian_weights(double sigma_frames) {
  const int reach = static_cast<int>(std::ceil(3.0 * sigma_frames));
  std::vector<double> weights;
  for (int i = -reach; i <= reach; ++i)
    weights.push_back(sigma_frames > 0.0 ? std::exp(-0.5 * i * i / (sigma_frames * sigma_frames))
                                         : 1.0);
  return weights;
}

std::vector<Vec3> smoothed(const std::vector<Vec3>& values, const std::vector<double>& weights) {
  if (weights.size() == 1) return values;
  const int reach = static_cast<int>(weights.size() / 2);
  const int n = static_cast<int>(values.size());
  std::vector<Vec3> out(values.size());
  for (int t = 0; t < n; ++t) {
    Vec3 sum = Vec3::Zero();
    double total = 0.0;
    for (int i = -reach; i <= reach; ++i) {
      const int s = std::clamp(t + i, 0, n - 1);
      const double w = weights[static_cast<std::size_t>(i + reach)];
      sum += w * values[static_cast<std::size_t>(s)];
      total += w;
    }
    out[static_cast<std::size_t>(t)] = sum / total;
  }
  return out;
}

// The weighted mean of rotations close to each other: their quaternions averaged in one hemisphere.
void smooth_rotations(Motion& motion, const std::vector<double>& weights) {
  if (weights.size() == 1) return;
  const int reach = static_cast<int>(weights.size() / 2);
  const Motion original = motion;
  const int n = motion.num_frames();
  for (int t = 0; t < n; ++t) {
    for (int j = 0; j < motion.skeleton.num_joints(); ++j) {
      const Eigen::Vector4d centre = original.rotation(t, j).coeffs();
      Eigen::Vector4d sum = Eigen::Vector4d::Zero();
      for (int i = -reach; i <= reach; ++i) {
        const Eigen::Vector4d q = original.rotation(std::clamp(t + i, 0, n - 1), j).coeffs();
        const double w = weights[static_cast<std::size_t>(i + reach)];
        sum += (q.dot(centre) < 0.0 ? -w : w) * q;
      }
      motion.rotation(t, j) = Quat(Eigen::Vector4d(sum.normalized()));
    }
  }
}

Motion low_passed(const Motion& motion, double sigma_frames) {
  Motion out = motion;
  const auto weights = gaussian_weights(sigma_frames);
  out.root_positions = smoothed(motion.root_positions, weights);
  for (auto& track : out.offset_tracks)
    track.offset_parent = smoothed(track.offset_parent, weights);
  smooth_rotations(out, weights);
  return out;
}

Vec3 interpolated(const std::vector<Vec3>& values, Bracket at) {
  const auto i = static_cast<std::size_t>(at.frame);
  if (at.fraction == 0.0) return values[i];
  return (1.0 - at.fraction) * values[i] + at.fraction * values[i + 1];
}

}  // namespace

const Quat& Motion::rotation(int frame, int joint) const {
  return rotations[rotation_index(*this, frame, joint)];
}

Quat& Motion::rotation(int frame, int joint) {
  return rotations[rotation_index(*this, frame, joint)];
}

JointTransforms Motion::transforms(int frame) const {
  const int n = skeleton.num_joints();
  std::vector<Mat3> R_joint(static_cast<std::size_t>(n));
  for (int j = 0; j < n; ++j)
    R_joint[static_cast<std::size_t>(j)] = rotation(frame, j).toRotationMatrix();
  JointTransforms out;
  const auto f = static_cast<std::size_t>(frame);
  if (offset_tracks.empty()) {
    forward_kinematics(skeleton, root_positions[f], R_joint, out);
    return out;
  }
  std::vector<Vec3> offsets;
  for (const auto& joint : skeleton.joints()) offsets.push_back(joint.offset_parent);
  for (const auto& track : offset_tracks)
    offsets[static_cast<std::size_t>(track.joint)] = track.offset_parent[f];
  forward_kinematics(skeleton, offsets, root_positions[f], R_joint, out);
  return out;
}

Motion trimmed(const Motion& motion, int begin, int end) {
  if (begin < 0 || begin >= end || end > motion.num_frames())
    throw std::invalid_argument(
        "trimmed: frames must satisfy 0 <= begin < end <= number of frames");
  Motion out = motion;
  const auto cut = [&](std::vector<Vec3>& v) {
    v = std::vector<Vec3>(v.begin() + begin, v.begin() + end);
  };
  cut(out.root_positions);
  for (auto& track : out.offset_tracks) cut(track.offset_parent);
  const int joints = motion.skeleton.num_joints();
  out.rotations.assign(motion.rotations.begin() + static_cast<std::ptrdiff_t>(begin) * joints,
                       motion.rotations.begin() + static_cast<std::ptrdiff_t>(end) * joints);
  return out;
}

Motion reversed(const Motion& motion) {
  Motion out = motion;
  std::reverse(out.root_positions.begin(), out.root_positions.end());
  for (auto& track : out.offset_tracks)
    std::reverse(track.offset_parent.begin(), track.offset_parent.end());
  const int n = motion.num_frames();
  for (int t = 0; t < n; ++t)
    for (int j = 0; j < motion.skeleton.num_joints(); ++j)
      out.rotation(t, j) = motion.rotation(n - 1 - t, j);
  return out;
}

Motion mirrored(const Motion& motion, const std::vector<int>& left_right) {
  const int n = motion.skeleton.num_joints();
  if (static_cast<int>(left_right.size()) != n)
    throw std::invalid_argument("mirrored: one partner a joint is needed");
  const auto partner = [&](int j) { return left_right[static_cast<std::size_t>(j)]; };
  Motion out = motion;
  std::vector<Joint> joints = motion.skeleton.joints();
  for (int j = 0; j < n; ++j) {
    if (partner(partner(j)) != j)
      throw std::invalid_argument("mirrored: partners must name each other");
    const Joint& source = motion.skeleton.joint(partner(j));
    Joint& joint = joints[static_cast<std::size_t>(j)];
    if (source.parent >= 0 && partner(source.parent) != joint.parent)
      throw std::invalid_argument("mirrored: the two sides hang on different joints");
    joint.offset_parent = mirrored_vector(source.offset_parent);
    joint.bone = mirrored_vector(source.bone);
    joint.R_joint_axes = mirrored_axes(source.R_joint_axes);
    joint.axes = source.axes;
  }
  out.skeleton = Skeleton(std::move(joints));
  for (auto& p : out.root_positions) p = mirrored_vector(p);
  for (auto& track : out.offset_tracks) {
    track.joint = partner(track.joint);
    for (auto& v : track.offset_parent) v = mirrored_vector(v);
  }
  for (int t = 0; t < motion.num_frames(); ++t)
    for (int j = 0; j < n; ++j)
      out.rotation(t, j) = mirrored_rotation(motion.rotation(t, partner(j)));
  return out;
}

std::vector<int> left_right_pairs(const Skeleton& skeleton) {
  std::vector<int> pairs;
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    int partner = j;
    for (const auto& name : mirrored_names(skeleton.joint(j).name)) {
      const int found = skeleton.find(name);
      if (found >= 0 && found != j) partner = found;
    }
    pairs.push_back(partner);
  }
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    auto& partner = pairs[static_cast<std::size_t>(j)];
    if (pairs[static_cast<std::size_t>(partner)] != j) partner = j;
  }
  return pairs;
}

Motion resampled(const Motion& motion, double rate_hz) {
  if (!(rate_hz > 0.0)) throw std::invalid_argument("resampled: the rate must be positive");
  if (motion.num_frames() == 0) return motion;
  const double ratio = 1.0 / (rate_hz * motion.frame_time_s);
  if (std::abs(ratio - 1.0) < 1e-9) return motion;
  // A third of a new frame: -3 dB near 0.4 of the new rate.
  const Motion source = ratio > 1.0 ? low_passed(motion, ratio / 3.0) : motion;
  Motion out;
  out.skeleton = motion.skeleton;
  out.frame_time_s = 1.0 / rate_hz;
  const double last_s = motion.frame_time_s * (motion.num_frames() - 1);
  const int frames = static_cast<int>(std::floor(last_s * rate_hz + 1e-6)) + 1;
  out.offset_tracks = motion.offset_tracks;
  for (auto& track : out.offset_tracks) track.offset_parent.clear();
  for (int t = 0; t < frames; ++t) {
    const Bracket at = bracket(t / rate_hz, motion.frame_time_s, motion.num_frames());
    out.root_positions.push_back(interpolated(source.root_positions, at));
    for (std::size_t k = 0; k < out.offset_tracks.size(); ++k)
      out.offset_tracks[k].offset_parent.push_back(
          interpolated(source.offset_tracks[k].offset_parent, at));
    for (int j = 0; j < motion.skeleton.num_joints(); ++j)
      out.rotations.push_back(
          at.fraction == 0.0
              ? source.rotation(at.frame, j)
              : source.rotation(at.frame, j).slerp(at.fraction, source.rotation(at.frame + 1, j)));
  }
  return out;
}

}  // namespace sparse_mocap
