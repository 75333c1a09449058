// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace bridges {

/// Addresses at which a server listens.
struct ListenAddresses {
  std::vector<std::string> numeric;  ///< the first one must work, the others may be missing
  bool only_this_machine = false;    ///< all are loopback addresses
};

/// Finds the addresses of a host.  `localhost` and `127.0.0.1` give both loopback addresses.  Throws WebError if the
/// host is unknown.
ListenAddresses find_listen_addresses(const std::string& host);

}  // namespace bridges
