// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/log/mcap_conversion.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>

#include "bridges/log/event_log.hpp"
#include "bridges/mcap/mcap_record.hpp"

namespace bridges {

McapConverted convert_to_mcap(const McapConversion& conversion, const shoal::MessageTypes& types) {
  EventLogReader log(conversion.log);
  mcap::McapRecord out(create_record_file(conversion.out, conversion.existing), types);
  const auto require = [&](bool written) {
    if (!written) throw BusError(conversion.out + ": " + std::strerror(errno != 0 ? errno : EIO));
  };
  // Convert the events.
  McapConverted converted;
  std::map<std::string, bool, std::less<>> converts;
  TimeOrder order;
  LogEventView event;
  while (log.next(event)) {
    if (conversion.progress) conversion.progress(event.offset, log.file_bytes());
    if (conversion.wants) {
      auto known = converts.find(event.channel);
      if (known == converts.end()) known = converts.emplace(event.channel, conversion.wants(event.channel)).first;
      if (!known->second) {
        out.learn(event.channel, event.payload);
        continue;
      }
    }
    if (const std::string why = mcap::time_error(event.utime); !why.empty()) {
      std::remove(conversion.out.c_str());
      throw BusError(fmt::format("{}: byte {}: {}", conversion.log, event.offset, why));
    }
    order.add(event.utime, event.channel);
    require(out.write(event.utime, event.channel, event.payload));
    ++converted.events;
  }
  require(out.finish());
  // Collect the figures.
  const std::vector<std::uint64_t>& counts = out.file().counts();
  converted.not_decoded = out.not_decoded();
  converted.messages = out.file().messages();
  converted.channels = counts.size();
  converted.bytes = out.file().bytes();
  converted.log_problems = log.problems();
  converted.time_problem = order.problem();
  converted.problems = out.problems();
  return converted;
}

}  // namespace bridges
