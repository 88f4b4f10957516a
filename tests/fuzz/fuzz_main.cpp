// SPDX-License-Identifier: GPL-3.0-or-later
//
// The entry of one fuzzer; SPARSE_MOCAP_FUZZ_TARGET is a function of targets.hpp.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "fuzz/targets.hpp"

extern "C" __attribute__((visibility("default"))) int LLVMFuzzerTestOneInput(
    const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const auto problem = sparse_mocap::fuzz::SPARSE_MOCAP_FUZZ_TARGET(input);
  if (problem.empty()) return 0;
  std::fprintf(stderr, "%s\n", problem.c_str());
  std::abort();
}
