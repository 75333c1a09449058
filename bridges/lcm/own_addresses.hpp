// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

namespace bridges {

/// The IPv4 addresses of this machine.
class OwnAddresses {
 public:
  OwnAddresses();

  /// Whether `address` (host byte order) is one of this machine's; all of 127.0.0.0/8 are.  For an unknown one the
  /// list is read again, at most once a second, as interfaces change.
  bool contain(std::uint32_t address);

 private:
  void read();

  std::vector<std::uint32_t> addresses_;
  std::chrono::steady_clock::time_point read_at_;
};

}  // namespace bridges
