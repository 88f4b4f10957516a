// SPDX-License-Identifier: GPL-3.0-or-later
//
// Databases of recorded motion, as databases.py builds them, in the folder that the environment
// variable SPARSE_MOCAP_BENCH_DATABASES names; and performances that none of them holds.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/readings/reading.hpp"
#include "sparse_mocap/retrieval/knn_index.hpp"

namespace sparse_mocap::testing {

// Names of those that are there, the smallest first: 30k 100k 300k 680k 5m. None without the
// folder.
std::vector<std::string> recorded_sizes();
std::filesystem::path recorded_path(const std::string& size);
// The one that was asked for last stays open.
std::shared_ptr<const MotionDatabase> recorded_database(const std::string& size);

// All performances one after another, as four sensors at wrists and ankles would read them.
std::vector<Reading> recorded_performances();

// What is searched, and some of what is asked for.
struct SearchedRows {
  retrieval::FeatureRows rows;
  retrieval::FeatureRows queries;
};
// 12 dimensions: readings, as the paper's method searches them; 24: smoothed readings and their
// change, as the project's own does; 48: those and readings of earlier times.
SearchedRows searched_rows(const std::string& size, int dimensions, int query_each = 7);

}  // namespace sparse_mocap::testing
