// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/bone_lengths.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/motion/body.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::liu2011 {
namespace {

using testing::Random;

int at(standard_joint::Index joint) { return joint - 1; }

// People who differ in height and in how long their arms are.
std::vector<MeasuredBody> people(int count, Random& random) {
  const BoneLengths medium = lengths_of(template_bones());
  std::vector<MeasuredBody> out;
  for (int i = 0; i < count; ++i) {
    const Eigen::VectorXd own = random.column(2, 1.0);
    MeasuredBody body;
    body.lengths_m = (1.0 + 0.05 * own[0]) * medium;
    for (const auto joint : {standard_joint::lhumerus, standard_joint::rhumerus})
      body.lengths_m[at(joint)] += 0.02 * own[1];
    body.lengths_m += random.column(kNumBoneLengths, 0.003);
    body.is_known.fill(true);
    out.push_back(body);
  }
  return out;
}

// Tipping and Bishop's closed form for complete data: from the covariance of all bodies and their
// mirror images.
Eigen::MatrixXd closed_form(const std::vector<MeasuredBody>& bodies, Eigen::Index modes) {
  Eigen::MatrixXd rows(2 * bodies.size(), kNumBoneLengths);
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (int j = 1; j < kNumStandardJoints; ++j) {
      rows(static_cast<Eigen::Index>(2 * i), j - 1) = bodies[i].lengths_m[j - 1];
      rows(static_cast<Eigen::Index>(2 * i + 1), j - 1) =
          bodies[i].lengths_m[standard_left_right()[static_cast<std::size_t>(j)] - 1];
    }
  const Eigen::MatrixXd centred = rows.rowwise() - rows.colwise().mean();
  const Eigen::MatrixXd S = centred.transpose() * centred / static_cast<double>(rows.rows());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(S);
  const double noise = eigen.eigenvalues().head(kNumBoneLengths - modes).mean();
  Eigen::MatrixXd out = noise * Eigen::MatrixXd::Identity(kNumBoneLengths, kNumBoneLengths);
  for (Eigen::Index k = kNumBoneLengths - modes; k < kNumBoneLengths; ++k)
    out += (eigen.eigenvalues()[k] - noise) * eigen.eigenvectors().col(k) *
           eigen.eigenvectors().col(k).transpose();
  return out;
}

TEST(LearntBoneLengths, AreThoseOfTheClosedFormWhereNothingIsMissing) {
  Random random(1);
  auto bodies = people(40, random);
  for (auto& body : bodies)  // above the least deviation
    body.lengths_m += random.column(kNumBoneLengths, 0.008);
  const BoneLengthModel found = learnt_bone_lengths(bodies, 2);
  const Eigen::MatrixXd wanted = closed_form(bodies, 2);
  EXPECT_LT((found.covariance() - wanted).norm(), 0.02 * wanted.norm());
}

TEST(LearntBoneLengths, UseBodiesWithMissingBones) {
  Random random(2);
  auto bodies = people(60, random);
  const BoneLengthModel whole = learnt_bone_lengths(bodies, 2);
  for (std::size_t i = 0; i < bodies.size(); i += 2)
    for (const auto joint :
         {standard_joint::thorax, standard_joint::lwrist, standard_joint::rwrist}) {
      bodies[i].is_known[static_cast<std::size_t>(at(joint))] = false;
      bodies[i].lengths_m[at(joint)] = 5.0;
    }
  const BoneLengthModel masked = learnt_bone_lengths(bodies, 2);
  EXPECT_LT((masked.mean_m - whole.mean_m).cwiseAbs().maxCoeff(), 0.003);
  EXPECT_LT((masked.covariance() - whole.covariance()).norm(), 0.1 * whole.covariance().norm());
}

TEST(LearntBoneLengths, RefuseWhatTeachesNothing) {
  Random random(3);
  EXPECT_THROW(learnt_bone_lengths(people(2, random)), ConfigError);
  auto bodies = people(4, random);
  for (auto& body : bodies)
    body.is_known[static_cast<std::size_t>(at(standard_joint::head))] = false;
  try {
    learnt_bone_lengths(bodies);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("head"), std::string::npos);
  }
}

TEST(MeasuredBody, KnowsWhichBonesTheImportFilledIn) {
  StandardBones bones = body_of_height(1.9).bones;
  const double scale = leg_length_m(bones) / leg_length_m(template_bones());
  for (auto& bone : bones) bone *= 1.01;
  bones[standard_joint::lfemur] /= 1.01;  // the legs are as long as before on average
  bones[standard_joint::rfemur] /= 1.01;
  bones[standard_joint::ltibia] /= 1.01;
  bones[standard_joint::rtibia] /= 1.01;
  bones[standard_joint::thorax] = scale * template_bones()[standard_joint::thorax];
  const MeasuredBody body = measured_body(bones);
  EXPECT_FALSE(body.is_known[static_cast<std::size_t>(at(standard_joint::thorax))]);
  EXPECT_TRUE(body.is_known[static_cast<std::size_t>(at(standard_joint::head))]);
  EXPECT_TRUE(bones_of_lengths(body.lengths_m)[standard_joint::lradius].isApprox(
      bones[standard_joint::lradius], 1e-9));
}

TEST(BoneLengthModel, IsTheSameReadBack) {
  const BoneLengthModel wanted = published_bone_lengths();
  const BoneLengthModel found = bone_lengths_in(to_model(wanted));
  EXPECT_EQ(found.mean_m, wanted.mean_m);
  EXPECT_EQ(found.covariance(), wanted.covariance());
  Model other = to_model(wanted);
  other.method = "eom2014";
  EXPECT_THROW(bone_lengths_in(other), FormatError);
}

TEST(PublishedBoneLengths, AreThoseOfTheTables) {
  const BoneLengthModel model = published_bone_lengths();
  const double height_m = model.mean_m[at(standard_joint::lfemur)] / 0.245;
  EXPECT_NEAR(model.mean_m[at(standard_joint::rtibia)], 0.246 * height_m, 1e-12);
  EXPECT_NEAR(model.mean_m[at(standard_joint::lradius)] + model.mean_m[at(standard_joint::lwrist)],
              0.146 * height_m, 1e-12);
  const double thigh_sd = std::sqrt(model.covariance()(1, 1));
  EXPECT_GT(thigh_sd, 0.02);
  EXPECT_LT(thigh_sd, 0.05);
}

}  // namespace
}  // namespace sparse_mocap::liu2011
