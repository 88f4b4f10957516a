// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/packed_rows.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/random.hpp"
#include "support/refusals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using Rows = DatabaseRows::Rows;

Rows numbers_up_to(float magnitude, unsigned seed) {
  testing::Random random(seed);
  Rows rows(50, 3);
  for (Eigen::Index n = 0; n < rows.size(); ++n)
    rows.data()[n] = static_cast<float>(random.in(-1.0, 1.0)) * magnitude;
  rows(7, 1) = -magnitude;
  return rows;
}

TEST(PackedRows, LoseAtMostHalfAScaleWhateverTheMagnitude) {
  for (const float magnitude : {1e-9F, 0.01F, 0.9999F, 1.0F, 32767.0F, 32768.0F, 250.0F, 1e29F}) {
    const Rows rows = numbers_up_to(magnitude, 3);
    const PackedArray array = packed(rows);
    const Rows again = unpacked(array);
    EXPECT_LE((again - rows).cwiseAbs().maxCoeff(), 0.5F * array.scale) << magnitude;
    // A power of two, at most twice as large as it must be, and no smaller than a millionth.
    int exponent = 0;
    EXPECT_EQ(std::frexp(array.scale, &exponent), 0.5F);
    EXPECT_LE(array.scale, std::max(2.001F * magnitude / 32767.0F, 1e-6F)) << magnitude;
  }
}

TEST(PackedRows, GiveTheSameWhenPackedAgain) {
  for (unsigned seed = 1; seed < 200; ++seed) {
    const PackedArray once = packed(numbers_up_to(0.37F * static_cast<float>(seed), seed));
    const PackedArray twice = packed(unpacked(once));
    EXPECT_EQ(once.scale, twice.scale);
    EXPECT_EQ(once.values, twice.values);
  }
  EXPECT_EQ(unpacked(packed(Rows(Rows::Zero(4, 2)))), Rows::Zero(4, 2));
}

TEST(PackedRows, RefuseWhatIsNoNumberOrImpossible) {
  Rows rows = numbers_up_to(1.0F, 1);
  rows(3, 2) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_REFUSED(std::invalid_argument, "not a number", packed(rows));
  rows(3, 2) = 3e38F;
  EXPECT_REFUSED(std::invalid_argument, "impossible", packed(rows));
}

TEST(PackedRows, KeepAPoseWhoseAnglesHaveWound) {
  DatabaseRows rows =
      database_rows(testing::swaying_motion(testing::template_skeleton(), 1, 40, 25.0), 25.0);
  const Rows before = rows.angles;
  rows.angles.array() += static_cast<float>(6.0 * kPi);
  const DatabaseRows again = unpacked(packed(rows));
  EXPECT_LT((again.angles.array().sin() - before.array().sin()).abs().maxCoeff(), 2e-4F);
  EXPECT_LT((again.angles.array().cos() - before.array().cos()).abs().maxCoeff(), 2e-4F);
  EXPECT_LE(again.angles.cwiseAbs().maxCoeff(), 3.1417F);
}

// Half a tenth of a millimetre and a millimetre per second squared, of a motion as people move.
TEST(PackedRows, LoseLessThanSensorsAndMarkersCanTell) {
  const DatabaseRows rows =
      database_rows(testing::swaying_motion(testing::template_skeleton(), 5, 250, 100.0), 25.0);
  const DatabaseRows again = unpacked(packed(rows));
  EXPECT_LT((again.positions - rows.positions).cwiseAbs().maxCoeff(), 6e-5F);
  EXPECT_LT((again.gravity_direction - rows.gravity_direction).cwiseAbs().maxCoeff(), 3e-5F);
  EXPECT_EQ(again.contacts, rows.contacts);
  EXPECT_EQ(again.root_motion, rows.root_motion);
  const float fastest = rows.specific_force_end.cwiseAbs().maxCoeff();
  EXPECT_LT((again.specific_force_end - rows.specific_force_end).cwiseAbs().maxCoeff(),
            fastest / 32767.0F);
}

}  // namespace
}  // namespace sparse_mocap
