// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/readings/sensor_sample.hpp"

#include <gtest/gtest.h>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/quaternions.hpp"
#include "sparse_mocap/readings/channel_names.hpp"
#include "support/random.hpp"

namespace sparse_mocap {
namespace {

using testing::Random;

SensorSample sample_of(Random& random) {
  SensorSample sample;
  sample.specific_force = random.vector(20.0);
  sample.angular_velocity = random.vector(5.0);
  sample.position = random.vector(3.0);
  sample.orientation = wxyz_of(random.rotation());
  return sample;
}

// A sensor turned by R on its limb, scaled and with a bias, reads what this undoes.
TEST(SensorCorrection, UndoesHowASensorIsWorn) {
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const SensorSample ideal = sample_of(random);
    const Quat q_site_sensor = random.rotation();
    const Mat3 R = q_site_sensor.toRotationMatrix();
    const Vec3 bias = random.vector(0.3);
    SensorSample worn;
    worn.specific_force = R.transpose() * ideal.specific_force / 9.8;
    worn.angular_velocity = R.transpose() * ideal.angular_velocity + bias;
    worn.position = ideal.position;
    worn.orientation = wxyz_of(quaternion_of(ideal.orientation) * q_site_sensor);
    const SensorSample found = SensorCorrection{9.8, R, bias}(worn);
    EXPECT_LT((found.specific_force - ideal.specific_force).norm(), 1e-12);
    EXPECT_LT((found.angular_velocity - ideal.angular_velocity).norm(), 1e-12);
    EXPECT_EQ(found.position, ideal.position);
    EXPECT_LT(quaternion_of(found.orientation).angularDistance(quaternion_of(ideal.orientation)),
              1e-7);
  }
}

// A quarter turn about y takes x to -z and z to x.
TEST(TrackerWorld, IsTurnedAboutTheVerticalAndMoved) {
  SensorSample sample;
  sample.specific_force = Vec3(1.0, 2.0, 3.0);
  sample.position = Vec3(1.0, 2.0, 3.0);
  sample.orientation = Eigen::Vector4d(1.0, 0.0, 0.0, 0.0);
  const SensorSample found = TrackerWorld{0.5 * kPi, Vec3(10.0, 20.0, 30.0)}(sample);
  EXPECT_LT((found.position - Vec3(13.0, 22.0, 29.0)).norm(), 1e-12);
  EXPECT_LT((quaternion_of(found.orientation) * Vec3::UnitX() + Vec3::UnitZ()).norm(), 1e-12);
  EXPECT_EQ(found.specific_force, sample.specific_force);
  EXPECT_TRUE(found.angular_velocity.array().isNaN().all());
}

TEST(SensorSample, HasWhatIsFinite) {
  SensorSample sample;
  const Channels all = Channel::specific_force | Channel::angular_velocity |
                       Channel::gravity_direction | Channel::position;
  EXPECT_FALSE(sample.has_any(all | Channel::orientation));
  sample.orientation.setZero();
  EXPECT_TRUE(sample.has_any(all | Channel::orientation));
  EXPECT_FALSE(sample.has_any(all));
  sample.angular_velocity.setZero();
  EXPECT_TRUE(sample.has_any(all));
  EXPECT_FALSE(sample.has_any(Channel::gravity_direction));
  sample.specific_force.setZero();
  EXPECT_TRUE(sample.has_any(Channel::gravity_direction));
}

TEST(SensorRecording, TellsWhatItHolds) {
  SensorRecording recording{{0.0, 1.0}, Eigen::Matrix3Xd::Ones(3, 2), {}};
  EXPECT_EQ(channels_of(recording), Channels(Channel::specific_force));
  EXPECT_TRUE(sample_at(recording, 1).angular_velocity.array().isNaN().all());
  recording.angular_velocity = Eigen::Matrix3Xd::Zero(3, 2);  // a device without a gyroscope
  EXPECT_EQ(channels_of(recording), Channels(Channel::specific_force));
  recording.angular_velocity(1, 1) = 0.1;
  EXPECT_EQ(channels_of(recording), Channel::specific_force | Channel::angular_velocity |
                                        Channels(Channel::gravity_direction));
  recording.specific_force.setConstant(SensorSample::kAbsent);
  recording.position = Eigen::Matrix3Xd::Ones(3, 2);
  recording.orientation = Eigen::Matrix4Xd::Ones(4, 2);
  EXPECT_FALSE(channels_of(recording).has(Channel::specific_force));
  EXPECT_TRUE(channels_of(recording).has_all(Channel::position | Channel::orientation));
  EXPECT_EQ(sample_at(recording, 0).orientation, Eigen::Vector4d::Ones());
}

TEST(ChannelNames, LeadThereAndBack) {
  for (const Channel channel : all_channels()) EXPECT_EQ(find_channel(name_of(channel)), channel);
  EXPECT_EQ(names_of(Channel::position | Channel::specific_force),
            (std::vector<std::string_view>{"specific_force", "position"}));
  EXPECT_THROW(find_channel("up"), ConfigError);
}

}  // namespace
}  // namespace sparse_mocap
