#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "bridges/lcm/lcm_listener.hpp"
#include "shoal/sim_tick_t.hpp"

namespace bridges {

/// For an autonomy program that runs in step with the simulator, in one thread:
///
///     LockstepClient client("", "pilot");
///     client.subscribe("auv1.lidar", on_lidar);
///     client.join(0.1, 5s);
///     shoal::sim_tick_t tick;
///     while (client.next_tick(tick)) {
///       client.publish("auv1.drive.cmd", shoal::encode(command));
///       client.acknowledge(tick);
///     }
///
/// The world waits between a tick and its acknowledgement.  Payloads that are no valid ticks or replies are
/// ignored; a handler that decodes with shoal::decode() should catch shoal::MessageError, which else leaves
/// next_tick().
class LockstepClient {
 public:
  using Handler = std::function<void(std::span<const std::byte>)>;
  enum class End { none, last_tick, stopped, silence };

  /// Throws BusError when LCM cannot be used.
  LockstepClient(const std::string& url, std::string name);

  /// Also from a handler, which then sees the messages after its own.
  void subscribe(const std::string& channel, Handler handler);
  /// At once, so it is out before the acknowledgement that follows.  Throws BusError when LCM refuses it.
  void publish(std::string_view channel, std::span<const std::byte> payload);
  /// Asks for a tick every `period_s` of simulated time.  Throws BusError with the simulator's text when it
  /// refuses, when it does not answer in time, and when stop() is called.
  void join(double period_s, std::chrono::milliseconds timeout);
  /// Calls the handlers in the order of arrival until a tick names this client.  False at the end of the run
  /// (its last tick is acknowledged here), when stop() was called, or after `silence_limit` without any
  /// message.
  bool next_tick(shoal::sim_tick_t& tick);
  void acknowledge(const shoal::sim_tick_t& tick);
  /// Tells the simulator not to wait for this client any more; does not wait for the answer.
  void leave();
  /// Calls the handlers of the next message, whatever it is: for who does not take part in the lockstep.  False when
  /// stop() was called, or after `silence_limit`.
  bool handle_message() { return next_handled().has_value(); }
  /// From a signal handler or another thread.
  void stop() { stop_ = true; }
  /// Why next_tick() or handle_message() returned false.
  End end() const { return end_; }
  /// Zero: wait for ever.
  void set_silence_limit(std::chrono::milliseconds limit) { silence_limit_ = limit; }

 private:
  /// Waits in slices, so that stop() is seen.
  std::optional<Received> wait(std::chrono::steady_clock::time_point deadline);
  /// The next message, after its handlers were called.
  std::optional<Received> next_handled();
  /// A tick for us that is new.
  std::optional<shoal::sim_tick_t> as_new_tick(const Received& message);
  void request(const std::string& command, std::int32_t id, double value);

  LcmListener lcm_;
  std::string name_;
  // Handlers may subscribe: a deque grows without moving the one that is called.
  std::map<std::string, std::deque<Handler>, std::less<>> handlers_;
  std::deque<Received> early_;  // came while joining
  std::int32_t request_id_ = 0;
  std::optional<std::int64_t> acknowledged_utime_;
  std::atomic<bool> stop_ = false;
  End end_ = End::none;
  std::chrono::milliseconds silence_limit_{30'000};
  static_assert(std::atomic<bool>::is_always_lock_free, "stop() is called from signal handlers");
};

}  // namespace bridges
