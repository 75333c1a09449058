// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace bridges {

/// Error of an option of the web server, of its port, or of a message of a client.
class WebError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace bridges
