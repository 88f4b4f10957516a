// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/derivatives.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/synthetic.hpp"

namespace sparse_mocap::tautges2011 {
namespace {

using testing::content_of;
using testing::database_of;
using testing::swaying_motion;
using testing::template_skeleton;

// Two clips of ten frames, kept within 0.06 mm; position row n of a clip is p + v n dt + a (n dt)^2
// / 2.
class Derivatives : public ::testing::Test {
 protected:
  static constexpr double kDt = 0.04;

  Derivatives() {
    DatabaseContent content = content_of({swaying_motion(template_skeleton(), 1, 10, 25.0),
                                          swaying_motion(template_skeleton(), 2, 10, 25.0)},
                                         25.0);
    for (int clip = 0; clip < 2; ++clip)
      testing::change_rows(content, static_cast<std::size_t>(clip), [&](DatabaseRows& rows) {
        for (int n = 0; n < 10; ++n)
          rows.positions.row(n) = position(clip, n).transpose().cast<float>();
      });
    database_ = database_of(content);
  }

  static Eigen::VectorXd velocity(int clip, double n) {
    return Eigen::VectorXd::LinSpaced(63, -1.0, 1.0 + clip).array() +
           acceleration(clip)[0] * n * kDt;
  }
  static Eigen::VectorXd acceleration(int clip) {
    return Eigen::VectorXd::Constant(63, 2.0 - 5.0 * clip);
  }
  static Eigen::VectorXd position(int clip, double n) {
    return Eigen::VectorXd::LinSpaced(63, 0.0, 1.0) + velocity(clip, 0.5 * n) * n * kDt;
  }

  std::shared_ptr<const MotionDatabase> database_;
};

TEST_F(Derivatives, FindsVelocitiesAndAccelerationsOfAParabolaInsideItsClip) {
  Eigen::VectorXd v(63), a(63);
  for (int clip = 0; clip < 2; ++clip) {
    for (int n = 0; n < 10; ++n) {
      kinematics_at(*database_, 10 * clip + n, v, a);
      const double centre = std::clamp(n, 1, 8);  // the ends take their neighbour's
      EXPECT_LT((v - velocity(clip, centre)).cwiseAbs().maxCoeff(), 2e-3);
      EXPECT_LT((a - acceleration(clip)).cwiseAbs().maxCoeff(), 0.16);
    }
  }
}

TEST_F(Derivatives, LooksEveryQuantityUpAtItsFrame) {
  const std::vector<retrieval::Path> paths{
      {13, 3.0, 2, 12}, {4, 2.0, 2, 2}, {10, 1.0, 1, -1}, {7, 1.0, 1, -1}};
  const PathDerivatives found = path_derivatives(*database_, paths);
  const auto expect = [&](Eigen::Index i, int clip, double n, double before) {
    EXPECT_LT((found.velocities.col(i) - velocity(clip, std::max(n, 1.0))).cwiseAbs().maxCoeff(),
              2e-3);
    EXPECT_LT((found.velocities_before.col(i) - velocity(clip, std::max(before, 1.0)))
                  .cwiseAbs()
                  .maxCoeff(),
              2e-3);
    EXPECT_LT((found.accelerations.col(i) - acceleration(clip)).cwiseAbs().maxCoeff(), 0.16);
  };
  expect(0, 1, 3, 2);
  expect(1, 0, 4, 2);
  expect(2, 1, 0, 0);  // the first frame of a clip: nothing before it is used
  expect(3, 0, 7, 6);
}

}  // namespace
}  // namespace sparse_mocap::tautges2011
