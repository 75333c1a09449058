// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/memory.hpp"

namespace autonomy {

void Memory::keep(std::int64_t utime) {
  if (keep_us_ <= 0) return;
  copies_.push_back({utime, copy_()});
  // Keep the copy that is valid at the oldest time.
  while (copies_.size() > 1 && (copies_[1].utime <= utime - keep_us_ || copies_.size() > max_copies))
    copies_.pop_front();
}

bool Memory::rewind(std::int64_t utime) {
  if (copies_.empty() || copies_.front().utime >= utime) return false;
  while (copies_.back().utime >= utime) copies_.pop_back();
  restore_saved_(copies_.back().state.get());
  return true;
}

}  // namespace autonomy
