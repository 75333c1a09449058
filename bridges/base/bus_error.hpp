// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace bridges {

/// Error of a bus or a log that cannot be used; the text has the reason and the remedy.
class BusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace bridges
