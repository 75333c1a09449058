#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace bridges {

/// Lets one thread sleep until a message comes on any of the buses that share this.
class Arrivals {
 public:
  /// From the receiving threads.
  void arrived() {
    count_.fetch_add(1);
    if (waiters_.load() == 0) return;
    { const std::lock_guard lock(mutex_); }  // the waiter is asleep, or will see the new count
    condition_.notify_all();
  }

  /// Sleeps until a message arrived after the last call returned; at once if one did already.  False on time-out.
  bool wait(std::chrono::milliseconds timeout) {
    waiters_.fetch_add(1);
    std::unique_lock lock(mutex_);
    const bool came = condition_.wait_for(lock, timeout, [&] { return count_.load() != seen_; });
    waiters_.fetch_sub(1);
    seen_ = count_.load();
    return came;
  }

 private:
  std::atomic<std::uint64_t> count_ = 0;
  std::uint64_t seen_ = 0;
  std::atomic<int> waiters_ = 0;
  std::mutex mutex_;
  std::condition_variable condition_;
};

}  // namespace bridges
