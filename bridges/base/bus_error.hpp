// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace bridges {

/// A bus or a log that cannot be used; the text says why and what to do.
class BusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace bridges
