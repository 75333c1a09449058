// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/bus/bus_reach.hpp"

#include "bridges/lcm/lcm_url.hpp"

namespace bridges {

bool leaves_machine(const std::string& resolved_url) {
  const LcmEndpoint endpoint = lcm_endpoint(resolved_url);
  return endpoint.kind != "memq" && (endpoint.kind != "udpm" || endpoint.ttl > 0);
}

}  // namespace bridges
