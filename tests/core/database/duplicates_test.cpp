// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/duplicates.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sparse_mocap/motion/heading.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::swaying_motion;
using testing::template_skeleton;

Motion sway(unsigned seed) { return swaying_motion(template_skeleton(), seed, 600, 120.0); }

DatabaseRows rows_of(const Motion& motion) { return database_rows(motion, 25.0); }

// Every n-th frame, as an exporter at a lower rate writes it.
Motion decimated(const Motion& motion, int n, int first) {
  Motion out;
  out.skeleton = motion.skeleton;
  out.frame_time_s = n * motion.frame_time_s;
  for (int t = first; t < motion.num_frames(); t += n) {
    out.root_positions.push_back(motion.root_positions[static_cast<std::size_t>(t)]);
    for (int j = 0; j < motion.skeleton.num_joints(); ++j)
      out.rotations.push_back(motion.rotation(t, j));
  }
  return out;
}

bool is_same(const Motion& a, const Motion& b) {
  const auto distance = clip_distance(rows_of(a), rows_of(b));
  return distance && distance->is_same_motion();
}

TEST(Duplicates, TellHowFarAClipIsFromItself) {
  const DatabaseRows rows = rows_of(sway(1));
  const auto distance = clip_distance(rows, rows);
  ASSERT_TRUE(distance);
  EXPECT_EQ(distance->apart_m, 0.0);
  // The step by its definition: central differences of the joints' positions.
  double sum = 0.0;
  const auto& p = rows.positions;
  for (int t = 1; t + 1 < rows.num_frames(); ++t)
    sum += 0.25 * static_cast<double>((p.row(t + 1) - p.row(t - 1)).squaredNorm());
  EXPECT_NEAR(distance->step_m, std::sqrt(sum / (rows.num_frames() - 2) / kNumStandardJoints),
              1e-6);
}

TEST(Duplicates, AreFoundAtOtherFrameRates) {
  const Motion motion = sway(2);
  EXPECT_TRUE(is_same(motion, decimated(motion, 2, 0)));
  EXPECT_TRUE(is_same(motion, decimated(motion, 4, 0)));
  EXPECT_TRUE(is_same(motion, resampled(motion, 50.0)));
}

TEST(Duplicates, AreFoundWhenTheyStartALittleLater) {
  const Motion motion = sway(3);
  for (const int frames : {1, 2, 5, 9})
    EXPECT_TRUE(is_same(motion, trimmed(motion, frames, motion.num_frames()))) << frames;
  EXPECT_TRUE(is_same(trimmed(motion, 7, 590), trimmed(motion, 0, 595)));
  EXPECT_FALSE(is_same(motion, trimmed(motion, 40, motion.num_frames())));
}

TEST(Duplicates, AreNotOtherMotionsNorTheSameElsewhere) {
  const Motion motion = sway(4);
  EXPECT_FALSE(is_same(motion, sway(5)));
  EXPECT_FALSE(is_same(motion, reversed(motion)));
  EXPECT_FALSE(is_same(motion, mirrored(motion, standard_left_right())));
  Motion faster = motion;
  faster.frame_time_s *= 0.97;
  EXPECT_FALSE(is_same(motion, faster));
  Motion walking = motion;  // the same body, but under way
  for (std::size_t t = 0; t < walking.root_positions.size(); ++t)
    walking.root_positions[t].z() += 1.0 * static_cast<double>(t) / 120.0;
  EXPECT_FALSE(is_same(motion, walking));
}

TEST(Duplicates, AreTheSameWhereverAndWhicheverWayTheyFace) {
  const Motion motion = sway(6);
  Motion turned = motion;
  for (int t = 0; t < turned.num_frames(); ++t) {
    auto& position = turned.root_positions[static_cast<std::size_t>(t)];
    position = yaw_rotation(1.0) * position + Vec3(3, 0, -2);
    turned.rotation(t, 0) = Quat(yaw_rotation(1.0)) * turned.rotation(t, 0);
  }
  EXPECT_TRUE(is_same(motion, turned));
}

// One arm held 4 cm further out, in a body that moves otherwise alike: two performances.
TEST(Duplicates, AreNotPerformancesThatAreNearlyAlike) {
  const Motion motion = sway(7);
  Motion other = motion;
  for (int t = 0; t < other.num_frames(); ++t)
    for (const auto joint : {standard_joint::lhumerus, standard_joint::rhumerus,
                             standard_joint::lfemur, standard_joint::lowerback})
      other.rotation(t, joint) =
          other.rotation(t, joint) *
          Quat(Eigen::AngleAxisd(0.12 * std::sin(0.02 * t + int{joint}), Vec3::UnitZ()));
  EXPECT_FALSE(is_same(motion, other));
}

TEST(DuplicateFinder, NamesTheFirstThatIsTheSame) {
  DuplicateFinder finder;
  EXPECT_FALSE(finder.find(rows_of(sway(1))));
  for (const int id : {3, 1, 2}) finder.add(id, rows_of(sway(8)));
  finder.add(0, rows_of(sway(9)));
  EXPECT_EQ(finder.find(rows_of(decimated(sway(8), 2, 1))), 1);
  EXPECT_EQ(finder.find(rows_of(sway(9))), 0);
  EXPECT_FALSE(finder.find(rows_of(sway(10))));
}

}  // namespace
}  // namespace sparse_mocap
