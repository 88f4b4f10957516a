// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "formats/acclaim_test_files.hpp"

namespace sparse_mocap {
namespace {

using namespace std::string_literals;
using testing::contains;
using testing::kAsf;
using testing::read_asf_text;
using testing::replaced;
using testing::TemporaryFolder;

std::string error_in(const std::string& asf, const ReadOptions& options = {}) {
  return testing::error_of([&] { read_asf_text(asf, options); });
}

std::string error_with(const std::string& from, const std::string& to) {
  return error_in(replaced(kAsf, from, to));
}

bool has_warning(const AcclaimSkeleton& asf, const std::string& part) {
  return std::ranges::any_of(asf.warnings,
                             [&](const auto& warning) { return contains(warning.text, part); });
}

Mat3 matrix(const std::array<double, 9>& rows) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
}

// Quarter turns: about x first and y then (z kept out), and about y first and x then.
const Mat3 kXThenY = matrix({0, 1, 0, 0, 0, -1, -1, 0, 0});
const Mat3 kYThenX = matrix({0, 0, 1, 1, 0, 0, 0, 1, 0});

TEST(ReadAsf, ReadsBonesInMetres) {
  const auto asf = read_asf_text(kAsf);
  const auto& skeleton = asf.skeleton;
  ASSERT_EQ(skeleton.num_joints(), 4);
  EXPECT_EQ(skeleton.joint(0).name, "root");
  EXPECT_EQ(skeleton.find("thigh"), 1);
  EXPECT_EQ(skeleton.find("shin"), 2);
  EXPECT_EQ(skeleton.find("fin"), 3);
  EXPECT_EQ(skeleton.joint(3).parent, 1);
  EXPECT_TRUE(skeleton.joint(1).bone.isApprox(Vec3(0, -0.5, 0)));
  EXPECT_EQ(skeleton.joint(1).offset_parent, Vec3(0, 0, 0));
  EXPECT_EQ(skeleton.joint(1).axes, (std::vector<Axis>{Axis::z, Axis::y, Axis::x}))
      << "the last of `dof` is outermost";
  EXPECT_EQ(skeleton.joint(2).axes, std::vector<Axis>{Axis::x}) << "limits (0 0) keep the channel";
  EXPECT_TRUE(skeleton.joint(3).axes.empty());
  EXPECT_TRUE(asf.warnings.empty());
}

TEST(ReadAsf, HonoursUnits) {
  const auto inches = read_asf_text(replaced(kAsf, "length 0.0254", "length 0.45"));
  EXPECT_NEAR(inches.skeleton.joint(1).bone.y(), -0.5 / 0.45 * 0.0254, 1e-15);
  EXPECT_TRUE(has_warning(inches, "the figure measures"));
  const auto radians = read_asf_text(replaced(replaced(kAsf, "angle deg", "angle rad"),
                                              "axis 0 0 0 XYZ", "axis 1.5707963267948966 0 0 XYZ"));
  EXPECT_TRUE(
      radians.skeleton.joint(1).R_joint_axes.isApprox(matrix({1, 0, 0, 0, 0, -1, 0, 1, 0})));
  EXPECT_EQ(radians.radians_per_angle, 1.0);
  const auto none =
      read_asf_text(replaced(kAsf, ":units\n  mass 1.0\n  length 0.0254\n  angle deg\n", ""));
  EXPECT_TRUE(has_warning(none, "no :units"));
  EXPECT_NEAR(none.skeleton.joint(1).bone.y(), -0.5 * 0.0254, 1e-15);
}

TEST(ReadAsf, HonoursTheOrderOfAxes) {
  // The numbers are always those about x, y and z; the letters say which turns first.
  const auto asf_with = [](const std::string& axis) {
    return read_asf_text(replaced(kAsf, "axis 0 0 0 XYZ", "axis " + axis))
        .skeleton.joint(1)
        .R_joint_axes;
  };
  EXPECT_TRUE(asf_with("90 90 0 XYZ").isApprox(kXThenY));
  EXPECT_TRUE(asf_with("90 90 0 ZXY").isApprox(kXThenY));
  EXPECT_TRUE(asf_with("90 90 0 ZYX").isApprox(kYThenX));
  EXPECT_TRUE(asf_with("90 90 0 yxz").isApprox(kYThenX));
  EXPECT_TRUE(asf_with("0 0 90 ZYX").isApprox(matrix({0, -1, 0, 1, 0, 0, 0, 0, 1})));
}

TEST(ReadAsf, SectionsMayComeInAnyOrder) {
  const auto hierarchy_at = kAsf.find(":hierarchy");
  const auto bones_at = kAsf.find(":bonedata");
  const auto root_at = kAsf.find(":root");
  const auto text = kAsf.substr(hierarchy_at) + kAsf.substr(bones_at, hierarchy_at - bones_at) +
                    kAsf.substr(root_at, bones_at - root_at) + kAsf.substr(0, root_at);
  const auto asf = read_asf_text(text);
  EXPECT_TRUE(asf.skeleton.joint(1).bone.isApprox(Vec3(0, -0.5, 0)));
  EXPECT_EQ(asf.skeleton.joint(2).name, "shin");
}

TEST(ReadAsf, CommasAndParenthesesAreBlanks) {
  auto text = replaced(kAsf, "direction 0 -1 0", "direction (0, -1, 0) # down");
  text = replaced(text, "dof rx ry rz", "dof (rx, ry, rz)");
  text = replaced(text, "thigh shin fin", "thigh, shin, fin");
  const auto asf = read_asf_text(text);
  EXPECT_TRUE(asf.skeleton.joint(1).bone.isApprox(Vec3(0, -0.5, 0)));
  EXPECT_EQ(asf.skeleton.num_joints(), 4);
}

TEST(ReadAsf, NamesHaveNoCase) {
  const auto asf = read_asf_text(replaced(kAsf, "root thigh", "ROOT Thigh"));
  EXPECT_EQ(asf.skeleton.find("thigh"), 1);
}

TEST(ReadAsf, TakesEveryChannelInTheOrderOfTheFile) {
  const auto asf = read_asf_text(replaced(kAsf, "dof rx\n", "dof rz tx l rx ty\n"));
  using enum AcclaimChannel;
  EXPECT_EQ(asf.channels[2], (std::vector<AcclaimChannel>{rz, tx, length, rx, ty}));
  EXPECT_EQ(asf.skeleton.joint(2).axes, (std::vector<Axis>{Axis::x, Axis::z}));
}

TEST(ReadAsf, LimitsMayBeManyOrFew) {
  EXPECT_TRUE(has_warning(read_asf_text(replaced(kAsf, "           (-inf inf)\n", "")),
                          "bone \"thigh\" has 4 limits for 3 channels"));
  EXPECT_TRUE(read_asf_text(replaced(kAsf, "(-160.0 20.0)\n           (-70.0 70.0)\n",
                                     "(-160.0 20.0) (-INF +inf)\n"))
                  .warnings.empty());
}

TEST(ReadAsf, NormalisesDirections) {
  const auto asf = read_asf_text(replaced(kAsf, "direction 0 -1 0", "direction 0 -2 0"));
  EXPECT_TRUE(asf.skeleton.joint(1).bone.isApprox(Vec3(0, -0.5, 0)));
  EXPECT_TRUE(has_warning(asf, "not a unit vector"));
  const auto point = read_asf_text(
      replaced(replaced(kAsf, "direction 1 0 0", "direction 0 0 0"), "length 0.1", "length 0"));
  EXPECT_EQ(point.skeleton.joint(3).bone, Vec3(0, 0, 0));
}

TEST(ReadAsfRefuses, BadBones) {
  EXPECT_EQ(
      error_with("direction 0 -1 0", "direction 0 0 0"),
      "18: :18:10: the direction of bone \"thigh\" is zero; give it a direction, or the length 0");
  EXPECT_EQ(error_with("length 0.5", "length -0.5"),
            "20: :20:12: the length of a bone is negative; reverse its direction instead");
  EXPECT_EQ(error_with("length 0.5", "length 1e30"),
            "18: :18:10: bone \"thigh\" is impossibly long; check its length and the unit of "
            "the file");
  EXPECT_EQ(error_with("direction 0 -1 0", "direction 0 -1"),
            "20: :20:5: expected 3 numbers after direction, got \"length\"; write a decimal number "
            "such as -1.5");
  EXPECT_EQ(error_with("axis 0 0 0 XYZ", "axis 0 0 0 XXZ"),
            "21: :21:16: expected an order of rotations such as XYZ, got \"XXZ\"; name each of X, "
            "Y and Z once");
  EXPECT_EQ(error_with("dof rx ry rz", "dof rx ry rq"),
            "22: :22:15: unknown channel \"rq\"; use rx, ry, rz, tx, ty, tz or l");
  EXPECT_EQ(error_with("dof rx ry rz", "dof rx rx"),
            "22: :22:12: channel \"rx\" is listed twice; remove one of them");
  EXPECT_EQ(error_with("    name thigh\n", ""),
            "16: :16:3: a bone has no name; add a line with its name");
  EXPECT_EQ(error_with("name shin", "name THIGH"),
            "29: :29:10: a second bone is named \"THIGH\"; give it another name");
  EXPECT_EQ(error_with("name shin", "name root"),
            "29: :29:10: a bone cannot be named root; give it another name");
  EXPECT_EQ(error_with("  end\n:hierarchy", ":hierarchy"),
            "42: :42:1: the bone that begins in line 36 has no end; the file may be cut off, or a "
            "line end is missing");
}

TEST(ReadAsfRefuses, BadHierarchies) {
  const std::string from = "    thigh shin fin\n";
  EXPECT_EQ(
      error_with(from, "    thigh shin foot fin\n"),
      "46: :46:16: bone \"foot\" is not defined in :bonedata; define it there, or leave it out");
  EXPECT_EQ(error_with(from, "    thigh shin fin\n    shin fin\n"),
            "47: :47:10: bone \"fin\" has two parents; name it once");
  EXPECT_EQ(error_with(from, "    thigh shin fin root\n"),
            "46: :46:20: the root cannot be a child; leave it out");
  EXPECT_EQ(error_with(from, "    thigh shin\n"),
            "38: :38:10: bone \"fin\" cannot be reached from the root: :hierarchy does not mention "
            "it as a child; name each bone once as a child");
  EXPECT_EQ(error_with(from, "    shin fin\n    fin shin\n"),
            "29: :29:10: bone \"shin\" cannot be reached from the root: :hierarchy has a cycle "
            "above it; name each bone once as a child");
  std::string many = "    thigh shin fin";
  for (int i = 0; i < 100'000; ++i) many += " b" + std::to_string(i);
  EXPECT_EQ(
      error_with(from, many + "\n"),
      "46: :46:20: bone \"b0\" is not defined in :bonedata; define it there, or leave it out");
}

TEST(ReadAsfRefuses, SkeletonsBeyondTheLimits) {
  std::string bones;
  std::string families = "root b0\n";
  for (int i = 0; i < 2000; ++i) {
    const auto number = std::to_string(i);
    bones += "begin\nname b" + number + "\ndirection 0 1 0\nlength 1\nend\n";
    if (i > 0) families += "b" + std::to_string(i - 1) + " b" + number + "\n";
  }
  const auto text =
      ":root\norder rx\n:bonedata\n" + bones + ":hierarchy\nbegin\n" + families + "end\n";
  EXPECT_TRUE(contains(error_in(text), "there are more than 1024 bones"));
  EXPECT_TRUE(contains(error_in(text, {.max_joints = 5000}), "nested deeper than 256"));
}

TEST(ReadAsfRefuses, BadSections) {
  EXPECT_EQ(error_in(""), "1: :1:1: the file is empty; export it again");
  EXPECT_EQ(error_in("hello"),
            "1: :1:1: expected a section such as :units, got \"hello\"; choose an .asf file");
  EXPECT_EQ(error_with("angle deg", "angle grad"),
            "7: :7:9: expected deg or rad after angle, got \"grad\"; write angle deg or angle rad");
  EXPECT_EQ(error_with("length 0.0254", "length 0"),
            "6: :6:3: the unit of length must be positive; 0.45 is usual, 1 means inches");
  EXPECT_EQ(error_in(kAsf.substr(0, kAsf.find(":hierarchy"))),
            "43: :43:1: there is no :hierarchy section; the file may be cut off; export it again");
  EXPECT_EQ(error_in(kAsf + ":root\n"),
            "48: :48:1: a second section \":root\"; remove one of them");
  EXPECT_EQ(error_in("\xFF\xFE"), "1: :1:1: is UTF-16 text; save it as UTF-8");
}

TEST(ReadAsfRefuses, ARootThatIsNowhere) {
  EXPECT_EQ(error_with("position 0 0 0", "position 0 1e30 0"),
            "13: :13:3: the position of the root is out of range; check the number and "
            "the unit of the file");
}

TEST(ReadAsfRefuses, EveryTruncation) {
  const TemporaryFolder folder;
  for (std::size_t length = 0; length + 1 < kAsf.size(); ++length) {
    const auto path = folder.write("cut.asf", kAsf.substr(0, length));
    EXPECT_NE(testing::error_of([&] { read_asf(path); }), "") << length;
  }
}

TEST(FindAsf, FindsTheSkeletonOfTheActor) {
  const TemporaryFolder folder;
  folder.write("HDM_bd.asf", "");
  folder.write("HDM_bk.ASF", "");
  folder.write("02.asf", "");
  EXPECT_EQ(find_asf(folder / "HDM_bd_squat1Reps_001_120.amc"), folder / "HDM_bd.asf");
  EXPECT_EQ(find_asf(folder / "hdm_bk_squat1Reps_001_120.AMC"), folder / "HDM_bk.ASF");
  EXPECT_EQ(find_asf(folder / "02_01.amc"), folder / "02.asf");
  EXPECT_EQ(find_asf(folder / "02.amc"), folder / "02.asf");
}

TEST(FindAsf, TakesTheOnlyOne) {
  const TemporaryFolder folder;
  folder.write("skeleton.asf", "");
  EXPECT_EQ(find_asf(folder / "walk.amc"), folder / "skeleton.asf");
}

TEST(FindAsf, SaysWhatItLookedFor) {
  const TemporaryFolder folder;
  const auto error = [&] { return testing::error_of([&] { find_asf(folder / "02_01.amc"); }); };
  EXPECT_EQ(error(), "0: : there is no .asf in " + folder.path().string() +
                         "; looked for 02_01.asf, 02.asf; put the .asf of its actor into the same "
                         "folder");
  folder.write("01.asf", "");
  folder.write("03.asf", "");
  EXPECT_EQ(error(), "0: : none of the 2 .asf in " + folder.path().string() +
                         " matches its name; looked for 02_01.asf, 02.asf; put the .asf of its "
                         "actor into the same folder");
}

}  // namespace
}  // namespace sparse_mocap
