// SPDX-License-Identifier: GPL-3.0-or-later
//
// Prints, for each of a few threads, whether what it kept was whole when it was destroyed.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

namespace {

constexpr std::uint64_t kWhole = 0x1234567890abcdef;

// Memory that was given back is given out again, and gets other contents.
void use_free_memory() {
  for (std::size_t i = 0; i < 4000; ++i) {
    const std::size_t size = 16 + i % 200;
    if (void* const memory = std::malloc(size)) std::memset(memory, 0xff, size);
  }
}

struct Kept {
  volatile std::uint64_t contents = kWhole;
  ~Kept() {
    use_free_memory();
    std::puts(contents == kWhole ? "whole" : "gone");
  }
};

void keep() {
  static thread_local Kept kept;
  kept.contents = kWhole;
}

}  // namespace

int main() {
  for (int i = 0; i < 4; ++i) std::thread(keep).join();
}
