// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/clip_names.hpp"

#include <gtest/gtest.h>

namespace sparse_mocap {
namespace {

void expect_labels(const std::filesystem::path& path, const std::string& name,
                   const std::string& actor, const std::string& motion_class) {
  const ClipLabels labels = labels_of(path);
  EXPECT_EQ(labels.name, name);
  EXPECT_EQ(labels.actor, actor) << path;
  EXPECT_EQ(labels.motion_class, motion_class) << path;
}

TEST(LabelsOf, UnderstandHdm05) {
  expect_labels("a/HDM_bd_kickLFront1Reps_001_120.amc", "HDM_bd_kickLFront1Reps_001_120", "bd",
                "kickLFront1Reps");
  expect_labels("HDM_bk_sneak2StepsLStart_006_120.AMC", "HDM_bk_sneak2StepsLStart_006_120", "bk",
                "sneak2StepsLStart");
}

TEST(LabelsOf, UnderstandCmu) {
  expect_labels("cmu/02/02_01.amc", "02_01", "02", "trial01");
  expect_labels("105_12.bvh", "105_12", "105", "trial12");
}

TEST(LabelsOf, UnderstandActorClassTake) {
  expect_labels("x/anna_walk_003.bvh", "anna_walk_003", "anna", "walk");
}

TEST(LabelsOf, OtherwiseTakeTheFolderAsActor) {
  expect_labels("studio/ben/take7.bvh", "take7", "ben", "take7");
  expect_labels("studio/ben/run_fast.bvh", "run_fast", "ben", "run_fast");
  expect_labels("take7.bvh", "take7", "", "take7");
}

TEST(MatchesGlob, ComparesTheWholeTextIgnoringCase) {
  EXPECT_TRUE(matches_glob("walk.bvh", "Walk.BVH"));
  EXPECT_FALSE(matches_glob("walk", "walk.bvh"));
  EXPECT_FALSE(matches_glob("walk.bvh", "walk"));
  EXPECT_TRUE(matches_glob("", ""));
  EXPECT_FALSE(matches_glob("", "a"));
}

TEST(MatchesGlob, KnowsStarAndQuestionMark) {
  EXPECT_TRUE(matches_glob("*", ""));
  EXPECT_TRUE(matches_glob("*walk*", "02_walk_7.bvh"));
  EXPECT_TRUE(matches_glob("a*b*c", "axxbxbyc"));
  EXPECT_FALSE(matches_glob("a*b*c", "axxbxby"));
  EXPECT_TRUE(matches_glob("t?ke*", "take1"));
  EXPECT_FALSE(matches_glob("t?ke", "tke"));
  EXPECT_TRUE(matches_glob("**a", "aaa"));
}

TEST(MatchesGlob, KnowsSets) {
  EXPECT_TRUE(matches_glob("[abc]x", "Bx"));
  EXPECT_FALSE(matches_glob("[abc]x", "dx"));
  EXPECT_TRUE(matches_glob("take[0-9]", "take7"));
  EXPECT_FALSE(matches_glob("take[!0-9]", "take7"));
  EXPECT_TRUE(matches_glob("take[!0-9]", "takex"));
  EXPECT_TRUE(matches_glob("[]]", "]"));
  EXPECT_TRUE(matches_glob("[!]a]", "b"));
  EXPECT_FALSE(matches_glob("[!]a]", "]"));
  EXPECT_FALSE(matches_glob("[!]a]", "a"));
  EXPECT_TRUE(matches_glob("[a-]", "-"));
  EXPECT_TRUE(matches_glob("*[12].bvh", "walk2.bvh"));
}

TEST(MatchesGlob, TakesAnUnclosedSetAsItStands) {
  EXPECT_TRUE(matches_glob("[ab", "[ab"));
  EXPECT_FALSE(matches_glob("[ab", "a"));
}

// Backtracking must not take exponential time.
TEST(MatchesGlob, IsQuickOnManyStars) {
  std::string pattern, text(2000, 'a');
  for (int i = 0; i < 40; ++i) pattern += "*a";
  EXPECT_FALSE(matches_glob(pattern + "b", text));
}

}  // namespace
}  // namespace sparse_mocap
