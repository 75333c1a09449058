// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <linux/filter.h>

#include <string>
#include <vector>

namespace bridges {

/// Returns a socket filter (classic BPF, for a UDP socket) that passes the datagrams a receiver of these channels may
/// need: messages on them, fragments that do not name their channel, and datagrams that are too short to classify.  It
/// compares a hash of the first 16 bytes of the channel, so that a few other messages also pass; it never drops a
/// message on these channels.  Empty when there are too many channels for one program.
std::vector<sock_filter> channel_filter(const std::vector<std::string>& channels);

}  // namespace bridges
