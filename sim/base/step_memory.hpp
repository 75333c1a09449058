// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <new>

namespace sim {

/// Memory of what every step visits.  Objects of one size lie side by side, in large pages where the system has them:
/// a step that walks through thousands of vehicles misses the caches seldom.  From any thread.
void* allocate_for_steps(std::size_t bytes);
void free_for_steps(void* memory, std::size_t bytes) noexcept;

/// Base of classes whose objects every step visits.
struct VisitedInSteps {
  static void* operator new(std::size_t bytes) { return allocate_for_steps(bytes); }
  static void operator delete(void* memory, std::size_t bytes) noexcept { free_for_steps(memory, bytes); }
  static void* operator new(std::size_t bytes, std::align_val_t alignment) { return ::operator new(bytes, alignment); }
  static void operator delete(void* memory, std::size_t bytes, std::align_val_t alignment) noexcept {
    ::operator delete(memory, bytes, alignment);
  }
};

}  // namespace sim
