// SPDX-License-Identifier: GPL-3.0-or-later
//
// Real motions, where they are; see support/real_data.hpp.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/database/builder.hpp"
#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/database/source_files.hpp"

namespace sparse_mocap::testing {

// A database of every step-th clip of HDM05, in memory.
inline std::shared_ptr<const MotionDatabase> hdm05_database(std::size_t step) {
  const TemporaryFolder folder;
  const auto files = find_source_files({real_data("hdm05")}, {});
  std::vector<std::filesystem::path> chosen;
  for (std::size_t i = 0; i < files.size(); i += step) chosen.push_back(files[i].path);
  build_database(chosen, folder / "hdm05.smdb", {});
  return MotionDatabase::open(folder / "hdm05.smdb");  // stays mapped when the folder goes
}

}  // namespace sparse_mocap::testing
