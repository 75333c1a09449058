// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/estimates/log_paths.hpp"

#include <algorithm>

#include "bridges/log/event_log.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_info_t.hpp"

namespace viewer {

namespace {

/// Bound of the memory for all paths.
constexpr std::size_t max_all_points = 10'000'000;

}  // namespace

LogPaths::LogPaths(const std::string& log, double until_s) {
  bridges::EventLogReader file(log);
  bridges::LogEventView event;
  std::optional<std::int64_t> epoch_us;
  std::size_t points = 0;
  while (points < max_all_points && file.next(event)) {
    try {
      if (!epoch_us && event.channel == "sim.info")
        epoch_us = shoal::decode<shoal::sim_info_t>(event.payload, shoal::Finite::any).epoch_utime;
      if (!epoch_us || event.channel.starts_with("sim.")) continue;
      auto path = read_path(event.payload);
      if (!path) continue;
      const double time_s = (static_cast<double>(path->utime) - static_cast<double>(*epoch_us)) * 1e-6;
      if (time_s > until_s) continue;
      std::vector<Dated>& all = by_channel_[std::string(event.channel)];
      while (!all.empty() && all.back().time_s > time_s) all.pop_back();  // the run was rewound
      if (!all.empty() && all.back().path.leads_along(*path)) continue;
      points += path->points.size() + 1;
      all.push_back({time_s, std::move(*path)});
    } catch (const shoal::MessageError&) {
      // Damage, which the replay reports.
    }
  }
}

std::vector<std::pair<std::string, const VehiclePath*>> LogPaths::at(double time_s) const {
  std::vector<std::pair<std::string, const VehiclePath*>> paths;
  for (const auto& [channel, all] : by_channel_) {
    const auto after = std::upper_bound(all.begin(), all.end(), time_s,
                                        [](double at_s, const Dated& each) { return at_s < each.time_s; });
    if (after != all.begin()) paths.emplace_back(channel, &std::prev(after)->path);
  }
  return paths;
}

}  // namespace viewer
