// SPDX-License-Identifier: GPL-3.0-or-later
//
// Takes whose readings leave more than one motion possible, in best quality.
#include <gtest/gtest.h>

#include <cmath>

#include "sparse_mocap/methods/registry.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::path_regression {
namespace {

using testing::template_skeleton;

constexpr int kFrames = 200;  // at 50 Hz; the database has half as many
constexpr double kRate_hz = 25.0;
constexpr float kAlike_mps2 = 0.6F;    // so far apart are readings that fit about as well
constexpr int kBegin = 32, kEnd = 68;  // of what is ambiguous, at 25 Hz

// A small movement that becomes another one, so that no part of it is like a part before.
Motion changing_motion(unsigned seed) {
  Motion motion = testing::swaying_motion(template_skeleton(), seed, kFrames, 50.0);
  const Motion into = testing::swaying_motion(template_skeleton(), seed + 100, kFrames, 50.0);
  for (int t = 0; t < kFrames; ++t)
    for (int j = 0; j < kNumStandardJoints; ++j)
      motion.rotation(t, j) = Quat::Identity().slerp(
          0.5, motion.rotation(t, j).slerp(static_cast<double>(t) / kFrames, into.rotation(t, j)));
  return motion;
}

// The motion that bends over at the hips and spreads the arms in [kBegin, kEnd).
Motion bending(Motion motion) {
  using namespace standard_joint;
  for (int t = 0; t < motion.num_frames(); ++t) {
    const double into = 0.5 * t - kBegin, left = kEnd - 0.5 * t;
    const double share = std::clamp(std::min(into, left) / 5.0, 0.0, 1.0);
    for (const int joint : {int(lowerback), int(upperback), int(thorax), int(lfemur), int(rfemur)})
      motion.rotation(t, joint) =
          motion.rotation(t, joint) * Quat(Eigen::AngleAxisd(0.7 * share, Vec3::UnitX()));
  }
  return motion;
}

// Eight different movements, and the one of clip 3 once more, bent over, with the readings of clip
// 3 but for offset_mps2.
std::shared_ptr<const MotionDatabase> database_with(bool is_ambiguous, float offset_mps2) {
  std::vector<Motion> motions;
  for (unsigned seed = 0; seed < 8; ++seed) motions.push_back(changing_motion(seed));
  if (is_ambiguous) motions.push_back(bending(motions[3]));
  DatabaseContent content = testing::content_of(motions, kRate_hz);
  if (is_ambiguous) {
    const DatabaseRows same = unpacked(content.clip_rows[3]);
    testing::change_rows(content, 8, [&](DatabaseRows& rows) {
      rows.specific_force_pivot = same.specific_force_pivot.array() + offset_mps2;
      rows.specific_force_end = same.specific_force_end.array() + offset_mps2;
      rows.angular_velocity = same.angular_velocity;
      rows.gravity_direction = same.gravity_direction;
    });
  }
  return testing::database_of(content);
}

struct Solved {
  std::vector<PoseEstimate> first;
  std::vector<Alternative> alternatives;
};

Solved solved(const std::shared_ptr<const MotionDatabase>& database, int num_threads = 1,
              const std::string& alternatives = "2") {
  MethodContext context{database, nullptr, {}, testing::paper_sensors(), {}};
  context.num_threads = num_threads;
  const auto method = make_whole_take_method(find_method("path_regression"),
                                             {"", {{"alternatives", alternatives}}}, context);
  const auto take = testing::readings_of(*database, 3, context.sensors);
  auto first = method->solve(take, Progress());
  return {std::move(first), method->alternatives()};
}

Eigen::MatrixXd positions(const std::vector<PoseEstimate>& estimates) {
  return joint_positions(to_motion(estimates, template_skeleton(), kRate_hz),
                         PositionFrame::heading);
}

// The mean distance of joints in some frames, m.
double apart_m(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, int begin, int end) {
  double sum = 0.0;
  for (Eigen::Index t = begin; t < end; ++t)
    for (Eigen::Index j = 0; j < kNumStandardJoints; ++j)
      sum += (a.col(t) - b.col(t)).segment<3>(3 * j).norm();
  return sum / (end - begin) / kNumStandardJoints;
}

Eigen::MatrixXd clip_positions(const MotionDatabase& database, std::size_t clip) {
  const Clip& rows = database.clips()[clip];
  Eigen::MatrixXd out(3 * kNumStandardJoints, rows.end - rows.begin);
  for (int t = rows.begin; t < rows.end; ++t)
    out.col(t - rows.begin) = database.positions().row(t).transpose().cast<double>();
  return out;
}

TEST(Alternatives, AreTheOtherMotionThatReadsAlikeWhereItDiffers) {
  const auto database = database_with(true, kAlike_mps2);
  const Solved take = solved(database);
  const Eigen::MatrixXd a = positions(take.first);
  const Eigen::MatrixXd upright = clip_positions(*database, 3), bent = clip_positions(*database, 8);
  ASSERT_GT(apart_m(upright, bent, kBegin + 5, kEnd - 5), 0.2);
  ASSERT_EQ(take.alternatives.size(), 1U);
  const Alternative& other = take.alternatives.front();
  ASSERT_EQ(other.estimates.size(), take.first.size());
  ASSERT_EQ(other.differences.size(), 1U);
  EXPECT_NEAR(other.differences[0].begin_s, kBegin / kRate_hz, 0.2);
  EXPECT_NEAR(other.differences[0].end_s, kEnd / kRate_hz, 0.2);
  const Eigen::MatrixXd b = positions(other.estimates);
  // A is upright, B is bent: in the middle of the part, where it need not lead there.
  EXPECT_LT(apart_m(a, upright, kBegin + 10, kEnd - 10), 0.1);
  EXPECT_LT(apart_m(b, bent, kBegin + 10, kEnd - 10), 0.04);
  EXPECT_GT(other.differences[0].distance_m, 0.1);
  const auto frame_at = [](double time_s) {
    return static_cast<int>(std::lround(time_s * kRate_hz));
  };
  const int begin = frame_at(other.differences[0].begin_s);
  const int end = frame_at(other.differences[0].end_s);
  EXPECT_NEAR(other.differences[0].distance_m, apart_m(a, b, begin, end), 0.01);
  // Elsewhere it is A.
  EXPECT_LT(apart_m(a, b, 0, kBegin - 15), 1e-9);
  EXPECT_LT(apart_m(a, b, kEnd + 15, static_cast<int>(a.cols())), 1e-9);
}

TEST(Alternatives, MoveAsEvenlyAsTheFirstMotion) {
  const Solved take = solved(database_with(true, kAlike_mps2));
  ASSERT_FALSE(take.alternatives.empty());
  const auto& frames = take.alternatives.front().estimates;
  for (std::size_t t = 1; t < frames.size(); ++t) {
    EXPECT_LT(
        (frames[t].root_position - take.alternatives.front().estimates[t - 1].root_position).norm(),
        0.15);
    for (std::size_t j = 0; j < frames[t].rotations.size(); ++j)
      EXPECT_LT(frames[t].rotations[j].angularDistance(frames[t - 1].rotations[j]),
                25.0 * kRadiansPerDegree)
          << t << " " << j;
  }
}

TEST(Alternatives, AreNoneWhereTheReadingsLeaveNoDoubt) {
  EXPECT_TRUE(solved(database_with(false, 0.0F)).alternatives.empty());
  EXPECT_TRUE(solved(database_with(true, 10.0F * kAlike_mps2)).alternatives.empty());
}

TEST(Alternatives, AreLookedForWhenAskedForAloneAndChangeNothing) {
  const auto database = database_with(true, kAlike_mps2);
  const Solved without = solved(database, 1, "0"), with = solved(database);
  EXPECT_TRUE(without.alternatives.empty());
  EXPECT_EQ(positions(without.first), positions(with.first));
}

TEST(Alternatives, AreTheSameOnAnyNumberOfThreads) {
  const auto database = database_with(true, kAlike_mps2);
  const Solved one = solved(database, 1), three = solved(database, 3);
  ASSERT_EQ(one.alternatives.size(), three.alternatives.size());
  for (std::size_t i = 0; i < one.alternatives.size(); ++i)
    EXPECT_EQ(positions(one.alternatives[i].estimates), positions(three.alternatives[i].estimates));
}

}  // namespace
}  // namespace sparse_mocap::path_regression
