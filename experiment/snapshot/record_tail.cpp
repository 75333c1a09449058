// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/snapshot/record_tail.hpp"

#include <fcntl.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <vector>

#include "bridges/log/event_log.hpp"
#include "experiment/snapshot/snapshot_file.hpp"
#include "experiment/snapshot/snapshot_pieces.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_hash_t.hpp"
#include "shoal/sim_inputs_t.hpp"

namespace experiment {

namespace {

namespace fs = std::filesystem;

/// Additional seconds that are accepted in order to start with a snapshot.
constexpr double max_more_s = 60;

/// Position in the record from which its events are kept.
struct Start {
  std::uint64_t offset = 0;
  std::int64_t utime = 0;
};

/// Results of one pass over the record.
struct Survey {
  Start first;
  std::int64_t last_utime = 0;
  std::uint64_t bytes = 0;
  std::optional<shoal::sim_info_t> info;  ///< the last one
  std::vector<Start> snapshots;           ///< first pieces of sim.snapshot
};

template <typename Message>
std::optional<Message> decoded(const bridges::LogEventView& event) {
  try {
    return shoal::decode<Message>(event.payload, shoal::Finite::any);
  } catch (const shoal::MessageError&) {
    return std::nullopt;  // of another program, or damaged: `shoal replay` reports details
  }
}

bool is_first_piece(const bridges::LogEventView& event) {
  if (event.channel != "sim.snapshot") return false;
  const auto piece = decoded<shoal::sim_snapshot_t>(event);
  return piece && piece->piece == 0;
}

Survey survey(const std::string& record) {
  bridges::EventLogReader log(record);
  Survey found;
  bridges::LogEventView event;
  for (bool first = true; log.next(event); first = false) {
    if (first) found.first = {event.offset, event.utime};
    found.last_utime = std::max(found.last_utime, event.utime);
    if (is_first_piece(event)) found.snapshots.push_back({event.offset, event.utime});
    // The last readable one: the record may end in the middle of a message.
    if (event.channel == "sim.info")
      if (auto info = decoded<shoal::sim_info_t>(event)) found.info = std::move(info);
  }
  found.bytes = log.file_bytes();
  if (!found.info) throw std::runtime_error(record + ": is not a log of a run: it has no sim.info that can be read");
  return found;
}

/// Returns the first event that is later than `utime`, and at `offset` or after it.
Start find_start(const std::string& record, std::int64_t utime, std::uint64_t offset) {
  bridges::EventLogReader log(record);
  bridges::LogEventView event;
  while (log.next(event))
    if (event.utime > utime && event.offset >= offset) return {event.offset, event.utime};
  return {log.file_bytes(), utime};
}

bool is_of_run(const Snapshot& snapshot, const shoal::sim_info_t& info) {
  return snapshot.seed == info.seed && snapshot.epoch_us == info.epoch_utime && snapshot.step_us == info.step_us &&
         snapshot.branch == info.branch && snapshot.resolved_world == info.resolved_config;
}

/// Returns the best of the run's snapshot files: the last one before `latest`, and not before `earliest`.
std::optional<Snapshot> find_snapshot(const std::string& folder, const shoal::sim_info_t& info, std::int64_t earliest,
                                      std::int64_t latest) {
  std::optional<Snapshot> best;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".snapshot" || !fs::is_regular_file(entry.symlink_status())) continue;
    try {
      Snapshot snapshot = read_snapshot(entry.path().string());
      const bool fits = is_of_run(snapshot, info) && snapshot.utime() >= earliest && snapshot.utime() <= latest;
      if (fits && (!best || snapshot.step > best->step)) best = std::move(snapshot);
    } catch (const SnapshotFileError&) {
      // Skip unusable files.
    }
  }
  return best;
}

/// Returns the last snapshot in the record before `latest`, and not before `earliest`.
std::optional<Start> find_snapshot(const std::vector<Start>& snapshots, std::int64_t earliest, std::int64_t latest) {
  std::optional<Start> best;
  for (const Start& snapshot : snapshots)
    if (snapshot.utime >= earliest && snapshot.utime <= latest) best = snapshot;
  return best;
}

class Writer {
 public:
  Writer(const std::string& record, const std::string& out) : record_(record), out_(out), log_(open_file(out)) {}

  /// Copies all events from `start` on, after the last preceding sim.info and `snapshot`.
  std::uint64_t copy(const Start& start, const std::optional<Snapshot>& snapshot) {
    bridges::EventLogReader from(record_);
    bridges::LogEventView event;
    std::uint64_t copied = 0;
    for (bool started = false; from.next(event);) {
      if (event.offset < start.offset) {
        look_at(event);
        if (snapshot && event.utime == snapshot->utime()) keep_state(event);
        continue;
      }
      if (!started) begin(snapshot);
      started = true;
      write(event.utime, event.channel, event.payload);
      ++copied;
    }
    errno = 0;
    if (!log_.flush()) fail();
    return copied;
  }

