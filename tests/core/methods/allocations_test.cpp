// SPDX-License-Identifier: GPL-3.0-or-later
//
// A program of its own, for it counts every allocation: new and Eigen both come down to these.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>

#include "sparse_mocap/methods/registry.hpp"
#include "sparse_mocap/sensors/sites.hpp"
#include "support/synthetic.hpp"

namespace {

thread_local bool is_counting = false;
thread_local int num_allocations = 0;

void count() { num_allocations += is_counting ? 1 : 0; }

}  // namespace

// What these stand for in glibc.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  count();
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  count();
  return __libc_calloc(number, size);
}
void* realloc(void* memory, std::size_t size) {
  count();
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count();
  return __libc_memalign(alignment, size);
}
}

namespace sparse_mocap {
namespace {

using testing::swaying_motion;
using testing::template_skeleton;

// Calls work and gives how often memory was allocated meanwhile.
template <typename Work>
int allocations_of(const Work& work) {
  num_allocations = 0;
  is_counting = true;
  work();
  is_counting = false;
  return num_allocations;
}

TEST(Allocations, AreCounted) {
  EXPECT_EQ(allocations_of([] {}), 0);
  EXPECT_EQ(allocations_of([] { Eigen::VectorXd(7).setZero(); }), 1);
  EXPECT_EQ(allocations_of([] { std::string(100, 'x').clear(); }), 1);
}

// All of a sensor's channels; as while nothing is received from it.
void silence(Reading& reading, Eigen::Index sensor) {
  reading.specific_force.col(sensor).setConstant(NAN);
  reading.angular_velocity.col(sensor).setConstant(NAN);
  reading.gravity_direction.col(sensor).setConstant(NAN);
  reading.orientation.col(sensor).setConstant(NAN);
}

class FrameOf : public ::testing::TestWithParam<std::string> {};

TEST_P(FrameOf, AllocatesNothingOnceItHasItsMemory) {
  std::vector<Motion> motions;
  for (unsigned seed = 0; seed < 12; ++seed)
    motions.push_back(swaying_motion(template_skeleton(), seed, 200, 50.0));
  const auto database = testing::database_of(motions);
  for (const Channels channels :
       {Channels(Channel::specific_force),
        Channel::specific_force | Channel::gravity_direction | Channel::angular_velocity,
        Channel::specific_force | Channel::orientation}) {
    auto sensors = testing::paper_sensors();
    sensors.push_back({find_site("pelvis")});
    sensors.push_back({find_site("head")});
    for (Sensor& sensor : sensors) sensor.channels = channels;
    const auto method =
        make_live_method(find_method(GetParam()), {}, {database, nullptr, {}, sensors, {}});
    auto take = testing::readings_of(*database, 3, sensors);
    PoseEstimate estimate;
    constexpr std::size_t kWarmUp = 40;
    ASSERT_GT(take.size(), kWarmUp + 40);
    for (std::size_t t = kWarmUp + 10; t < take.size(); ++t)
      for (const Eigen::Index sensor : {1, 4})
        if ((t / 5 + static_cast<std::size_t>(sensor)) % 3 == 0) silence(take[t], sensor);
    for (std::size_t t = 0; t < kWarmUp; ++t) method->step_into(take[t], estimate);
    for (std::size_t t = kWarmUp; t < take.size(); ++t)
      EXPECT_EQ(allocations_of([&] { method->step_into(take[t], estimate); }), 0) << t;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, FrameOf, ::testing::Values("path_regression", "tautges2011"),
                         [](const auto& tested) { return tested.param; });

}  // namespace
}  // namespace sparse_mocap
