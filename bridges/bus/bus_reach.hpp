// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace bridges {

/// Whether messages on this bus come from, or go to, other machines: multicast with a ttl above 0, and tcpq, whose
/// server may be reached from anywhere.  In doubt true.  `resolved_url`: of resolve_lcm_url().  A program that carries
/// messages from one bus to another is not seen.
bool leaves_machine(const std::string& resolved_url);

}  // namespace bridges
