// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "bridges/base/bus_error.hpp"
#include "bridges/log/record_file.hpp"
#include "sim/bus/bus.hpp"
#include "sim/bus/message_gate.hpp"

namespace bridges {

/// Limit of the size of a record, which is spread over the simulated time of its run.
struct RecordBudget {
  std::uint64_t bytes = 0;
  std::int64_t duration_us = 0;  ///< simulated time of the run
};

/// Channel of a shoal.sim_event_t with which a record within a budget begins.
inline constexpr const char* budget_channel = "sim.record";

/// Bus that records its messages in an LCM event log or, by the name of the file, in an MCAP file.  The time stamp is
/// epoch + simulated time: lcm-logplayer plays a log back at the right speed, and two equal runs produce equal files.
/// Not thread-safe.  Records the messages published
/// here and those admitted by the gate in front of this bus, because only these determine the simulation.
class RecordingBus final : public sim::Bus {
 public:
  /// Throws BusError when the file exists and may not be overwritten, or cannot be created.
  RecordingBus(std::unique_ptr<sim::Bus> inner, const std::string& path, std::int64_t epoch_utime,
               Existing existing = Existing::refuse);
  /// `inner` must outlive this.
  RecordingBus(sim::Bus& inner, const std::string& path, std::int64_t epoch_utime,
               Existing existing = Existing::refuse);
  /// Makes a second bus that is recorded in the log of the first, which must outlive this.
  RecordingBus(sim::Bus& inner, RecordingBus& first);
  ~RecordingBus() override;

  void publish(std::string_view channel, std::span<const std::byte> payload, sim::Time at) override;
  std::unique_ptr<sim::OpenChannel> open_channel(const std::string& channel) override;
  std::unique_ptr<sim::Mailbox> open_mailbox(const std::string& channel,
                                             std::size_t capacity = default_mailbox_capacity) override {
    return inner_.open_mailbox(channel, capacity);
  }
  /// Records messages from outside that were delivered to the world.
  void admitted(std::span<const sim::MessageGate::Delivery> input_record);
  /// Writes events older than a quarter of a second of wall time, so that a killed run loses no more than that.
  void end_of_step() override;
  sim::BusCounts counts() const override { return inner_.counts(); }

  /// Limits the size of the record.  In each simulated second in which the record is ahead of its share of the budget,
  /// messages are left out, except for the first of each channel in a minute and those by which the run can be
  /// replayed: all sim.* apart from sim.state and sim.bodies.  When these alone exceed the budget, the record ends,
  /// with a warning. To be called before the first message.
  void set_budget(const RecordBudget& budget);
  /// Returns the number of messages that were left out because of the budget.
  std::uint64_t left_out() const { return left_out_; }
  /// Sets the time of the step that starts, which is the time stamp of messages admitted from now on.
  void set_time(sim::Time at);
  /// Returns the first error, with path and reason; nothing is written after it.  Events written before remain
  /// readable.
  std::optional<std::string> error() const { return error_; }
  std::uint64_t recorded() const { return recorded_; }
  /// Returns the end of the log so far, for prepare().
  std::uint64_t position() const { return log_ ? log_->position() : 0; }
  /// Prepares another log that starts with a copy of the first `events` events, up to `position`.  The present log
  /// continues until go_on().  Throws BusError when the file cannot be completed.
  void prepare(const std::string& path, std::uint64_t events, std::uint64_t position, Existing existing);
  /// Closes the log and continues in the prepared one.
  void go_on();
  /// Removes the prepared log.
  void give_up();
  /// Starts to write buffered events without waiting, for a paused run.  Acts at limited intervals, so it must be
  /// called periodically.
  void hand_over();
  /// Writes buffered events and closes the log.  The bus continues without recording.
  void close();
  sim::Bus& inner() { return inner_; }

 private:
  class RecordedChannel;
  struct Next {
    std::string path;
    std::uint64_t events = 0;
    std::unique_ptr<RecordFile> log;
  };

  void record(std::string_view channel, std::span<const std::byte> payload);
  /// Returns whether the budget has no room for a message.
  bool leaves_out(std::string_view channel, std::size_t bytes);
  void hand_over_after(std::chrono::milliseconds pause);
  void fail(int error_number);

  std::unique_ptr<sim::Bus> owned_;
  sim::Bus& inner_;
  RecordingBus* first_ = nullptr;  // bus whose log is used; null: own log
  std::string path_;
  std::int64_t epoch_utime_ = 0;
  std::int64_t utime_ = 0;      // utime of the last event; never decreases
  std::int64_t checked_s_ = 0;  // simulated second of the last check whether to hand over
  std::chrono::steady_clock::time_point handed_over_;
  std::unique_ptr<RecordFile> log_;
  std::optional<Next> next_;  // prepared
  std::optional<std::string> error_;
  std::uint64_t recorded_ = 0;
  std::optional<RecordBudget> budget_;
  std::int64_t decided_s_ = -1;                              // simulated second for which `thins_` holds
  bool thins_ = false;                                       // messages are left out in this second
  std::map<std::string, std::int64_t, std::less<>> kept_s_;  // by channel: second of the last message that was kept
  std::uint64_t left_out_ = 0;
};

}  // namespace bridges
