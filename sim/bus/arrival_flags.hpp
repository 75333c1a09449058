// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

namespace sim {

/// Flags of devices, such as those whose mailboxes may have messages: one per device, contiguous in memory.
class ArrivalFlags {
 public:
  /// Returns the flag of a device by its number; it exists as long as any owner holds it.
  std::shared_ptr<std::atomic<bool>> of(int device) {
    const auto number = static_cast<std::size_t>(device);
    while (blocks_.size() <= number / flags_per_block) blocks_.push_back(std::make_shared<Block>());
    const std::shared_ptr<Block>& block = blocks_[number / flags_per_block];
    return {block, &(*block)[number % flags_per_block]};
  }

 private:
  static constexpr std::size_t flags_per_block = 4096;
  using Block = std::array<std::atomic<bool>, flags_per_block>;
  std::vector<std::shared_ptr<Block>> blocks_;
};

}  // namespace sim
