// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "bridges/base/bus_error.hpp"
#include "sim/bus/bus.hpp"
#include "sim/bus/message_gate.hpp"

namespace bridges {

class EventLogWriter;

enum class Existing { refuse, overwrite };

/// A bus that also writes all it carries into an LCM event log, stamped with epoch + simulated time:
/// lcm-logplayer plays it back at the right speed, and two equal runs leave equal files.  For one thread.
///
/// Recorded are what is published here, and what a gate before this bus admitted: only that decides what the
/// simulation does.
class RecordingBus final : public sim::Bus {
 public:
  /// Throws BusError when the file exists and may not be overwritten, or cannot be made.
  RecordingBus(std::unique_ptr<sim::Bus> inner, const std::string& path, std::int64_t epoch_utime,
               Existing existing = Existing::refuse);
  /// `inner` must outlive this.
  RecordingBus(sim::Bus& inner, const std::string& path, std::int64_t epoch_utime,
               Existing existing = Existing::refuse);
  /// A second bus that is recorded into the log of the first, which must outlive this.
  RecordingBus(sim::Bus& inner, RecordingBus& first);
  ~RecordingBus() override;

  void publish(std::string_view channel, std::span<const std::byte> payload, sim::Time at) override;
  std::unique_ptr<sim::Mailbox> open_mailbox(const std::string& channel,
                                             std::size_t capacity = default_mailbox_capacity) override {
    return inner_.open_mailbox(channel, capacity);
  }
  /// Writes down messages from outside and was handed to the world.
  void admitted(std::span<const sim::MessageGate::Delivery> input_record);
  /// Has what is older than a quarter of a second of wall time written: a run that is killed loses no more.
  void end_of_step() override;
  sim::BusCounts counts() const override { return inner_.counts(); }

  /// The step that begins: the stamp of what is admitted from now on.
  void set_time(sim::Time at);
  /// The first error, with path and reason; nothing is written after it.  What was written stays readable.
  std::optional<std::string> error() const { return error_; }
  std::uint64_t recorded() const { return recorded_; }
  /// Size of the log so far.
  std::uint64_t bytes() const { return bytes_; }
  /// Makes another log, which begins with a copy of the first `events` events, of `bytes` bytes.  This one continues
  /// until go_on().  Throws BusError when the file cannot be made whole.
  void prepare(const std::string& path, std::uint64_t events, std::uint64_t bytes, Existing existing);
  /// Closes the log and continues in the prepared one.
  void go_on();
  /// Removes the one that was prepared.
  void give_up();
  /// Lets what is buffered be written, and does not wait for it: for a run that stands still.  Not more often than it
  /// is worth it, so call it again.
  void hand_over();
  /// Writes what is buffered.  The bus continues without recording.
  void close();
  sim::Bus& inner() { return inner_; }

 private:
  struct Next {
    std::string path;
    std::uint64_t events, bytes;
    std::unique_ptr<EventLogWriter> log;
  };

  void record(std::string_view channel, std::span<const std::byte> payload);
  void hand_over_after(std::chrono::milliseconds pause);
  void fail(int error_number);

  std::unique_ptr<sim::Bus> owned_;
  sim::Bus& inner_;
  RecordingBus* first_ = nullptr;  // whose log is used; null: our own
  std::string path_;
  std::int64_t epoch_utime_ = 0;
  std::int64_t utime_ = 0;      // of the last event; never goes back
  std::int64_t checked_s_ = 0;  // simulated second in which it was last looked whether to hand over
  std::chrono::steady_clock::time_point handed_over_;
  std::unique_ptr<EventLogWriter> log_;
  std::optional<Next> next_;  // prepared
  std::optional<std::string> error_;
  std::uint64_t recorded_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace bridges
