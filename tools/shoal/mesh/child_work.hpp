// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>

namespace tools {

/// Error of the child process; what() is `failed on this file` or `took longer than 60 s`.
class ChildError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ChildLimits {
  double time_s = 60;
  std::size_t memory_bytes = std::size_t{4} << 30;  ///< of address space; not with AddressSanitizer, which needs more
};

/// Executes `work` in a child process, where crashes, endless loops and excessive memory are contained, and returns its
/// bytes.  Its output is discarded.  Throws ChildError.
std::string do_in_child(const std::function<std::string()>& work, const ChildLimits& limits);

}  // namespace tools
