// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/paired_take.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/base/quaternions.hpp"
#include "sparse_mocap/database/builder.hpp"
#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/formats/bvh.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/sensors/virtual_sensor.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

namespace fs = std::filesystem;
using testing::swaying_motion;
using testing::template_skeleton;
using testing::TemporaryFolder;
using Rows = DatabaseRows::Rows;

const Mat3& mounting() {
  static const Mat3 R =
      Eigen::AngleAxisd(0.5, Vec3(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  return R;
}

// A database of two clips, and a file that is added to it with a take.
class PairTake : public ::testing::Test {
 protected:
  PairTake() {
    fs::create_directories(folder_ / "in");
    write_bvh(folder_ / "in/anna_walk_1.bvh", swaying_motion(template_skeleton(), 1, 240, 120.0));
    write_bvh(folder_ / "in/anna_walk_2.bvh", swaying_motion(template_skeleton(), 2, 240, 120.0));
    write_bvh(file_, motion_);
    BuildOptions options;
    options.add_mirrored = options.add_reversed = true;
    options.tempo_copies = {0.8, 1.25};
    build_database({folder_ / "in"}, base_, options);
  }

  // Of left_wrist and right_ankle, turned on the body, with the motion beginning at 2.5 s.
  PairedTake take(Channels channels, const Mat3& R_sensor_site = Mat3::Identity()) const {
    PairedTake take{"take.csv", "hash", {}, {}, 2.5, 0.97};
    std::vector<Site> sites;
    for (const char* name : {"left_wrist", "right_ankle"}) {
      take.sensors.push_back({{find_site(name), 1.0, channels}, {}});
      sites.push_back(all_sites()[static_cast<std::size_t>(find_site(name))]);
    }
    for (const VirtualReadings& readings : virtual_readings(motion_, sites)) {
      SensorRecording& recording = take.recordings.emplace_back();
      recording.specific_force = R_sensor_site * readings.specific_force_end;
      recording.angular_velocity = R_sensor_site * readings.angular_velocity;
      recording.orientation.resize(4, motion_.num_frames());
      for (int t = 0; t < motion_.num_frames(); ++t) {
        recording.times_s.push_back(take.begin_s + t * motion_.frame_time_s);
        const Mat3 R = yaw_rotation(0.7) * readings.R_world_sensor[static_cast<std::size_t>(t)] *
                       R_sensor_site.transpose();
        recording.orientation.col(t) = wxyz_of(Quat(R));
      }
    }
    return take;
  }

  BuildReport add(const PairedTake* take, const fs::path& output) const {
    ImportOptions options;
    if (take != nullptr) options.takes[file_] = *take;
    return add_to_database(base_, {file_}, output, options);
  }

  std::shared_ptr<const MotionDatabase> taught(const PairedTake& take) const {
    add(&take, folder_ / "taught.smdb");
    return MotionDatabase::open(folder_ / "taught.smdb");
  }
  std::shared_ptr<const MotionDatabase> plain() const {
    add(nullptr, folder_ / "plain.smdb");
    return MotionDatabase::open(folder_ / "plain.smdb");
  }

  // The clips made from the file.
  static std::vector<Clip> clips_of(const MotionDatabase& database) {
    std::vector<Clip> clips;
    for (const Clip& clip : database.clips())
      if (clip.source == "bert_kick_1.bvh") clips.push_back(clip);
    return clips;
  }
  static Rows rows_of(const ScaledRows& rows, const Clip& clip) {
    return rows.rows_of_clip(clip.begin, clip.num_frames());
  }
  static const SiteRows& site(const MotionDatabase& database, const char* name) {
    return database.site(static_cast<std::size_t>(find_site(name)));
  }

  const TemporaryFolder folder_;
  const Motion motion_ = swaying_motion(template_skeleton(), 3, 361, 120.0);
  const fs::path file_ = folder_ / "bert_kick_1.bvh", base_ = folder_ / "base.smdb";
};

TEST_F(PairTake, RowsHoldWhatWasMeasuredAtTheirTimes) {
  PairedTake paired = take(Channel::specific_force);
  const auto measured = [](double time_s) {
    return Vec3(0.4 * time_s, 9.0 - 0.2 * time_s, 1.0 + 0.1 * time_s);
  };
  for (auto& recording : paired.recordings) {
    recording = {};
    recording.specific_force.resize(3, 800);
    for (int t = 0; t < 800; ++t) {
      recording.times_s.push_back(0.007 + 0.01 * t);
      recording.specific_force.col(t) = measured(recording.times_s.back());
    }
  }
  const auto database = taught(paired);
  const Clip clip = clips_of(*database).front();
  ASSERT_TRUE(clip.take.has_value());
  for (const char* name : {"left_wrist", "right_ankle"})
    for (const ScaledRows* rows :
         {&site(*database, name).specific_force_pivot, &site(*database, name).specific_force_end})
      for (int n = clip.begin; n < clip.end; ++n)
        EXPECT_LT(
            (rows->row(n).transpose().cast<double>() - measured(2.5 + (n - clip.begin) / 25.0))
                .norm(),
            2e-3);
}

TEST_F(PairTake, CopiesHoldWhatTheSameSensorsWouldMeasure) {
  const Channels channels = Channel::specific_force | Channel::angular_velocity;
  for (const Channels given : {Channels(Channel::specific_force), channels}) {
    const auto database = taught(take(given, mounting())), unpaired = plain();
    const auto clips = clips_of(*database), expected = clips_of(*unpaired);
    ASSERT_EQ(clips.size(), 12U);
    ASSERT_EQ(expected.size(), 12U);
    for (std::size_t c = 0; c < clips.size(); ++c) {
      ASSERT_EQ(clips[c].num_frames(), expected[c].num_frames());
      EXPECT_EQ(clips[c].take.has_value(), !clips[c].is_mirrored);
      const Mat3 R = clips[c].is_mirrored ? Mat3::Identity() : mounting();
      const auto near = [&](const ScaledRows& rows, const ScaledRows& wanted, double tolerance) {
        const Rows turned = rows_of(wanted, expected[c]) * R.transpose().cast<float>();
        const auto inner = clips[c].num_frames() - 4;  // filters end differently
        EXPECT_LT((rows_of(rows, clips[c]) - turned).middleRows(2, inner).cwiseAbs().maxCoeff(),
                  tolerance)
            << "tempo " << clips[c].tempo << (clips[c].is_reversed ? " reversed" : "")
            << (clips[c].is_mirrored ? " mirrored" : "");
      };
      const SiteRows &is = site(*database, "left_wrist"), &was = site(*unpaired, "left_wrist");
      near(is.specific_force_end, was.specific_force_end, 0.1);
      if (given == channels) near(is.angular_velocity, was.angular_velocity, 0.02);
    }
  }
}

TEST_F(PairTake, WhatWasNotRecordedStaysVirtual) {
  PairedTake paired = take(Channel::specific_force, mounting());
  for (auto& recording : paired.recordings) {
    const auto half = static_cast<std::size_t>(motion_.num_frames() / 2);
    recording.times_s.resize(half);
    recording.specific_force.conservativeResize(3, static_cast<Eigen::Index>(half));
    recording.angular_velocity.resize(3, 0);
    recording.orientation.resize(4, 0);
  }
  const auto database = taught(paired), unpaired = plain();
  const Clip clip = clips_of(*database).front(), was = clips_of(*unpaired).front();
  EXPECT_NEAR(clip.take->coverage, 0.5, 0.06);
  const auto apart = [&](const char* name, auto member) {
    const Rows rows = rows_of(site(*database, name).*member, clip);
    return Rows(rows - rows_of(site(*unpaired, name).*member, was)).rowwise().norm().eval();
  };
  const auto force = apart("left_wrist", &SiteRows::specific_force_end);
  EXPECT_GT(force.head(30).minCoeff(), 0.5F);
  EXPECT_LT(force.tail(30).maxCoeff(), 5e-3F);
  EXPECT_EQ(apart("left_wrist", &SiteRows::angular_velocity).maxCoeff(), 0.0F);
  EXPECT_EQ(apart("right_wrist", &SiteRows::specific_force_end).maxCoeff(), 0.0F);
  EXPECT_EQ(clip.take->channels.size(), 2U);
  EXPECT_EQ(clip.take->channels.at("left_wrist"), Channels(Channel::specific_force));
}

TEST_F(PairTake, OrientationsAreInTheHeadingOfThePose) {
  const auto database = taught(take(Channel::orientation));
  const Clip clip = clips_of(*database).front();
  for (const char* name : {"left_wrist", "right_ankle"}) {
    EXPECT_TRUE(is_real(clip, name, Channel::orientation));
    EXPECT_TRUE(is_real(clip, name, Channel::gravity_direction));
    const Site& worn = all_sites()[static_cast<std::size_t>(find_site(name))];
    for (int n = clip.begin; n < clip.end; ++n) {
      JointTransforms pose;
      forward_kinematics(database->skeleton(), Vec3::Zero(),
                         database->angles().row(n).transpose().cast<double>(), pose);
      const Quat expected(Mat3(pose.R_world_joint[worn.orientation] * worn.R_joint_sensor));
      const Eigen::Vector4d told =
          site(*database, name).orientation.row(n).transpose().cast<double>();
      EXPECT_LT(expected.angularDistance(quaternion_of(told).normalized()), 0.02);
    }
  }
  for (int n = 0; n < clip.begin; ++n)
    EXPECT_EQ(site(*database, "left_wrist").orientation.row(n).norm(), 0.0F);
  EXPECT_EQ(site(*database, "head").orientation.rows(), 0);
}

TEST_F(PairTake, IsKeptByFurtherEditing) {
  const PairedTake paired = take(Channel::specific_force | Channel::orientation, mounting());
  const auto before = taught(paired);
  const fs::path path = before->path();
  const auto expect_kept = [&](const MotionDatabase& database, std::size_t num_clips) {
    EXPECT_EQ(database.clips().size(), num_clips);
    const auto is = clips_of(database), was = clips_of(*before);
    ASSERT_EQ(is.size(), was.size());
    for (std::size_t c = 0; c < is.size(); ++c) {
      EXPECT_EQ(is[c].take, was[c].take);
      if (!is[c].take) continue;
      for (auto member : {&SiteRows::specific_force_end, &SiteRows::orientation})
        EXPECT_EQ(rows_of(site(database, "left_wrist").*member, is[c]),
                  rows_of(site(*before, "left_wrist").*member, was[c]));
    }
  };
  EXPECT_EQ(add_to_database(path, {file_}, folder_ / "again.smdb", ImportOptions()).num_known, 1);
  expect_kept(*MotionDatabase::open(folder_ / "again.smdb"), 36);
  drop_from_database(path, {"anna_walk_1*"}, folder_ / "dropped.smdb");
  expect_kept(*MotionDatabase::open(folder_ / "dropped.smdb"), 24);
  rebuild_database(path, {folder_ / "in", file_}, folder_ / "rebuilt.smdb", ImportOptions());
  expect_kept(*MotionDatabase::open(folder_ / "rebuilt.smdb"), 36);
}

TEST_F(PairTake, TakesThePlaceOfTheMotionWithoutATake) {
  const PairedTake paired = take(Channel::specific_force);
  const auto unpaired = plain();
  ImportOptions options;
  options.takes[file_] = paired;
  const auto report = add_to_database(unpaired->path(), {file_}, folder_ / "both.smdb", options);
  EXPECT_EQ(report.num_replaced, 1);
  const auto database = MotionDatabase::open(folder_ / "both.smdb");
  EXPECT_EQ(database->clips().size(), unpaired->clips().size());
  EXPECT_TRUE(clips_of(*database).front().take.has_value());
}

TEST_F(PairTake, LeavesTheOldClipsWhereNothingWasRecorded) {
  PairedTake paired = take(Channel::specific_force);
  paired.begin_s = 100.0;
  const auto unpaired = plain();
  ImportOptions options;
  options.takes[file_] = paired;
  try {
    add_to_database(unpaired->path(), {file_}, unpaired->path(), options);
    FAIL() << "it was taken in";
  } catch (const FormatError& error) {
    EXPECT_NE(std::string(error.what()).find("was not performed"), std::string::npos);
  }
  EXPECT_EQ(MotionDatabase::open(unpaired->path())->rows_hash(), unpaired->rows_hash());
}

}  // namespace
}  // namespace sparse_mocap
