// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <utility>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap {

// How far a long operation is.
struct ProgressReport {
  std::size_t done = 0;  // steps, of total
  std::size_t total = 0;
  std::string_view what;  // is being worked on
  // Of operations that read many files: how many of them are through in this pass, the frames that
  // those hold, and the bytes read of those to be read in all passes.
  std::size_t files = 0;
  std::size_t num_files = 0;
  std::uint64_t frames = 0;
  std::uint64_t bytes = 0;
  std::uint64_t num_bytes = 0;
};

// Reports how far a long operation is and asks whether to go on.
//
// The callback returns false to cancel. It is called from the thread that called the operation
// only.
class Progress {
 public:
  using Callback = std::function<bool(std::size_t done, std::size_t total, std::string_view what)>;
  using ReportCallback = std::function<bool(const ProgressReport&)>;

  Progress() = default;
  explicit Progress(ReportCallback callback) : callback_(std::move(callback)) {}
  explicit Progress(Callback callback)
      : callback_([simple = std::move(callback)](const ProgressReport& report) {
          return simple(report.done, report.total, report.what);
        }) {}

  // Throws Cancelled when the callback asks to stop.
  void report(const ProgressReport& report) const {
    if (callback_ && !callback_(report)) throw Cancelled();
  }
  void report(std::size_t done, std::size_t total, std::string_view what) const {
    report(ProgressReport{done, total, what});
  }

 private:
  ReportCallback callback_;
};

}  // namespace sparse_mocap
