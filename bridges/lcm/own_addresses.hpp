// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

namespace bridges {

/// IPv4 addresses of this machine.
class OwnAddresses {
 public:
  OwnAddresses();

  /// Returns whether `address` (host byte order) belongs to this machine, as all of 127.0.0.0/8 do.  For an unknown
  /// address the list is read again, at most once a second, because interfaces can change.
  bool contain(std::uint32_t address);

 private:
  void read();

  std::vector<std::uint32_t> addresses_;
  std::chrono::steady_clock::time_point read_at_;
};

}  // namespace bridges
