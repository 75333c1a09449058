// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/estimates/log_estimates.hpp"

#include <algorithm>

#include "bridges/log/event_log.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_info_t.hpp"

namespace viewer {

namespace {

constexpr std::string_view ending = ".estimate";
/// Bound of the memory for all estimates.
constexpr std::size_t max_estimates = 1'000'000;

}  // namespace

LogEstimates::LogEstimates(const std::string& log, double from_s, double until_s, double interval_s) {
  bridges::EventLogReader file(log);
  bridges::LogEventView event;
  std::optional<std::int64_t> epoch_us;
  std::size_t count = 0;
  while (count < max_estimates && file.next(event)) {
    try {
      if (!epoch_us && event.channel == "sim.info")
        epoch_us = shoal::decode<shoal::sim_info_t>(event.payload, shoal::Finite::any).epoch_utime;
      if (!epoch_us || !event.channel.ends_with(ending)) continue;
      const auto message = read_estimate(event.channel, event.payload);
      if (!message) continue;
      const double time_s = (static_cast<double>(message->utime) - static_cast<double>(*epoch_us)) * 1e-6;
      if (time_s < from_s || time_s > until_s) continue;
      const LogEstimate estimate{*message, time_s};
      add(event.channel.substr(0, event.channel.size() - ending.size()), estimate, interval_s);
      ++count;
    } catch (const shoal::MessageError&) {
      // Damage, which the replay reports.
    }
  }
}

void LogEstimates::add(std::string_view channel, const LogEstimate& estimate, double interval_s) {
  auto known = by_vehicle_.find(channel);
  if (known == by_vehicle_.end()) known = by_vehicle_.emplace(std::string(channel), std::vector<LogEstimate>()).first;
  std::vector<LogEstimate>& all = known->second;
  while (!all.empty() && all.back().time_s > estimate.time_s) all.pop_back();  // the run was rewound
  if (all.size() < 2 || estimate.time_s - all[all.size() - 2].time_s >= interval_s)
    all.push_back(estimate);
  else
    all.back() = estimate;
}

std::vector<std::string> LogEstimates::vehicles() const {
  std::vector<std::string> names;
  for (const auto& [vehicle, estimates] : by_vehicle_) names.push_back(vehicle);
  return names;
}

const LogEstimate* LogEstimates::find(const std::string& vehicle, double time_s, double max_age_s) const {
  const auto known = by_vehicle_.find(vehicle);
  if (known == by_vehicle_.end()) return nullptr;
  const std::vector<LogEstimate>& all = known->second;
  const auto after = std::upper_bound(all.begin(), all.end(), time_s,
                                      [](double at_s, const LogEstimate& each) { return at_s < each.time_s; });
  if (after == all.begin() || time_s - (after - 1)->time_s > max_age_s) return nullptr;
  return &*(after - 1);
}

}  // namespace viewer
