// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/nearest_name.hpp"

#include <gtest/gtest.h>

#include <array>

namespace sparse_mocap {
namespace {

constexpr std::array<std::string_view, 4> kNames{"file", "actor", "class", "license"};

TEST(NearestName, IsTheOneWithTheFewestLettersToChange) {
  EXPECT_EQ(nearest_name("licence", kNames), "license");  // one changed
  EXPECT_EQ(nearest_name("clas", kNames), "class");       // one to add
  EXPECT_EQ(nearest_name("filee", kNames), "file");       // one to drop
  EXPECT_EQ(nearest_name("actor", kNames), "actor");
  EXPECT_EQ(nearest_name("", kNames), "file");  // the shortest
}

TEST(NearestName, IsTheFirstOfEquals) {
  constexpr std::array<std::string_view, 2> names{"ab", "ac"};
  EXPECT_EQ(nearest_name("a", names), "ab");
}

TEST(NearestName, OfNoNamesIsEmpty) { EXPECT_EQ(nearest_name("a", {}), ""); }

}  // namespace
}  // namespace sparse_mocap
