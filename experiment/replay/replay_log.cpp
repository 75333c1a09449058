// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/replay/replay_log.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <deque>
#include <map>
#include <set>
#include <span>
#include <stdexcept>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bridges/control/run_audit.hpp"
#include "bridges/log/event_log.hpp"
#include "bridges/log/record_reader.hpp"
#include "bridges/log/recording_bus.hpp"
#include "bridges/log/run_journal.hpp"
#include "experiment/results/summary_file.hpp"
#include "experiment/run/version.hpp"
#include "experiment/snapshot/snapshot_pieces.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_audit_t.hpp"
#include "shoal/sim_hash_t.hpp"
#include "shoal/sim_inputs_t.hpp"
#include "shoal/sim_snapshot_t.hpp"
#include "shoal/sim_state_t.hpp"
#include "sim/config/message_text.hpp"

namespace experiment {

namespace {

constexpr std::size_t max_problems = 20;
/// Losses are not searched for after a longer interval without messages.
constexpr std::size_t max_since_inputs = 1'000'000;

/// Reads the big-endian number after the fingerprint and `index` others.
std::int64_t number_at(std::span<const std::byte> payload, std::size_t index) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 8; ++i) value = value << 8 | std::to_integer<std::uint64_t>(payload[8 + 8 * index + i]);
  return static_cast<std::int64_t>(value);
}

/// Returns the program that wrote a sim.info of any version, such as `shoal 0.4.0 (a1b2c3d)`: the first members are the
/// same in all versions.  Empty: unreadable.
std::string version_in(std::span<const std::byte> payload) {
  std::size_t at = 8 + 8;  // fingerprint, utime
  const auto text = [&]() -> std::string {
    if (payload.size() < at + 4) return "";
    std::uint32_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) size = size << 8 | std::to_integer<std::uint32_t>(payload[at + i]);
    at += 4;
    if (size == 0 || payload.size() - at < size) {
      at = payload.size();
      return "";
    }
    const std::string found(reinterpret_cast<const char*>(payload.data()) + at, size - 1);
    at += size;
    return found;
  };
  text();       // world
  at += 8 + 8;  // seed, step
  text();       // resolved_config
  const std::string versions = text();
  const std::string first = versions.substr(0, versions.find('\n'));
  return first.starts_with("shoal ") ? sim::shortened(sim::printable(first)) : "";
}

class Reader {
 public:
  explicit Reader(const std::string& path) : file_(path) { log_.path = path; }

  ReplayLog read() {
    // Read all events.
    bridges::LogEventView event;
    while (file_.next(event)) {
      count(event.channel);
      if (event.channel != "sim.audit") {  // it may follow the end of a step
        last_stamp_ = event.utime;
        ends_whole_ = false;
      }
      if (!informed_ && event.channel == "sim.info") version_ = version_in(event.payload);
      if (!event.channel.starts_with("sim.")) {
        if (informed_ && log_.own_stamps && since_inputs_.size() < max_since_inputs)
          since_inputs_.push_back({last_, step_of(event.utime)});
        continue;
      }
      try {
        take(event);
      } catch (const shoal::MessageError& error) {
        problem(fmt::format("byte {}: {}: {}", event.offset, event.channel, error.what()));
      }
    }
    // Check that the log is complete.
    for (const Count& count : counts_) log_.events.emplace(count.channel, count.events);
    for (const std::string& text : file_.problems()) problem(text);
    log_.is_thinned = log_.events.contains(bridges::budget_channel);
    if (!informed_) fail_without_info();
    note_missing_pieces();
    leave_out_incomplete();
    narrow_holes();
    for (const Hole& hole : holes_) report(hole);
    return std::move(log_);
  }

 private:
  /// Message, by the index of its channel in counts_.
  struct Arrival {
    std::size_t channel;
    std::int64_t step;
  };
  /// Missing numbers of sim.inputs, and the steps between which they were published.
  struct Hole {
    std::int64_t first, last;
    std::int64_t from_step, to_step;
    std::vector<Arrival> came = {};  ///< of a record: all messages in it since the preceding sim.inputs
  };

