// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace sparse_mocap::fuzz {

// What fuzzers run on an input, and tests on every file of the corpus: the input must be refused
// by a FormatError of one line that says where, or be read as something that passes the checks of
// support/invariants.hpp; with other line ends the outcome must be the same. Each returns what is
// wrong, "" if nothing is.

std::string try_bvh(std::string_view input);

// An .asf and an .amc with the line "#AMC" between them.
std::string try_acclaim(std::string_view input);

// An .smdb, as it is, and with its checksums put right, so that what they guard is reached.
std::string try_database(std::string_view input);

// An .smmodel, likewise.
std::string try_model(std::string_view input);

// [which parser][how the bytes are cut][bytes of a device], see streams.hpp: samples must be
// plausible, and the same however the bytes are cut.
std::string try_streams(std::string_view input);

}  // namespace sparse_mocap::fuzz
