// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <linux/filter.h>

#include <string>
#include <vector>

namespace bridges {

/// A socket filter (classic BPF, for a UDP socket) that lets pass what a receiver of these channels may want: their
/// messages, fragments that do not name their channel, and what is too short to judge.  It looks at the first 16 bytes
/// of a channel by a hash, so a few others also pass; it never drops a message of these channels.  Empty when there are
/// too many channels for one program.
std::vector<sock_filter> channel_filter(const std::vector<std::string>& channels);

}  // namespace bridges