 private:
  bridges::FileDescriptor open_file(const std::string& path) const {
    bridges::FileDescriptor file(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (file.number() < 0) fail();
    return file;
  }

  [[noreturn]] void fail() const {
    throw std::runtime_error(out_ + ": cannot be written: " + std::strerror(errno != 0 ? errno : EIO));
  }

  /// Processes an event before the kept part: the world, and the number of the next sim.inputs.
  void look_at(const bridges::LogEventView& event) {
    if (event.channel == "sim.info") {
      if (const auto info = decoded<shoal::sim_info_t>(event)) {
        info_.assign(event.payload.begin(), event.payload.end());
        info_utime_ = event.utime;
        branch_ = info->branch;
        sequence_ = std::max(sequence_, info->input_sequence);
      }
    } else if (event.channel == "sim.inputs") {
      if (const auto inputs = decoded<shoal::sim_inputs_t>(event))
        sequence_ = std::max(sequence_, inputs->sequence + 1);
    } else if (event.channel == "sim.hash") {
      if (const auto hash = decoded<shoal::sim_hash_t>(event)) sequence_ = std::max(sequence_, hash->input_sequence);
    }
  }

  /// Publishes the messages of the snapshot's step, as a run that starts with it does.
  void keep_state(const bridges::LogEventView& event) {
    if (event.channel == "sim.clock" || event.channel == "sim.state" || event.channel == "sim.hash")
      state_.emplace_back(event.channel, sim::Bytes(event.payload.begin(), event.payload.end()));
  }

  void begin(const std::optional<Snapshot>& snapshot) {
    if (!info_.empty()) write(info_utime_, "sim.info", info_);
    if (!snapshot) return;
    for (const shoal::sim_snapshot_t& piece : in_pieces(*snapshot, branch_, sequence_))
      write(piece.utime, "sim.snapshot", shoal::encode(piece));
    for (const auto& [channel, payload] : state_) write(snapshot->utime(), channel, payload);
  }

  void write(std::int64_t utime, std::string_view channel, std::span<const std::byte> payload) {
    errno = 0;
    if (!log_.write(number_++, utime, channel, payload)) fail();
  }

  std::string record_, out_;
  bridges::EventLogWriter log_;
  std::int64_t number_ = 0;
  std::vector<std::pair<std::string, sim::Bytes>> state_;  // of the snapshot's step
  sim::Bytes info_;
  std::int64_t info_utime_ = 0;
  std::int32_t branch_ = 0;
  std::int64_t sequence_ = 0;  // of the next sim.inputs
};

}  // namespace

RecordTail write_record_tail(const std::string& record, const std::string& out, const TailOptions& options) {
  const Survey found = survey(record);
  // Extent of the record.
  const shoal::sim_info_t& info = *found.info;
  const auto in_s = [&](std::int64_t utime) { return static_cast<double>(utime - info.epoch_utime) * 1e-6; };
  const double before_s = static_cast<double>(found.last_utime - found.first.utime) * 1e-6;
  const auto back = [&](double seconds) {
    return found.last_utime - static_cast<std::int64_t>(std::min(seconds, before_s + 1) * 1e6);
  };
  RecordTail tail;
  tail.info = info;
  tail.end_s = in_s(found.last_utime);

  // Start of the tail: the whole record, a snapshot, or a number of seconds before the end.
  Start start = found.first;
  std::optional<Snapshot> snapshot;
  tail.whole = before_s <= options.last_s;
  if (!tail.whole) {
    const std::int64_t latest = back(options.last_s), earliest = back(options.last_s + max_more_s);
    const auto recorded = find_snapshot(found.snapshots, earliest, latest);
    snapshot = find_snapshot(options.snapshots, info, earliest, latest);
    if (snapshot && (!recorded || snapshot->utime() >= recorded->utime)) {
      start = find_start(record, snapshot->utime(), 0);
      tail.snapshot = fmt::format("a snapshot file of the run, of {:.3f} s", snapshot->time_s());
    } else if (recorded) {
      snapshot.reset();
      start = *recorded;
      tail.snapshot = fmt::format("the snapshot in the record, of {:.3f} s", in_s(recorded->utime));
    } else {
      start = find_start(record, latest, 0);
    }
  }

  // Start later, without a snapshot, if the tail is too large.
  if (found.bytes - start.offset > options.max_bytes) {
    start = find_start(record, start.utime - 1, found.bytes - options.max_bytes);
    snapshot.reset();
    tail.whole = false;
    tail.snapshot.clear();
    tail.short_of = fmt::format("more of the record is larger than {} MB", options.max_bytes >> 20);
  }
  tail.start_s = in_s(start.utime);
  tail.events = Writer(record, out).copy(start, snapshot);
  return tail;
}

}  // namespace experiment
