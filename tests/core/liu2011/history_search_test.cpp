// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/history_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "liu2011/bodies.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::liu2011 {
namespace {

using retrieval::Neighbour;
using testing::swaying_motion;
using testing::template_skeleton;

constexpr int kPoses = 3;

class Search : public ::testing::Test {
 protected:
  static std::vector<Motion> motions() {
    std::vector<Motion> made;
    for (unsigned seed = 0; seed < 6; ++seed)
      made.push_back(swaying_motion(template_skeleton(), seed, 100, 25.0));
    return made;
  }
  std::vector<BodyPose> history(int frame) const {
    std::vector<BodyPose> poses;
    for (const auto& place : examples_.history(frame, kPoses))
      poses.push_back(place.heading.to_parent(examples_.pose(place.frame)));
    return poses;
  }
  std::vector<Observation> sensors(int frame) const {
    return sensors_of(examples_.body(), worn_, examples_.next(frame));
  }
  std::vector<Neighbour> found(const SearchWeights& weights, int frame,
                               const std::vector<Observation>& observed, int k) const {
    const HistorySearch search(examples_, worn_, weights, all_);
    std::vector<Neighbour> out;
    search.search(history(frame), observed, k, out);
    return out;
  }

  const MotionExamples examples_{testing::database_of(motions()), template_skeleton()};
  const std::vector<WornSensor> worn_ = worn_sensors(
      template_skeleton(), {{find_site("left_hand"), 1.0, Channel::position | Channel::orientation},
                            {find_site("head"), 1.0, Channel::position}});
  const std::vector<bool> all_ = std::vector<bool>(600, true);
};

// All distances of the whole histories' vectors, one after another.
TEST_F(Search, FindsTheNearestOfAllHistories) {
  for (const int asked : {50, 333, 571}) {
    const Eigen::VectorXd query = pose_vectors(examples_.body(), examples_.mean(), history(asked));
    std::vector<std::pair<double, int>> distances;
    for (int frame = 0; frame < 600; ++frame)
      distances.emplace_back(
          (pose_vectors(examples_.body(), examples_.mean(), history(frame)) - query).norm(), frame);
    std::sort(distances.begin(), distances.end());
    std::set<int> nearest;
    for (int i = 0; i < 40; ++i) nearest.insert(distances[static_cast<std::size_t>(i)].second);
    int agreed = 0;
    for (const Neighbour& one : found({kPoses, 0.0, 0.0}, asked, {}, 40)) {
      agreed += nearest.contains(one.row) ? 1 : 0;
      const auto whole = std::find_if(distances.begin(), distances.end(),
                                      [&](const auto& d) { return d.second == one.row; });
      EXPECT_NEAR(static_cast<double>(one.distance), whole->first, 0.05 * whole->first + 0.15);
    }
    EXPECT_GE(agreed, 38);  // the axes hold nearly all of the variance
  }
}

TEST_F(Search, FindsTheFrameThatFollowsAHistory) {
  for (const int frame : {20, 250, 599}) {
    EXPECT_EQ(found({kPoses, 0.0, 0.0}, frame, {}, 1).front().row, frame);
    EXPECT_EQ(found({kPoses, 5.0, 1.0}, frame, sensors(frame), 1).front().row, frame);
  }
}

TEST_F(Search, AddsTheDistanceOfTheSensors) {
  const int frame = 250;
  auto observed = sensors(frame);
  observed[1].has_orientation = false;  // as its channels say
  const Neighbour near = found({kPoses, 5.0, 2.0}, frame, observed, 1).front();
  ASSERT_EQ(near.row, frame);
  observed[0].measured.position += Vec3(0.0, 0.1, 0.0);
  observed[1].measured.position += Vec3(0.2, 0.0, 0.0);
  auto all = found({kPoses, 5.0, 2.0}, frame, observed, 600);
  const auto moved =
      std::find_if(all.begin(), all.end(), [&](const Neighbour& one) { return one.row == frame; });
  EXPECT_NEAR(static_cast<double>(moved->distance), std::sqrt(0.5 * 0.5 + 1.0), 1e-3);
  // What is not measured does not count.
  observed.pop_back();
  all = found({kPoses, 5.0, 2.0}, frame, observed, 600);
  const auto less =
      std::find_if(all.begin(), all.end(), [&](const Neighbour& one) { return one.row == frame; });
  EXPECT_NEAR(static_cast<double>(less->distance), 0.5, 1e-3);
}

TEST_F(Search, NeverFindsWhatIsNotSearched) {
  std::vector<bool> some = all_;
  std::fill(some.begin() + 200, some.begin() + 300, false);
  const HistorySearch search(examples_, worn_, {kPoses, 0.0, 0.0}, some);
  EXPECT_EQ(search.num_rows(), 500);
  std::vector<Neighbour> out;
  search.search(history(250), {}, 500, out);
  for (const Neighbour& one : out) EXPECT_FALSE(one.row >= 200 && one.row < 300);
}

}  // namespace
}  // namespace sparse_mocap::liu2011
