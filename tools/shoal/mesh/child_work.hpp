// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>

namespace tools {

/// The child did not end well; what() says how: `failed on this file` or `took longer than 60 s`.
class ChildError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ChildLimits {
  double time_s = 60;
  std::size_t memory_bytes = std::size_t{4} << 30;  ///< of addresses; not with AddressSanitizer, which needs more
};

/// Does `work` in a child process, where it may crash, hang or eat memory, and returns the bytes that it returned. What
/// it prints is dropped.  Throws ChildError.
std::string do_in_child(const std::function<std::string()>& work, const ChildLimits& limits);

}  // namespace tools
