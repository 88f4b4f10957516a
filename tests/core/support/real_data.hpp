// SPDX-License-Identifier: GPL-3.0-or-later
//
// Recorded motions and sensors, which are no part of the repository: they lie in the folder that
// the environment variable SPARSE_MOCAP_DATA names.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace sparse_mocap::testing {

// The file or folder of that name; empty when it is not at hand. Throws std::runtime_error if the
// variable names no folder.
inline std::filesystem::path real_data(const std::string& name) {
  const char* variable = std::getenv("SPARSE_MOCAP_DATA");
  if (variable == nullptr || *variable == '\0') return {};
  const std::filesystem::path folder(variable);
  if (!std::filesystem::is_directory(folder))
    throw std::runtime_error("SPARSE_MOCAP_DATA names " + folder.string() + ", which is no folder");
  return std::filesystem::exists(folder / name) ? folder / name : std::filesystem::path();
}

// Why a test is skipped. It begins with the variable's name, by which `./dev test` counts.
inline std::string missing_data(const std::string& name) {
  const char* variable = std::getenv("SPARSE_MOCAP_DATA");
  return variable == nullptr || *variable == '\0' ? "SPARSE_MOCAP_DATA is not set"
                                                  : "SPARSE_MOCAP_DATA has no " + name;
}

}  // namespace sparse_mocap::testing

#define SKIP_WITHOUT_REAL_DATA(name)                    \
  if (::sparse_mocap::testing::real_data(name).empty()) \
  GTEST_SKIP() << ::sparse_mocap::testing::missing_data(name)
