// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <utility>

#include "sparse_mocap/formats/motion_file.hpp"
#include "support/invariants.hpp"
#include "support/real_data.hpp"

namespace sparse_mocap::testing {

// A folder that goes away with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            ("sparse_mocap_" + std::string(test->test_suite_name()) + "_" + test->name() + "_" +
             std::to_string(std::random_device{}()));
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::filesystem::path path() const { return path_; }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

// What the call complains about: "line: message", the message without the path; "" if it does not.
// A message is one line; one that names a line of a file also says, after a semicolon, what to do.
template <typename Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const FormatError& error) {
    const std::string what = error.what();
    const auto path = error.location().path.string();
    EXPECT_TRUE(what.starts_with(path)) << what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    if (error.location().line > 0) {
      EXPECT_NE(what.find("; "), std::string::npos) << what << " has no remedy";
    }
    return std::to_string(error.location().line) + ": " + what.substr(path.size());
  }
  return "";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

inline bool has_warning(const MotionFile& file, const std::string& part) {
  for (const auto& warning : file.warnings)
    if (contains(warning.text, part)) return true;
  return false;
}

// The file itself, after a check of what must hold of every motion that is read.
inline MotionFile sound(MotionFile file) {
  EXPECT_EQ(joined(check_motion(file.motion)), "");
  for (const auto& warning : file.warnings) EXPECT_GE(warning.count, 1) << warning.message();
  return file;
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace sparse_mocap::testing
