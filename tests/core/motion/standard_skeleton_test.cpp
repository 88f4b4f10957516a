// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/standard_skeleton.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/formats/acclaim.hpp"
#include "sparse_mocap/retargeting/skeleton_mapping.hpp"
#include "support/refusals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;
using testing::real_data;
using testing::template_skeleton;

Vec3 in_mirror(const Vec3& v) { return {-v.x(), v.y(), v.z()}; }

TEST(StandardSkeleton, Has21JointsAnd43Angles) {
  const Skeleton skeleton = template_skeleton();
  EXPECT_EQ(skeleton.num_joints(), 21);
  EXPECT_EQ(skeleton.num_angles(), 43);
  EXPECT_EQ(skeleton.joint(root).axes.size(), 3U);
  for (int j = 0; j < kNumStandardJoints; ++j)
    EXPECT_EQ(skeleton.find(standard_joint_names()[static_cast<std::size_t>(j)]), j);
}

TEST(StandardSkeleton, GivesItsBonesBackAndRefusesOthers) {
  EXPECT_EQ(bones_of(template_skeleton()), template_bones());
  EXPECT_REFUSED(std::invalid_argument, "not a standard skeleton", bones_of(Skeleton()));
  EXPECT_REFUSED(std::invalid_argument, "no bodies", averaged_bones({}));
}

TEST(StandardSkeleton, MirrorsOntoItself) {
  const auto& partner = standard_left_right();
  const Skeleton skeleton = template_skeleton();
  for (int j = 0; j < kNumStandardJoints; ++j) {
    const int other = partner[static_cast<std::size_t>(j)];
    std::string name = skeleton.joint(j).name;
    if (other != j) name[0] = name[0] == 'l' ? 'r' : 'l';
    EXPECT_EQ(skeleton.joint(other).name, name);
    EXPECT_LT((skeleton.joint(other).bone - in_mirror(skeleton.joint(j).bone)).norm(), 1e-12);
  }
}

TEST(AveragedBones, AreTheMeanOfBodiesAndTheirMirrorImages) {
  StandardBones slim = template_bones(), tall = template_bones();
  slim[lfemur] = {0.1, -0.3, 0.0};
  slim[rfemur] = {-0.2, -0.4, 0.1};
  tall[lfemur] = {0.3, -0.5, 0.1};
  tall[rfemur] = {-0.2, -0.4, 0.0};
  tall[head] = {0.02, 0.2, 0.0};
  const StandardBones mean = averaged_bones({slim, tall});
  EXPECT_LT((mean[lfemur] - Vec3(0.2, -0.4, 0.05)).norm(), 1e-12);
  EXPECT_LT((mean[rfemur] - Vec3(-0.2, -0.4, 0.05)).norm(), 1e-12);
  EXPECT_LT((mean[head] - Vec3(0.0, 0.5 * (0.092 + 0.2), -0.001)).norm(), 1e-12);
}

TEST(LegLength, IsThighAndShankOfBothSides) {
  StandardBones bones = template_bones();
  bones[lfemur] = {0, -0.40, 0};
  bones[ltibia] = {0, -0.42, 0};
  bones[rfemur] = {0, 0, 0.44};
  bones[rtibia] = {0.46, 0, 0};
  EXPECT_NEAR(leg_length_m(bones), 0.86, 1e-12);
}

// The bones of an .asf, m, by name, read word by word.
std::map<std::string, Vec3> bones_of_asf(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::map<std::string, Vec3> bones;
  std::string line, word, name;
  Vec3 direction = Vec3::Zero();
  while (std::getline(file, line)) {
    std::istringstream words(line);
    words >> word;
    if (word == "name") words >> name;
    if (word == "direction") words >> direction.x() >> direction.y() >> direction.z();
    double length = 0.0;
    if (word == "length" && words >> length) bones[name] = direction * length * 0.0254 / 0.45;
  }
  return bones;
}

TEST(AveragedBones, OfTheHdm05ActorsAreTheMeanOfTheirFiles) {
  SKIP_WITHOUT_REAL_DATA("hdm05/HDM_bd.asf");
  std::vector<StandardBones> bodies;
  StandardBones expected;
  std::array<double, kNumStandardJoints> mean_length{};
  expected.fill(Vec3::Zero());
  for (const std::string actor : {"bd", "bk", "dg", "mm", "tr"}) {
    const auto path = real_data("hdm05") / ("HDM_" + actor + ".asf");
    bodies.push_back(map_skeleton(read_asf(path).skeleton).bones);
    auto bones = bones_of_asf(path);
    for (std::size_t j = 1; j < expected.size(); ++j) {
      const auto& names = standard_joint_names();
      const auto other = static_cast<std::size_t>(standard_left_right()[j]);
      expected[j] +=
          0.1 * (bones.at(std::string(names[j])) + in_mirror(bones.at(std::string(names[other]))));
      mean_length[j] += 0.1 * (bones.at(std::string(names[j])).norm() +
                               bones.at(std::string(names[other])).norm());
    }
  }
  const StandardBones mean = averaged_bones(bodies);
  for (std::size_t j = 1; j < mean.size(); ++j) {
    EXPECT_LT((mean[j] - expected[j]).norm(), 1e-6) << standard_joint_names()[j];
    EXPECT_NEAR(mean[j].norm(), mean_length[j], 2e-3) << standard_joint_names()[j];
  }
}

}  // namespace
}  // namespace sparse_mocap
