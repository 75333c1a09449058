// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/log/log_index.hpp"

#include <algorithm>
#include <span>
#include <stdexcept>

#include "shoal/message_codec.hpp"
#include "shoal/sim_event_t.hpp"
#include "shoal/sim_info_t.hpp"
#include "shoal/waypoints_command_t.hpp"
#include "shoal/wire_value.hpp"
#include "viewer/log/message_times.hpp"

namespace viewer {

namespace {

constexpr std::size_t fingerprint_bytes = 8, word_bytes = 8;

/// Big-endian number of eight bytes in a payload, at an offset after the fingerprint; none: the payload is too short.
std::optional<std::uint64_t> word_of(std::span<const std::byte> payload, std::size_t offset) {
  if (payload.size() < fingerprint_bytes + offset + word_bytes) return std::nullopt;
  return shoal::big_endian<std::uint64_t>(payload.data() + fingerprint_bytes + offset);
}

bool is_path_of(const bridges::LogEventView& event) {
  return event.payload.size() >= fingerprint_bytes && !event.channel.starts_with("sim.") &&
         shoal::fingerprint(event.payload) == shoal::fingerprint_of<shoal::waypoints_command_t>();
}

/// Returns the UTC of simulated time 0 by the first `sim.info`, which a logger that was started after the run has only
/// after other messages; none: 0.
std::int64_t epoch_in(const std::string& path) {
  bridges::EventLogReader reader(path);
  bridges::LogEventView event;
  while (reader.next(event)) {
    if (event.channel != "sim.info") continue;
    try {
      return shoal::decode<shoal::sim_info_t>(event.payload, shoal::Finite::any).epoch_utime;
    } catch (const shoal::MessageError&) {  // reported later
    }
  }
  return 0;
}

}  // namespace

const LogIndex::Mark* LogIndex::last(const std::vector<Mark>& marks, std::int64_t time_us) {
  const auto after = std::upper_bound(marks.begin(), marks.end(), time_us,
                                      [](std::int64_t time, const Mark& mark) { return time < mark.time_us; });
  return after == marks.begin() ? &*after : &*std::prev(after);
}

std::optional<LogIndex::Mark> LogIndex::scores_at(std::int64_t time_us) const {
  if (scores_.empty() || scores_.front().time_us > time_us) return std::nullopt;
  return *last(scores_, time_us);
}

std::vector<std::uint64_t> LogIndex::paths_at(std::int64_t time_us) const {
  std::vector<std::uint64_t> offsets;
  for (const auto& [channel, marks] : paths_)
    if (marks.front().time_us <= time_us) offsets.push_back(last(marks, time_us)->offset);
  return offsets;
}

void LogIndex::add(std::vector<Mark>& marks, const Mark& mark) {
  while (!marks.empty() && marks.back().time_us > mark.time_us) marks.pop_back();  // the run was rewound
  marks.push_back(mark);
}

void LogIndex::mark_traffic(const Mark& mark, TrafficCounts& counts) {
  if (traffic_.rewind(mark.time_us)) counts = traffic_.last();
  constexpr std::int64_t interval_us = 1'000'000;
  if (mark.time_us / interval_us != traffic_.last_us() / interval_us) traffic_.mark(mark.time_us, mark.offset, counts);
}

void LogIndex::add_hash(const Hash& hash) {
  while (!hashes_.empty() && hashes_.back().time_us > hash.time_us) hashes_.pop_back();
  // A run writes another sim.info at its end, after the last requests.
  if (hashes_.empty() || hashes_.back().time_us < hash.time_us) hashes_.push_back(hash);
}

LogIndex::LogIndex(const std::string& path, const std::function<void(double share)>& progress)
    : epoch_us_(epoch_in(path)) {
  bridges::EventLogReader reader(path);
  bridges::LogEventView event;
  std::int64_t number = 0;
  TrafficCounts counts;
  while (reader.next(event)) {
    constexpr std::int64_t events_per_report = 1 << 16;
    if (progress && ++number % events_per_report == 0)
      progress(static_cast<double>(event.offset) / static_cast<double>(reader.file_bytes()));
    const bool is_bodies = event.channel == "sim.bodies";
    if (!is_bodies) counts.take(event.channel, event.payload);
    const bool is_path = is_path_of(event);
    if (!is_path && !event.channel.starts_with("sim.")) continue;
    const auto stamp = stamp_of(event.payload);
    if (!stamp) continue;
    const Mark mark{*stamp - epoch_us_, event.offset};
    if (is_path) {
      add(paths_[std::string(event.channel)], mark);
      continue;
    }
    try {
      if (event.channel == "sim.info") {
        const auto info = shoal::decode<shoal::sim_info_t>(event.payload, shoal::Finite::any);
        has_info_ = true;
        epoch_us_ = info.epoch_utime;
        world_ = info.world;
      } else if (is_bodies) {
        add(bodies_, mark);
        mark_traffic(mark, counts);
        counts.take(event.channel, event.payload);
      } else if (event.channel == "sim.scene") {
        add(scenes_, mark);
      } else if (event.channel == "sim.scores") {
        add(scores_, mark);
      } else if (event.channel == "sim.hash") {
        constexpr std::size_t step_at = 8, hash_at = 28;  // after stamp, step, branch and number of inputs
        const auto step = word_of(event.payload, step_at), hash = word_of(event.payload, hash_at);
        if (step && hash) add_hash({mark.time_us, static_cast<std::int64_t>(*step), *hash});
      } else if (event.channel == "sim.asset") {
        assets_.push_back(event.offset);
      } else if (event.channel == "sim.event" && occasions_.size() < max_occasions) {
        const auto occasion = shoal::decode<shoal::sim_event_t>(event.payload, shoal::Finite::any);
        occasions_.push_back({mark.time_us, occasion.kind, occasion.who, occasion.text});
      }
    } catch (const shoal::MessageError& error) {
      problems_.push_back(std::string(event.channel) + ": " + error.what());
    }
  }
  for (const std::string& problem : reader.problems()) problems_.push_back(problem);
  check(path);
}

void LogIndex::check(const std::string& path) const {
  if (!scenes_.empty() && !bodies_.empty()) return;
  const std::string missing = scenes_.empty() && bodies_.empty() ? "neither sim.scene nor sim.bodies"
                              : scenes_.empty()                  ? "no sim.scene"
                                                                 : "no sim.bodies";
  throw std::runtime_error(
      path + ": has " + missing +
      ", so there is nothing to show: it was recorded by an earlier version of Shoal, with 'view:' "
      "switched off, or by a logger that was started after the run" +
      (has_info_ ? "; `shoal view " + path +
                       " --resimulate` re-simulates and shows its world if the log has the run from its start"
                 : ""));
}

}  // namespace viewer
