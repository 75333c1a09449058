// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep/record_gaps.hpp"

#include "sim/config/message_text.hpp"

namespace bridges {

void RecordGaps::add(const std::string& client, const std::string& channel, const char* why) {
  if (gaps_.size() >= max_noted && !gaps_.contains({client, channel})) return;
  Gap& gap = gaps_[{client, channel}];
  ++gap.messages;
  gap.why = why;
}

std::vector<std::string> RecordGaps::phrases() const {
  std::vector<std::string> phrases;
  for (const auto& [place, gap] : gaps_) {
    const auto& [client, channel] = place;
    const std::string of = " of client '" + sim::printable(sim::shortened(client)) + "'";
    phrases.push_back((channel.empty() ? "messages" + of + " on channels that nothing reads"
                                       : std::to_string(gap.messages) + (gap.messages == 1 ? " message" : " messages") +
                                             of + " on '" + sim::printable(sim::shortened(channel)) + "'") +
                      " (" + gap.why + ")");
  }
  return phrases;
}

}  // namespace bridges
