// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/step_memory.hpp"

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <memory_resource>
#include <mutex>

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

/// Allocator of whole huge pages, which are never released.
class LargePages final : public std::pmr::memory_resource {
  void* do_allocate(std::size_t bytes, std::size_t) override {
    bytes = (bytes + large_page_bytes - 1) / large_page_bytes * large_page_bytes;
    void* pages = std::aligned_alloc(large_page_bytes, bytes);
    if (pages == nullptr) throw std::bad_alloc();
    madvise(pages, bytes, MADV_HUGEPAGE);  // without huge pages it is ordinary memory
    return pages;
  }
  void do_deallocate(void* pages, std::size_t, std::size_t) override { std::free(pages); }
  bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }
};

struct Pools {
  std::mutex mutex;
  LargePages pages;
  std::pmr::monotonic_buffer_resource carved{large_page_bytes, &pages};
  std::pmr::unsynchronized_pool_resource pools{{.max_blocks_per_chunk = 512, .largest_required_pool_block = 4096},
                                               &carved};
};

/// Rounds a size up to a multiple of the largest alignment, because the libstdc++ pools store blocks of sizes such as
/// 24 bytes contiguously, whatever the requested alignment.
constexpr std::size_t rounded(std::size_t bytes) {
  constexpr std::size_t alignment = alignof(std::max_align_t);
  return (bytes + alignment - 1) / alignment * alignment;
}

/// Exists until the end of the process: objects with static storage may be destroyed later than anything here.
Pools& pools() {
  static Pools* const all = new Pools;
  return *all;
}

}  // namespace

void* allocate_for_steps(std::size_t bytes) {
  const std::lock_guard lock(pools().mutex);
  return pools().pools.allocate(rounded(bytes));
}

void free_for_steps(void* memory, std::size_t bytes) noexcept {
  if (memory == nullptr) return;
  const std::lock_guard lock(pools().mutex);
  pools().pools.deallocate(memory, rounded(bytes));
}

#endif

}  // namespace sim