  /// Unsigned arithmetic, because a damaged time stamp may overflow.
  std::int64_t since_start(std::int64_t utime) const {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(utime) -
                                     static_cast<std::uint64_t>(log_.info.epoch_utime));
  }
  std::int64_t step_of(std::int64_t utime) const { return since_start(utime) / log_.info.step_us; }

  /// A record contains messages from outside in addition to sim.inputs: when a channel has exactly as many messages
  /// more than inputs as arrived in the holes, those messages determine the steps of the holes.
  void narrow_holes() {
    if (!log_.own_stamps) return;
    std::map<std::string, std::int64_t, std::less<>> unknown;  // by channel of the inputs
    // Count the events that are not known to be inputs.
    std::set<std::pair<std::string, std::int64_t>> inputs;
    for (const ReplayLog::Input& input : log_.inputs) {
      if (!log_.events.contains(input.channel)) continue;
      unknown.try_emplace(input.channel, log_.events.at(input.channel)).first->second -= 1;
      inputs.emplace(input.channel, input.step);
    }
    // Remove arrivals that are known.
    for (Hole& hole : holes_)
      std::erase_if(hole.came, [&](const Arrival& came) {
        const std::string& channel = counts_[came.channel].channel;
        return !unknown.contains(channel) || inputs.contains({channel, came.step});
      });
    for (const Hole& hole : holes_)
      for (const Arrival& came : hole.came) unknown.at(counts_[came.channel].channel) -= 1;
    // Narrow each hole to the steps of its arrivals.
    for (Hole& hole : holes_) {
      std::erase_if(hole.came, [&](const Arrival& came) { return unknown.at(counts_[came.channel].channel) != 0; });
      if (hole.came.empty() || hole.last - hole.first + 1 > static_cast<std::int64_t>(hole.came.size())) continue;
      hole.from_step = hole.came.front().step;
      hole.to_step = hole.came.back().step;
    }
  }

  /// Omits the last step when its inputs are missing: inputs follow the messages of their step, and a log that breaks
  /// off between them cannot repeat the step.
  void leave_out_incomplete() {
    // In a record all events of a step precede those of a later one.
    std::int64_t stamped = step_of(last_stamp_);
    // A sim.info is published every 10 s: a time stamp far beyond the last one is damaged.
    if (stamped > log_.last_step + 2 + 10'000'000 / log_.info.step_us) stamped = log_.last_step;
    if (log_.own_stamps) whole_step_ = std::max(whole_step_, stamped - 1);
    const std::int64_t known = std::max(log_.last_step, log_.own_stamps ? stamped : 0);
    log_.last_step = std::max(whole_step_, log_.begin_step());
    // Inputs for the next step may follow the end of a step.
    if (known > log_.last_step || (log_.own_stamps && !ends_whole_))
      log_.cut = fmt::format("the log ends in the middle of step {}: everything after step {} is left out",
                             std::max(known, log_.last_step + 1), log_.last_step);
  }

  void report(const Hole& hole) {
    const auto& [first, last, from, to, came] = hole;
    log_.holes.push_back(
        first == last && from == to ? fmt::format("sim.inputs {} (of step {}) is missing", first, from)
        : first == last
            ? fmt::format("sim.inputs {} (of a step from {} to {}) is missing", first, from, to)
            : fmt::format("sim.inputs {} to {} (of steps from {} to {}) are missing", first, last, from, to));
    log_.proven_step = std::min({log_.proven_step.value_or(from), from, log_.last_step});
  }

  [[noreturn]] void fail(const std::string& what) const { throw std::runtime_error(log_.path + ": " + what); }

  [[noreturn]] void fail_without_info() const {
    if (log_.events.empty()) fail("is not an LCM log: it contains no readable event");
    if (!version_.empty())
      fail(
          fmt::format("was written by {}; this is shoal {}, which cannot read its sim.info: replay it with the version "
                      "that wrote it",
                      version_, short_version()));
    if (log_.events.contains("sim.info"))
      fail("its sim.info cannot be read: another version of Shoal wrote it, or it is damaged" +
           (log_.problems.empty() ? std::string() : " (" + log_.problems.front() + ")"));
    fail("contains no sim.info, which describes the world: it is not a log of a run, or covers less than 10 s of one");
  }

  void problem(const std::string& text) {
    if (log_.problems.size() < max_problems) log_.problems.push_back(text);
  }

  struct Count {
    std::string channel;
    std::uint64_t events = 0;
    std::size_t next = 0;  ///< channel that followed this one the last time
  };

  /// Finds the channel that followed the preceding one the last time, because steps resemble each other; this saves a
  /// search for the name.
  void count(std::string_view channel) {
    std::size_t found = counts_.empty() ? 0 : counts_[last_].next;
    if (counts_.empty() || counts_[found].channel != channel) {
      const auto known = by_name_.find(channel);
      found = known != by_name_.end() ? known->second : counts_.size();
      if (known == by_name_.end()) by_name_.emplace(counts_.emplace_back(Count{std::string(channel)}).channel, found);
      counts_[last_].next = found;
    }
    ++counts_[found].events;
    last_ = found;
  }

  void take(const bridges::LogEventView& event) {
    if (event.channel == "sim.info") return take_info(event);
    if (event.channel == "sim.inputs") return take_messages(event);
    if (event.channel == "sim.hash") return take_hash(event);
    if (event.channel == "sim.snapshot") return take_snapshot(event);
    if (event.channel == "sim.state") take_state(event);
    if (event.channel == "sim.audit") take_audit(event);
  }

  void take_audit(const bridges::LogEventView& event) {
    if (log_.audit.size() >= bridges::RunAudit::max_kept) return;
    const auto audit_entry = shoal::decode<shoal::sim_audit_t>(event.payload, shoal::Finite::any);
    const double time_s = informed_ ? 1e-6 * static_cast<double>(since_start(audit_entry.utime)) : 0;
    log_.audit.push_back(sim::shortened(sim::printable(audit_text({time_s, audit_entry.kind, audit_entry.client,
                                                                   audit_entry.signer, audit_entry.text})),
                                        300));
  }

  void take_state(const bridges::LogEventView& event) {
    if (shoal::fingerprint(event.payload) != shoal::sim_state_t::getHash() || event.payload.size() < 24) return;
    const std::int64_t step = number_at(event.payload, 1);
    if (!informed_ || !is_time_of(step, number_at(event.payload, 0))) return;  // of another run
    note_step(step);
    published_ = true;
    if (event.utime != number_at(event.payload, 0)) log_.own_stamps = false;
  }

  /// Stores the snapshot with which the run, or this branch, starts: earlier events are not needed for a replay.
  void take_snapshot(const bridges::LogEventView& event) {
    const auto message = shoal::decode<shoal::sim_snapshot_t>(event.payload, shoal::Finite::any);
    check_stamp(event, message.utime, message.step);
    if (informed_ && message.branch != branch_)
      throw shoal::MessageError(fmt::format("is of branch {}, but the log is of branch {}", message.branch, branch_));
    const std::optional<sim::Bytes> bytes = pieces_.add(message);
    if (!bytes || !informed_) return;
    try {
      begin_with(snapshot_from_bytes(*bytes, "sim.snapshot"), message);
    } catch (const SnapshotFileError& error) {
      log_.bad_snapshot = error.what();
    }
  }

  void begin_with(Snapshot snapshot, const shoal::sim_snapshot_t& message) {
    const shoal::sim_info_t& info = log_.info;
    if (snapshot.step != message.step || snapshot.seed != info.seed || snapshot.step_us != info.step_us ||
        snapshot.epoch_us != info.epoch_utime || snapshot.resolved_world != info.resolved_config)
      throw SnapshotFileError("sim.snapshot: is of another world, seed, epoch or step than sim.info reports");
    log_.is_rewound = log_.is_rewound || published_;
    whole_step_ = message.step - 1;
    log_.snapshot = std::move(snapshot);
    log_.bad_snapshot.clear();
    log_.inputs.clear();
    log_.hashes.clear();
    holes_.clear();
    next_sequence_ = message.input_sequence;
    input_step_ = log_.last_step = message.step;
  }

  void note_missing_pieces() {
    const std::string missing = pieces_.missing();
    if (!missing.empty()) log_.bad_snapshot = "sim.snapshot: " + missing;
  }

  void note_step(std::int64_t step) {
    if (!std::exchange(stepped_, true)) log_.first_step = step;
    if (step < log_.last_step) log_.is_rewound = true;
    log_.last_step = std::max(log_.last_step, step);
  }

  bool is_time_of(std::int64_t step, std::int64_t utime) const {
    if (step < 0 || step > 1'000'000'000'000) return false;
    // Unsigned arithmetic: the numbers are untrusted, and may overflow.
    const std::uint64_t since = static_cast<std::uint64_t>(step) * static_cast<std::uint64_t>(log_.info.step_us);
    return static_cast<std::uint64_t>(utime) == static_cast<std::uint64_t>(log_.info.epoch_utime) + since;
  }

  /// Rejects a time stamp that is not that of its step: it belongs to another run, or to another epoch.
  void check_stamp(const bridges::LogEventView& event, std::int64_t utime, std::int64_t step) const {
    if (!informed_) return;
    const shoal::sim_info_t& info = log_.info;
    if (!is_time_of(step, utime))
      fail(fmt::format("byte {}: {} is stamped {} at step {}, which is not a time of this run (epoch {}, step {} us)",
                       event.offset, event.channel, utime, step, info.epoch_utime, info.step_us));
  }

  void take_info(const bridges::LogEventView& event) {
    auto info = bridges::read_run_info(event.payload);
    if (event.utime != info.utime) log_.own_stamps = false;
    // First message: start of the run.
    if (!informed_) {
      if (info.step_us < 1 || info.step_us > 10'000'000)
        throw shoal::MessageError("step_us must be from 1 to 10000000, got " + std::to_string(info.step_us));
      informed_ = true;
      branch_ = info.branch;
      log_.info = std::move(info);
      check_stamp(event, log_.info.utime, log_.info.step);
      check_sequence(log_.info.input_sequence, log_.info.step);
      note_step(log_.info.step);
      whole_step_ = log_.info.step - 1;  // its own inputs follow it
      return;
    }
    // Later message: the same run, or another branch of it.
    const shoal::sim_info_t& first = log_.info;
    const bool same_run = info.world == first.world && info.seed == first.seed && info.step_us == first.step_us &&
                          info.epoch_utime == first.epoch_utime && info.resolved_config == first.resolved_config;
    if (!same_run || (info.branch <= branch_ && info.step < log_.last_step))
      fail(fmt::format("holds two runs: another begins at byte {} (world '{}', seed {}); cut it in two", event.offset,
                       info.world, info.seed));
    check_stamp(event, info.utime, info.step);
    const bool is_rewound = info.branch > branch_;
    if (is_rewound) start_branch(info);
    check_sequence(info.input_sequence, info.step);
    input_step_ = std::max(input_step_, info.step - 1);
    note_step(info.step);
    whole_step_ = is_rewound ? info.step : std::max(whole_step_, info.step - 1);
  }

  /// Starts another branch after a rewind: later events of the previous branch are not part of it.
  void start_branch(const shoal::sim_info_t& info) {
    branch_ = info.branch;
    if (log_.last_step > info.step) log_.is_rewound = true;
    std::erase_if(log_.inputs, [&](const ReplayLog::Input& input) { return input.step >= info.step; });
    log_.hashes.erase(log_.hashes.upper_bound(info.step), log_.hashes.end());
    const bool before_snapshot = info.step < log_.begin_step();
    if (before_snapshot) {
      log_.snapshot.reset();
      log_.bad_snapshot = fmt::format("sim.snapshot: the log is rewound to step {}, before its snapshot", info.step);
    }
    log_.last_step = info.step;
    input_step_ = std::min(input_step_, info.step);
    // Losses in the abandoned part do not matter.
    std::erase_if(holes_, [&](const Hole& hole) { return hole.first >= info.input_sequence; });
    if (!holes_.empty()) holes_.back().last = std::min(holes_.back().last, info.input_sequence - 1);
    next_sequence_ = std::min(next_sequence_, info.input_sequence);  // a larger one is a gap
    if (before_snapshot) holes_.push_back({0, std::max<std::int64_t>(info.input_sequence - 1, 0), 0, info.step});
  }

  /// `next`: lowest number of a sim.inputs that may still follow.
  void check_sequence(std::int64_t next, std::int64_t step) {
    if (next > next_sequence_) {
      holes_.push_back({next_sequence_, next - 1, input_step_, step, since_inputs_});
      next_sequence_ = next;
    }
  }

  void take_messages(const bridges::LogEventView& event) {
    auto input_record = shoal::decode<shoal::sim_inputs_t>(event.payload, shoal::Finite::any);
    check_stamp(event, input_record.utime, input_record.step);
    if (input_record.branch != branch_ && informed_)
      throw shoal::MessageError(
          fmt::format("is of branch {}, but the log is of branch {}", input_record.branch, branch_));
    if (input_record.sequence < next_sequence_)
      throw shoal::MessageError(fmt::format("number {} occurs twice", input_record.sequence));
    check_sequence(input_record.sequence, input_record.step);
    next_sequence_ = input_record.sequence + 1;
    since_inputs_.clear();
    for (shoal::sim_input_t& input : input_record.input) {
      if (input.step > input_record.step || (!log_.inputs.empty() && input.step < log_.inputs.back().step))
        throw shoal::MessageError(fmt::format("an input of step {} is out of order", input.step));
      const auto* begin = reinterpret_cast<const std::byte*>(input.data.data());
      log_.inputs.push_back(
          {input.step, std::move(input.bus), std::move(input.channel), sim::Bytes(begin, begin + input.data.size())});
    }
    input_step_ = input_record.step;
    note_whole(input_record.step);
  }

  void take_hash(const bridges::LogEventView& event) {
    auto message = shoal::decode<shoal::sim_hash_t>(event.payload, shoal::Finite::any);
    // Check the position in the log.
    check_stamp(event, message.utime, message.step);
    check_sequence(message.input_sequence, message.step);
    since_inputs_.clear();
    // Store the hash of the state and of its parts.
    ReplayLog::Hashes& hashes = log_.hashes[message.step];
    hashes.whole = static_cast<std::uint64_t>(message.hash);
    hashes.after_inputs = std::any_of(log_.inputs.rbegin(), log_.inputs.rend(), [&](const ReplayLog::Input& input) {
      return input.step == message.step && input.bus != bridges::RunJournal::serial_bus;
    });
    hashes.parts.clear();
    hashes.run.reset();
    for (std::size_t i = 0; i < message.part.size(); ++i) {
      const auto hash = static_cast<std::uint64_t>(message.part_hash[i]);
      if (message.part[i] == bridges::RunJournal::run_hash_part)
        hashes.run = hash;
      else
        hashes.parts.push_back({std::move(message.part[i]), hash});
    }
    input_step_ = std::max(input_step_, message.step);  // all earlier inputs were in messages before this one
    note_whole(message.step);
    published_ = true;
  }

  /// Marks a step as complete: this message is its last one.
  void note_whole(std::int64_t step) {
    note_step(step);
    whole_step_ = std::max(whole_step_, step);
    ends_whole_ = true;
  }

  bridges::EventLogReader file_;
  SnapshotPieces pieces_;
  ReplayLog log_;
  std::deque<Count> counts_;  // deque: its names keep their addresses
  std::unordered_map<std::string_view, std::size_t> by_name_;
  std::size_t last_ = 0;  // in counts_
  std::vector<Hole> holes_;
  std::vector<Arrival> since_inputs_;
  bool informed_ = false, stepped_ = false, published_ = false;
  std::int32_t branch_ = 0;
  std::int64_t next_sequence_ = 0;
  std::int64_t input_step_ = 0;   // last step without a missing sim.inputs
  std::int64_t whole_step_ = -1;  // last step with all inputs and messages
  std::int64_t last_stamp_ = 0;   // of the last event
  bool ends_whole_ = false;       // the last event ended a step
  std::string version_;           // version of an unreadable sim.info; empty: none
};

}  // namespace

ReplayLog read_replay_log(const std::string& path) {
  return Reader(path).read();
}

}  // namespace experiment
