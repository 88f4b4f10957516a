// SPDX-License-Identifier: GPL-3.0-or-later
//
// The ways in which Acclaim's files differ, each with the numbers that it means.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>

#include "formats/acclaim_test_files.hpp"
#include "formats/textbook_rotations.hpp"

namespace sparse_mocap {
namespace {

using testing::has_warning;
using testing::kAmc;
using testing::kAsf;
using testing::kOrders;
using testing::matrix_of;
using testing::read_acclaim_text;
using testing::read_asf_text;
using testing::replaced;

constexpr std::array<const char*, 3> kAnglesOutermostFirst{
    "53.13010235415598", "22.619864948040426", "28.072486935852957"};

std::string with_line_ends(const std::string& text, const std::string& line_end) {
  std::string result;
  for (const char c : text) result += c == '\n' ? line_end : std::string(1, c);
  return result;
}

// The three angles in the order x y z.
std::string angles_xyz(const std::string& order) {
  std::string result;
  for (const char letter : {'X', 'Y', 'Z'})
    result += std::string(kAnglesOutermostFirst[order.find(letter)]) + " ";
  return result;
}

TEST(AcclaimDialects, AxesInAllSixOrders) {
  for (const auto& order : kOrders) {
    const std::string outermost_first = order.name;
    const std::string first_turn_first(outermost_first.rbegin(), outermost_first.rend());
    const auto asf = read_asf_text(
        replaced(kAsf, "axis 0 0 0 XYZ", "axis " + angles_xyz(outermost_first) + first_turn_first));
    EXPECT_LT((asf.skeleton.joint(1).R_joint_axes - matrix_of(order)).cwiseAbs().maxCoeff(), 1e-14)
        << order.name;
  }
}

TEST(AcclaimDialects, DofAndRootInAllSixOrders) {
  for (const auto& order : kOrders) {
    std::string dof;
    std::string values;
    for (const int i : {2, 1, 0}) {  // what turns first comes first
      dof += std::string(" R") + order.name[i];
      values += " " + std::string(kAnglesOutermostFirst[static_cast<std::size_t>(i)]);
    }
    auto asf = replaced(kAsf, "dof rx ry rz", "dof" + dof);
    asf = replaced(asf, "order TX TY TZ RX RY RZ", "order" + dof + " TZ TX TY");
    auto amc = replaced(kAmc, "root 1 2 3 0 0 90\nthigh 90 90 0",
                        "root" + values + " 3 1 2\nthigh" + values);
    amc = replaced(amc, "root 1 2 3 0 0 0", "root 0 0 0 3 1 2");
    const auto motion = read_acclaim_text(asf, amc).motion;
    EXPECT_EQ(motion.root_positions[1], Vec3(1, 2, 3));
    for (const int joint : {0, 1})
      EXPECT_LT((motion.rotation(1, joint).toRotationMatrix() - matrix_of(order)).norm(), 1e-14)
          << order.name;
  }
}

TEST(AcclaimDialects, LimitsMayComeBeforeDof) {
  const auto dof = kAsf.find("    dof rx ry rz\n");
  const auto limits = kAsf.find("    limits (-160.0");
  const auto end = kAsf.find("  end\n");
  const auto swapped = kAsf.substr(0, dof) + kAsf.substr(limits, end - limits) +
                       kAsf.substr(dof, limits - dof) + kAsf.substr(end);
  const auto asf = read_asf_text(swapped);
  EXPECT_TRUE(asf.warnings.empty());
  EXPECT_EQ(asf.channels[1].size(), 3U);
}

TEST(AcclaimDialects, LineEndsMarksAndOtherEncodingsDoNotMatter) {
  const std::string latin1 = "# f\xFCr Bonn\n";
  for (const auto* line_end : {"\r\n", "\r", " \t\r\n\r\n"}) {
    const auto file = read_acclaim_text("\xEF\xBB\xBF" + with_line_ends(latin1 + kAsf, line_end),
                                        with_line_ends(latin1 + kAmc, line_end));
    EXPECT_EQ(file.motion.skeleton.num_joints(), 4);
    EXPECT_EQ(file.motion.num_frames(), 2);
    EXPECT_TRUE(file.warnings.empty());
  }
  const auto named = [](const std::string& name) {
    return read_acclaim_text(
        replaced(replaced(kAsf, "name shin", "name " + name), "thigh shin", "thigh " + name),
        replaced(replaced(kAmc, "shin 0", name + " 0"), "shin 90", name + " 90"));
  };
  EXPECT_EQ(named("H\xC3\xBC"
                  "fte")
                .motion.skeleton.joint(2)
                .name,
            "H\xC3\xBC"
            "fte");
  EXPECT_EQ(named("rig:shin").motion.skeleton.joint(2).name, "rig:shin");
}

TEST(AcclaimDialects, NamesThatAreNotUtf8AreTheSameInBothFiles) {
  const std::string name =
      "H\xFC"
      "fte";
  auto asf = replaced(replaced(kAsf, "name shin", "name " + name), "thigh shin", "thigh " + name);
  auto amc = replaced(replaced(kAmc, "shin 0", name + " 0"), "shin 90", name + " 90");
  const auto file = read_acclaim_text(asf, amc);
  EXPECT_EQ(file.motion.skeleton.joint(2).name, "H\\xfcfte");
  EXPECT_TRUE(has_warning(file, "not UTF-8"));
}

TEST(AcclaimDialects, NumbersOfEveryPrinter) {
  for (const char* quarter : {"9e001", "9.0E+001", "+90", "90.", ".9e2", "900000e-004", "0090"}) {
    const auto amc =
        replaced(kAmc, "root 1 2 3 0 0 90", std::string("root 1 +2. .3e1 -.0 6e-014 ") + quarter);
    const auto motion = read_acclaim_text(kAsf, amc).motion;
    EXPECT_TRUE(motion.root_positions[1].isApprox(Vec3(1, 2, 3)));
    EXPECT_NEAR(Eigen::AngleAxisd(motion.rotation(1, 0)).angle(), kPi / 2, 1e-12) << quarter;
  }
}

TEST(AcclaimDialects, RadiansAndLengthUnitsTogether) {
  auto asf = replaced(kAsf, "length 0.0254\n  angle deg", "angle rad\n  length 0.01");
  asf = replaced(asf, "axis 0 0 0 XYZ", "axis 0 0 1.5707963267948966 XYZ");
  const auto file = read_acclaim_text(asf, replaced(kAmc, ":DEGREES\n", ""));
  EXPECT_TRUE(file.motion.root_positions[1].isApprox(2.54 * Vec3(1, 2, 3)));
  EXPECT_TRUE(file.motion.skeleton.joint(1).bone.isApprox(2.54 * Vec3(0, -0.5, 0)));
  EXPECT_TRUE(file.motion.skeleton.joint(1).R_joint_axes.isApprox(
      (Mat3() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished()));
}

TEST(AcclaimDialects, WarningsOfAKindAreCounted) {
  std::string text = kAsf;
  for (int i = 0; i < 3; ++i)
    text = replaced(text, "    id " + std::to_string(i + 1), "    colour red");
  const auto asf = read_asf_text(text);
  ASSERT_EQ(asf.warnings.size(), 1U);
  EXPECT_EQ(asf.warnings[0].count, 3);
  EXPECT_EQ(asf.warnings[0].location.line, 17);
}

}  // namespace
}  // namespace sparse_mocap
