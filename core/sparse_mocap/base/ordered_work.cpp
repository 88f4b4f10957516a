// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/ordered_work.hpp"

#include <algorithm>
#include <utility>

namespace sparse_mocap {

int num_threads_or_all(int wanted) {
  if (wanted > 0) return wanted;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

OrderedWork::OrderedWork(std::size_t count, int num_threads, Work work)
    : work_(std::move(work)), is_done_(count, false), errors_(count) {
  const auto wanted = static_cast<std::size_t>(num_threads_or_all(num_threads));
  for (std::size_t n = std::min(wanted, count); n > 0; --n)
    threads_.emplace_back([this](const std::stop_token& stop) { run(stop); });
}

OrderedWork::~OrderedWork() {
  for (auto& thread : threads_) thread.request_stop();
}

void OrderedWork::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const std::size_t i = next_++;
    if (i >= errors_.size()) return;
    try {
      work_(i, stop);
    } catch (...) {
      errors_[i] = std::current_exception();
    }
    const std::scoped_lock lock(mutex_);
    is_done_[i] = true;
    finished_.notify_all();
  }
}

bool OrderedWork::wait_for(std::size_t i, std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  if (!finished_.wait_for(lock, patience, [&] { return is_done_[i]; })) return false;
  if (errors_[i]) std::rethrow_exception(errors_[i]);
  return true;
}

void in_pieces(std::size_t count, std::size_t piece, int num_threads,
               const std::function<void(std::size_t)>& work) {
  constexpr std::chrono::milliseconds kPatience{200};
  const std::size_t num_pieces = (count + piece - 1) / piece;
  if (num_pieces <= 1 || num_threads_or_all(num_threads) == 1) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  OrderedWork pieces(num_pieces, num_threads, [&](std::size_t p, const std::stop_token&) {
    for (std::size_t i = p * piece; i < std::min(count, (p + 1) * piece); ++i) work(i);
  });
  for (std::size_t p = 0; p < num_pieces; ++p)
    while (!pieces.wait_for(p, kPatience)) {
    }
}

}  // namespace sparse_mocap
