// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/database/container.hpp"
#include "sparse_mocap/database/database_content.hpp"

namespace sparse_mocap {

// What a database file of format version 1 holds: floats throughout, in arrays of all sites, and
// the clip of each row. Its further content views the file. Throws FormatError.
DatabaseContent content_of_version_1(const Container& container);

}  // namespace sparse_mocap
