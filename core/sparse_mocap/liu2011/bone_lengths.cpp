// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/bone_lengths.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/motion/body.hpp"

namespace sparse_mocap::liu2011 {
namespace {

using namespace standard_joint;

constexpr int kModelVersion = 1;
constexpr int kIterations = 300;
constexpr double kLeastDeviation_m = 0.003;  // what a skeleton is not known better than
constexpr std::size_t kFewestBodies = 3;

Eigen::Index at(int joint) { return joint - 1; }

BoneLengths mirrored(const BoneLengths& lengths) {
  BoneLengths out;
  for (int j = 1; j < kNumStandardJoints; ++j)
    out[at(j)] = lengths[at(standard_left_right()[static_cast<std::size_t>(j)])];
  return out;
}

// The known entries of a body: their places, and what they are.
struct Known {
  std::vector<Eigen::Index> places;
  Eigen::VectorXd values;
};

std::vector<Known> with_mirror_images(const std::vector<MeasuredBody>& bodies) {
  std::vector<Known> out;
  for (const MeasuredBody& body : bodies)
    for (const bool is_image : {false, true}) {
      Known known;
      std::vector<double> values;
      for (int j = 1; j < kNumStandardJoints; ++j) {
        const int from = is_image ? standard_left_right()[static_cast<std::size_t>(j)] : j;
        if (!body.is_known[static_cast<std::size_t>(at(from))]) continue;
        known.places.push_back(at(j));
        values.push_back(body.lengths_m[at(from)]);
      }
      known.values = Eigen::Map<const Eigen::VectorXd>(values.data(),
                                                       static_cast<Eigen::Index>(values.size()));
      out.push_back(std::move(known));
    }
  return out;
}

BoneLengths mean_of(const std::vector<Known>& bodies) {
  BoneLengths sum = BoneLengths::Zero(), count = BoneLengths::Zero();
  for (const Known& body : bodies)
    for (std::size_t i = 0; i < body.places.size(); ++i) {
      sum[body.places[i]] += body.values[static_cast<Eigen::Index>(i)];
      count[body.places[i]] += 1.0;
    }
  for (int j = 1; j < kNumStandardJoints; ++j)
    if (count[at(j)] == 0.0)
      throw ConfigError("no body tells the length of '" +
                        std::string(standard_joint_names()[static_cast<std::size_t>(j)]) +
                        "'; add a motion file whose skeleton has it");
  return sum.cwiseQuotient(count);
}

// What the modes and the mean are regressed on: sums over the bodies that have a length.
struct Moments {
  Eigen::MatrixXd xx;
  Eigen::VectorXd xy;
  double yy = 0.0, count = 0.0;
};

// One round of expectation and maximisation.
void improve(const std::vector<Known>& bodies, BoneLengthModel& model) {
  const Eigen::Index modes = model.modes.cols();
  std::vector<Moments> moments(kNumBoneLengths, {Eigen::MatrixXd::Zero(modes + 1, modes + 1),
                                                 Eigen::VectorXd::Zero(modes + 1)});
  const double variance = model.deviation_m * model.deviation_m;
  for (const Known& body : bodies) {
    const Eigen::MatrixXd W = model.modes(body.places, Eigen::all);
    const Eigen::MatrixXd spread =
        (W.transpose() * W / variance + Eigen::MatrixXd::Identity(modes, modes)).inverse();
    const Eigen::VectorXd z =
        spread * W.transpose() * (body.values - model.mean_m(body.places)) / variance;
    Eigen::MatrixXd zz(modes + 1, modes + 1);
    zz.topLeftCorner(modes, modes) = spread + z * z.transpose();
    zz.topRightCorner(modes, 1) = z;
    zz.bottomLeftCorner(1, modes) = z.transpose();
    zz(modes, modes) = 1.0;
    for (std::size_t i = 0; i < body.places.size(); ++i) {
      Moments& sum = moments[static_cast<std::size_t>(body.places[i])];
      const double y = body.values[static_cast<Eigen::Index>(i)];
      sum.xx += zz;
      sum.xy += zz.col(modes) * y;
      sum.yy += y * y;
      sum.count += 1.0;
    }
  }
  double squares = 0.0, count = 0.0;
  for (Eigen::Index d = 0; d < kNumBoneLengths; ++d) {
    const Moments& sum = moments[static_cast<std::size_t>(d)];
    const Eigen::VectorXd fit = sum.xx.ldlt().solve(sum.xy);
    model.modes.row(d) = fit.head(modes).transpose();
    model.mean_m[d] = fit[modes];
    squares += sum.yy - 2.0 * fit.dot(sum.xy) + fit.dot(sum.xx * fit);
    count += sum.count;
  }
  model.deviation_m = std::max(kLeastDeviation_m, std::sqrt(std::max(squares, 0.0) / count));
}

// Adds a mode in which these bones are longer by a share of their lengths.
void add_mode(const std::vector<int>& longer, double share, const std::vector<int>& shorter,
              BoneLengthModel& model) {
  BoneLengths mode = BoneLengths::Zero();
  for (const int j : longer) mode[at(j)] = share * model.mean_m[at(j)];
  for (const int j : shorter) mode[at(j)] = -share * model.mean_m[at(j)];
  model.modes.conservativeResize(Eigen::NoChange, model.modes.cols() + 1);
  model.modes.rightCols<1>() = mode;
}

}  // namespace

Eigen::MatrixXd BoneLengthModel::covariance() const {
  return modes * modes.transpose() +
         deviation_m * deviation_m * Eigen::MatrixXd::Identity(kNumBoneLengths, kNumBoneLengths);
}

BoneLengthModel published_bone_lengths() {
  constexpr double kHeight_m = 1.71, kHeightDeviation_m = 0.09, kProportion = 0.05;
  const StandardBones medium = body_of_height(kHeight_m).bones;
  BoneLengthModel model;
  model.mean_m = lengths_of(medium);
  const auto set = [&](std::initializer_list<int> joints, double share) {
    for (const int j : joints) model.mean_m[at(j)] = share * kHeight_m;
  };
  set({lfemur, rfemur}, 0.245);
  set({ltibia, rtibia}, 0.246);
  set({lhumerus, rhumerus}, 0.186);
  set({lradius, rradius}, 0.146 * 2.0 / 3.0);  // the standard skeleton has two bones for a forearm
  set({lwrist, rwrist}, 0.146 / 3.0);
  const std::vector<int> trunk{lowerback, upperback, thorax, lowerneck, upperneck, head};
  const std::vector<int> legs{lfemur, ltibia, rfemur, rtibia};
  const std::vector<int> arms{lhumerus, lradius, lwrist, rhumerus, rradius, rwrist};
  std::vector<int> all;
  for (int j = 1; j < kNumStandardJoints; ++j) all.push_back(j);
  add_mode(all, kHeightDeviation_m / kHeight_m, {}, model);
  add_mode(legs, kProportion, trunk, model);
  add_mode(arms, kProportion, {}, model);
  add_mode({lfemur, rfemur}, kProportion, {ltibia, rtibia}, model);
  add_mode({lhumerus, rhumerus}, kProportion, {lradius, rradius}, model);
  add_mode({lclavicle, rclavicle}, 2.0 * kProportion, {}, model);
  add_mode({lhipjoint, rhipjoint}, 2.0 * kProportion, {}, model);
  model.deviation_m = 0.007;
  return model;
}

BoneLengthModel learnt_bone_lengths(const std::vector<MeasuredBody>& bodies, int num_modes) {
  if (bodies.size() < kFewestBodies)
    throw ConfigError("bone lengths are learnt from three people or more, got " +
                      std::to_string(bodies.size()) + "; add motion files of others");
  const std::vector<Known> known = with_mirror_images(bodies);
  BoneLengthModel model;
  model.mean_m = mean_of(known);
  const auto most = static_cast<int>(bodies.size()) - 1;
  model.modes.resize(kNumBoneLengths, std::clamp(num_modes, 1, most));
  std::mt19937 random(1);  // any start that is not symmetric will do
  std::normal_distribution<double> normal;
  for (double& value : model.modes.reshaped()) value = 0.01 * normal(random);
  for (int round = 0; round < kIterations; ++round) improve(known, model);
  // The modes by falling deviation, as principal components are; images make the mean even.
  const Eigen::MatrixXd found = model.modes;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(found, Eigen::ComputeThinU);
  model.modes = svd.matrixU() * svd.singularValues().asDiagonal();
  model.mean_m = 0.5 * (model.mean_m + mirrored(model.mean_m));
  return model;
}

MeasuredBody measured_body(const StandardBones& bones) {
  constexpr double kSame = 1e-9;
  MeasuredBody body;
  body.lengths_m = lengths_of(bones);
  const double scale = leg_length_m(bones) / leg_length_m(template_bones());
  for (std::size_t j = 0; j < kNumBoneLengths; ++j)
    body.is_known[j] = !bones[j + 1].isApprox(scale * template_bones()[j + 1], kSame);
  return body;
}

BoneLengths lengths_of(const StandardBones& bones) {
  BoneLengths out;
  for (std::size_t j = 0; j < kNumBoneLengths; ++j)
    out[static_cast<Eigen::Index>(j)] = bones[j + 1].norm();
  return out;
}

StandardBones bones_of_lengths(const BoneLengths& lengths_m) {
  StandardBones bones = template_bones();
  for (std::size_t j = 0; j < kNumBoneLengths; ++j)
    bones[j + 1] *= lengths_m[static_cast<Eigen::Index>(j)] / bones[j + 1].norm();
  return bones;
}

Model to_model(const BoneLengthModel& lengths) {
  Model model;
  model.method = "liu2011";
  model.version = kModelVersion;
  model.set("bone_lengths.mean", lengths.mean_m);
  model.set("bone_lengths.modes", Eigen::MatrixXd(lengths.modes));
  model.set("bone_lengths.deviation", Eigen::VectorXd::Constant(1, lengths.deviation_m));
  return model;
}

BoneLengthModel bone_lengths_in(const Model& model) {
  if (model.method != "liu2011" || model.version != kModelVersion)
    throw FormatError({model.path}, "holds no bone lengths",
                      "make it with `sparse-mocap train --method liu2011`");
  BoneLengthModel out;
  out.mean_m = model.vector<double>("bone_lengths.mean", kNumBoneLengths);
  out.modes = model.matrix<double>("bone_lengths.modes", kNumBoneLengths);
  out.deviation_m = model.vector<double>("bone_lengths.deviation", 1)[0];
  if (!(out.deviation_m > 0.0) || !(out.mean_m.minCoeff() > 0.0))
    throw FormatError({model.path}, "a bone has no length or no deviation",
                      "train it again with this version");
  return out;
}

}  // namespace sparse_mocap::liu2011
