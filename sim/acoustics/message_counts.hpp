// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "sim/acoustics/propagation/signal.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// Numbers of messages sent since the start, by the group and address to which they were sent.  A transducer subtracts
/// from them what came into its range: the rest was lost beyond it, without a flight for each such pair.
class MessageCounts {
 public:
  void count(const Audience& to) { ++sent_[to.group][to.address]; }
  /// Number of messages to this address or to its whole group.
  std::int64_t sent_to(const Audience& receiver) const {
    const auto group = sent_.find(receiver.group);
    if (group == sent_.end()) return 0;
    const auto to = [&](const std::string& address) {
      const auto count = group->second.find(address);
      return count == group->second.end() ? 0 : count->second;
    };
    return to("") + (receiver.address.empty() ? 0 : to(receiver.address));
  }
  /// Discards the count of an address that no transducer has any more, which bounds the memory.  Those of groups stay.
  void discard(const Audience& address) {
    const auto group = sent_.find(address.group);
    if (group != sent_.end() && !address.address.empty()) group->second.erase(address.address);
  }
  void visit_state(StateArchive& archive) { archive(sent_); }

 private:
  std::map<std::string, std::map<std::string, std::int64_t>> sent_;
};

}  // namespace sim
