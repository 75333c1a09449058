// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/step_memory.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <mutex>
#include <new>
#include <span>
#include <utility>

namespace sim {

// The address sanitizer needs separate allocations.  g++ and clang indicate it in different ways.
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SHOAL_ADDRESS_SANITIZER
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define SHOAL_ADDRESS_SANITIZER
#endif

#if defined(SHOAL_ADDRESS_SANITIZER)

void* allocate_for_steps(std::size_t bytes) {
  return ::operator new(bytes);
}
void free_for_steps(void* memory, std::size_t) noexcept {
  ::operator delete(memory);
}

#else

namespace {

constexpr std::size_t large_page_bytes = std::size_t{1} << 21;
constexpr std::size_t max_bytes = 4096;  ///< larger objects are allocated separately

constexpr std::size_t up_to_multiple(std::size_t bytes, std::size_t of) {
  return (bytes + of - 1) / of * of;
}

/// Memory of huge pages, which are never released.
class LargePages {
 public:
  /// Returns memory for objects of one size: for as many as asked for, or for fewer at the end of the pages.
  std::span<std::byte> take(std::size_t bytes_each, std::size_t count) {
    if (left_.size() < bytes_each) add(bytes_each);
    const std::span<std::byte> taken = left_.first(std::min(count, left_.size() / bytes_each) * bytes_each);
    left_ = left_.subspan(taken.size());
    return taken;
  }

 private:
  void add(std::size_t min_bytes) {
    const std::size_t bytes = up_to_multiple(std::max(min_bytes, total_bytes_ / 4), large_page_bytes);
    void* pages = std::aligned_alloc(large_page_bytes, bytes);
    if (pages == nullptr) throw std::bad_alloc();
    madvise(pages, bytes, MADV_HUGEPAGE);  // without huge pages it is ordinary memory
    left_ = {static_cast<std::byte*>(pages), bytes};
    total_bytes_ += bytes;
  }

  std::span<std::byte> left_;
  std::size_t total_bytes_ = 0;
};

/// Objects of one size.
class Pool {
 public:
  void* allocate(LargePages& pages, std::size_t bytes) {
    if (released_ != nullptr) return std::exchange(released_, released_->next);
    if (fresh_.empty()) {
      constexpr std::size_t max_together = 512;
      fresh_ = pages.take(bytes, together_);
      together_ = std::min(2 * together_, max_together);
    }
    void* const memory = fresh_.data();
    fresh_ = fresh_.subspan(bytes);
    return memory;
  }
  void release(void* memory) { released_ = new (memory) Released{released_}; }

 private:
  struct Released {
    Released* next;
  };
  Released* released_ = nullptr;  // the last one first
  std::span<std::byte> fresh_;    // not yet used
  std::size_t together_ = 8;      // objects in the next piece
};

/// Sizes are rounded up to this, the largest alignment.
constexpr std::size_t grain = alignof(std::max_align_t);

struct Pools {
  Pool& of(std::size_t bytes) { return by_size[bytes / grain]; }

  std::mutex mutex;
  LargePages pages;
  std::array<Pool, max_bytes / grain + 1> by_size;
};

/// Exists until the end of the process: objects with static storage may be destroyed later than anything here.
Pools& pools() {
  static Pools* const all = new Pools;
  return *all;
}

}  // namespace

void* allocate_for_steps(std::size_t bytes) {
  if (bytes > max_bytes) return ::operator new(bytes);
  bytes = up_to_multiple(std::max(bytes, std::size_t{1}), grain);
  const std::lock_guard lock(pools().mutex);
  return pools().of(bytes).allocate(pools().pages, bytes);
}

void free_for_steps(void* memory, std::size_t bytes) noexcept {
  if (memory == nullptr) return;
  if (bytes > max_bytes) return ::operator delete(memory);
  const std::lock_guard lock(pools().mutex);
  pools().of(up_to_multiple(std::max(bytes, std::size_t{1}), grain)).release(memory);
}

#endif

}  // namespace sim
