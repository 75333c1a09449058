// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace bridges {

/// What clients published and the record lacks.
class RecordGaps {
 public:
  /// Limit of the clients and channels; further ones are not kept.
  static constexpr std::size_t max_noted = 1000;

  /// Notes a message; `why` is a literal.  An empty channel: all that nothing reads.
  void add(const std::string& client, const std::string& channel, const char* why);
  /// Returns one phrase for each client and channel, such as `50 messages of client 'pilot' on 'sim.note' (channels of
  /// the simulator)`.
  std::vector<std::string> phrases() const;

 private:
  struct Gap {
    std::int64_t messages = 0;
    const char* why = "";
  };
  std::map<std::pair<std::string, std::string>, Gap> gaps_;  // by client and channel
};

}  // namespace bridges
