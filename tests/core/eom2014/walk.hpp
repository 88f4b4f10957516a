// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "sparse_mocap/eom2014/method.hpp"
#include "sparse_mocap/eom2014/reconstructor.hpp"
#include "sparse_mocap/eom2014/training_sequence.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::eom2014 {

// Legs that swing against each other, the pelvis as high as the lower foot allows: a walk on the
// spot in which each foot leaves the floor.
inline Motion walking_motion(int frames, double rate_hz) {
  const Skeleton skeleton = sparse_mocap::testing::template_skeleton();
  Motion motion = sparse_mocap::testing::resting_motion(skeleton, frames, rate_hz);
  const auto bent = [](double angle) { return Quat(Eigen::AngleAxisd(angle, Vec3::UnitX())); };
  for (int t = 0; t < frames; ++t) {
    const double turn = 2.0 * kPi * t / rate_hz;
    const double left = std::max(0.0, std::sin(turn)), right = std::max(0.0, -std::sin(turn));
    using namespace standard_joint;
    motion.rotation(t, lfemur) = bent(-0.7 * left);
    motion.rotation(t, ltibia) = bent(1.2 * left);
    motion.rotation(t, rfemur) = bent(-0.7 * right);
    motion.rotation(t, rtibia) = bent(1.2 * right);
    motion.rotation(t, lhumerus) = bent(0.4 * std::sin(turn));
  }
  return motion;
}

inline Sensor ankle() { return {find_site("left_ankle"), 1.0, Channel::specific_force}; }

inline std::vector<Reading> take_of(const Motion& motion) {
  const auto sequence =
      training_sequences({{"take", "", motion, {}, {}}}, {find_site("left_ankle"), 1.0, 30.0})
          .front();
  std::vector<Reading> take;
  for (Eigen::Index t = 0; t < sequence.readings.rows(); ++t) {
    Reading reading(1);
    reading.time_s = static_cast<double>(t) / 30.0;
    reading.specific_force.col(0) = sequence.readings.row(t).head<3>();
    reading.angular_velocity.col(0) = sequence.readings.row(t).tail<3>();
    take.push_back(reading);
  }
  return take;
}

// A model of that walk.
class EomWalk : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const MethodSettings settings{"", {{"iterations", "60"}}};
    model_ = std::make_shared<Model>(
        method().train(settings, {{"walk", "", walking_motion(360, 120.0), {}, {}}}, Progress()));
  }
  static void TearDownTestSuite() { model_.reset(); }

  template <typename Method = Reconstructor>
  static Method made(const OptionValues& options = {}, Sensor sensor = ankle()) {
    MethodContext context;
    context.model = model_;
    context.sensors = {sensor};
    return Method({"", options}, context);
  }

  static std::shared_ptr<const Model> model_;
};

inline std::shared_ptr<const Model> EomWalk::model_;

}  // namespace sparse_mocap::eom2014
