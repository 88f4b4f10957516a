// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>
#include <utility>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap {

// Reports how far a long operation is and asks whether to go on.
//
// The callback receives (done, total, what is being worked on) and returns false to cancel. It may
// be called from the thread that runs the operation only.
class Progress {
 public:
  using Callback = std::function<bool(std::size_t done, std::size_t total, std::string_view what)>;

  Progress() = default;
  explicit Progress(Callback callback) : callback_(std::move(callback)) {}

  // Throws Cancelled when the callback asks to stop.
  void report(std::size_t done, std::size_t total, std::string_view what) const {
    if (callback_ && !callback_(done, total, what)) throw Cancelled();
  }

 private:
  Callback callback_;
};

}  // namespace sparse_mocap
