// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

namespace sparse_mocap {

// As many threads as there are processors when wanted is 0.
int num_threads_or_all(int wanted);

// Calls work(0), work(1), ... work(count - 1) on several threads, started in ascending order.
// The destructor asks work to stop (by the token) and waits for it.
class OrderedWork {
 public:
  using Work = std::function<void(std::size_t, const std::stop_token&)>;

  OrderedWork(std::size_t count, int num_threads, Work work);
  OrderedWork(const OrderedWork&) = delete;
  OrderedWork& operator=(const OrderedWork&) = delete;
  ~OrderedWork();

  // Waits at most that long for piece i; returns whether it is done. Throws what the piece threw.
  bool wait_for(std::size_t i, std::chrono::milliseconds patience);

 private:
  void run(const std::stop_token& stop);

  Work work_;
  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;
  std::condition_variable finished_;
  std::vector<bool> is_done_;
  std::vector<std::exception_ptr> errors_;
  std::vector<std::jthread> threads_;  // last member: destroyed before what the threads use
};

// Runs work(i, stop) for i in [0, count) on several threads and passes the results to
// consume(i, result) on the calling thread in ascending order, so that the outcome does not depend
// on the number of threads. waiting(i) is called on the calling thread before each consume, and
// repeatedly while the i-th result is not ready. An exception of work is thrown when its turn
// comes; any exception stops the threads.
template <typename Work, typename Consume, typename Waiting>
void work_in_order(std::size_t count, int num_threads, const Work& work, const Consume& consume,
                   const Waiting& waiting) {
  using Result = std::invoke_result_t<Work, std::size_t, const std::stop_token&>;
  constexpr std::chrono::milliseconds kPatience{200};
  std::vector<std::optional<Result>> results(count);
  OrderedWork pieces(count, num_threads, [&](std::size_t i, const std::stop_token& stop) {
    results[i].emplace(work(i, stop));
  });
  for (std::size_t i = 0; i < count; ++i) {
    waiting(i);
    while (!pieces.wait_for(i, kPatience)) waiting(i);
    consume(i, std::move(*results[i]));
    results[i].reset();
  }
}

// Calls work(i) for each i in [0, count), so many at a time as a piece of a thread's work, and
// returns when all are done. An exception of work stops the threads and is thrown.
void in_pieces(std::size_t count, std::size_t piece, int num_threads,
               const std::function<void(std::size_t)>& work);

}  // namespace sparse_mocap
