// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace bridges {

/// Returns whether messages on this bus may come from or go to other machines: for multicast with a ttl above 0, and
/// for tcpq, whose server may be reachable from anywhere.  Returns true when in doubt.  `resolved_url`: result of
/// resolve_lcm_url().  Programs that forward messages from one bus to another are not detected.
bool leaves_machine(const std::string& resolved_url);

}  // namespace bridges
