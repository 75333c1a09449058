// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace bridges {

/// Request of a page, such as `control` or `seek`.  The request `left`, without text, tells that a page is gone.
struct ViewRequest {
  int client = 0;            ///< number of the connection, for the reply
  bool may_control = false;  ///< the page has shown the token
  std::string op;            ///< kind of request
  std::string text;          ///< the whole message: a JSON object, at most 64 KiB, nested at most 16 deep
};

}  // namespace bridges
