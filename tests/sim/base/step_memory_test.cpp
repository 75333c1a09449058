// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/step_memory.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace {

// As operator new promises; 24 bytes are not multiple of it.
TEST(StepMemory, EveryPieceIsAlignedForAnyObject) {
  for (const std::size_t bytes : {std::size_t{1}, std::size_t{8}, std::size_t{24}, std::size_t{40}, std::size_t{200}}) {
    std::vector<void*> pieces;
    for (int i = 0; i < 100; ++i) pieces.push_back(sim::allocate_for_steps(bytes));
    for (void* piece : pieces) {
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(piece) % alignof(std::max_align_t), 0u) << "of " << bytes << " bytes";
      sim::free_for_steps(piece, bytes);
    }
  }
}

}  // namespace
