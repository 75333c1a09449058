// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/film/log_estimates.hpp"

#include <algorithm>
#include <string_view>

#include "bridges/log/event_log.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_info_t.hpp"

namespace tools {

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
      const auto message = shoal::decode<shoal::estimate_t>(event.payload, shoal::Finite::any);
      const double time_s = (static_cast<double>(message.utime) - static_cast<double>(*epoch_us)) * 1e-6;
      if (time_s < from_s || time_s > until_s) continue;
      FilmEstimate estimate;
      estimate.time_s = time_s;
      estimate.position_m = Eigen::Map<const sim::Vector3d>(message.position_m);
      estimate.covariance_m2 = Eigen::Map<const Eigen::Matrix3d>(message.covariance_m2);
      if (!estimate.position_m.allFinite() || !estimate.covariance_m2.allFinite()) continue;
      add(event.channel.substr(0, event.channel.size() - ending.size()), estimate, interval_s);
      ++count;
    } catch (const shoal::MessageError&) {
      // Another type of message on this channel, or damage, which the replay reports.
    }
  }
}

void LogEstimates::add(std::string_view channel, const FilmEstimate& estimate, double interval_s) {
  auto known = by_vehicle_.find(channel);
  if (known == by_vehicle_.end()) known = by_vehicle_.emplace(std::string(channel), std::vector<FilmEstimate>()).first;
  std::vector<FilmEstimate>& all = known->second;
  while (!all.empty() && all.back().time_s > estimate.time_s) all.pop_back();  // the run was rewound
  if (all.size() < 2 || estimate.time_s - all[all.size() - 2].time_s >= interval_s)
    all.push_back(estimate);
  else
    all.back() = estimate;
}

const FilmEstimate* LogEstimates::find(const std::string& vehicle, double time_s, double max_age_s) const {
  const auto known = by_vehicle_.find(vehicle);
  if (known == by_vehicle_.end()) return nullptr;
  const std::vector<FilmEstimate>& all = known->second;
  const auto after = std::upper_bound(all.begin(), all.end(), time_s,
                                      [](double at_s, const FilmEstimate& each) { return at_s < each.time_s; });
  if (after == all.begin() || time_s - (after - 1)->time_s > max_age_s) return nullptr;
  return &*(after - 1);
}

}  // namespace tools
