// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/clip_motion.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

// Of a clip whose file has a left foot and nothing else beyond ankles and wrists.
TEST(ClipMotion, HasExtremitiesAsTheFileHasThemOrRelaxed) {
  const Skeleton full = with_extremities(testing::template_skeleton());
  const Motion source = testing::swaying_motion(full, 1, 20, 25.0);
  DatabaseContent content = testing::content_of({source}, 25.0);
  content.skeleton = testing::template_skeleton();
  content.clips[0].has_extremity[extremity::lfoot] = true;
  const auto database = testing::database_of(content);
  const Motion motion = clip_motion_with_extremities(*database, 0);
  ASSERT_TRUE(has_extremities(motion.skeleton));
  const Motion plain = clip_motion(*database, 0);
  EXPECT_EQ(motion.root_positions, plain.root_positions);
  for (int t = 0; t < motion.num_frames(); ++t) {
    for (int j = 0; j < kNumStandardJoints; ++j)
      EXPECT_EQ(motion.rotation(t, j).coeffs(), plain.rotation(t, j).coeffs());
    EXPECT_LT(motion.rotation(t, extremity_joint(extremity::lfoot))
                  .angularDistance(source.rotation(t, extremity_joint(extremity::lfoot))),
              3e-4);
    for (const auto e : {extremity::ltoes, extremity::lhand, extremity::rfoot, extremity::rhand})
      EXPECT_LT(
          motion.rotation(t, extremity_joint(e)).angularDistance(Quat(relaxed(motion.skeleton, e))),
          1e-9);
  }
}

TEST(ClipMotion, IsRelaxedFromADatabaseWithoutExtremities) {
  const auto database =
      testing::database_of({testing::swaying_motion(testing::template_skeleton(), 1, 20, 25.0)});
  const Motion motion = clip_motion_with_extremities(*database, 0);
  EXPECT_LT(motion.rotation(3, extremity_joint(extremity::rfoot))
                .angularDistance(Quat(relaxed(motion.skeleton, extremity::rfoot))),
            1e-9);
}

TEST(ClipMotion, OfAnUnknownClipIsAnError) {
  const auto database =
      testing::database_of({testing::swaying_motion(testing::template_skeleton(), 1, 20, 25.0)});
  EXPECT_THROW(clip_motion(*database, 1), std::out_of_range);
  EXPECT_THROW(clip_motion_with_extremities(*database, -1), std::out_of_range);
}

}  // namespace
}  // namespace sparse_mocap
