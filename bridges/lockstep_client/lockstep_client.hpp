// SPDX-License-Identifier: BSD-3-Clause
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
#include "bridges/lockstep_client/client_inbox.hpp"
#include "bridges/lockstep_client/client_outbox.hpp"
#include "bridges/lockstep_client/wait_warning.hpp"
#include "bridges/signing/signed_message.hpp"
#include "shoal/sim_tick_t.hpp"
#include "shoal/sim_vehicle_t.hpp"
#include "sim/run/lockstep.hpp"

namespace bridges {

/// Client for an autonomy program that runs in lockstep with the simulator, in one thread:
///
///     LockstepClient client("", "pilot");
///     client.subscribe("auv1.lidar", on_lidar);
///     client.join(0.1, 5s);
///     shoal::sim_tick_t tick{};
///     while (client.next_tick(tick)) {
///       client.publish("auv1.drive.cmd", shoal::encode(command));
///       client.acknowledge(tick);
///     }
///
/// The world waits between a tick and its acknowledgement.  Messages are held until the tick that lists them, and
/// then handled in the order of that list; missing ones are requested.  The behavior of a client is therefore
/// independent of losses, duplicates and reordering in the network; docs/develop/lockstep_protocol.md describes the
/// protocol.
/// Payloads that are not valid ticks or replies are ignored; a handler that decodes with shoal::decode() should catch
/// shoal::MessageError, which otherwise propagates out of next_tick().
class LockstepClient {
 public:
  using Handler = std::function<void(std::span<const std::byte>)>;
  enum class End {
    none,
    last_tick,
    stopped,
    silence,
    rewound,  ///< the world was rewound, and no handler was set by on_rewind()
    dropped,  ///< the world continued without this client; see reason()
  };
  struct JoinOptions {
    std::optional<sim::OnTimeout> on_timeout;  ///< unset: as in the world file
    double timeout_s = 0;                      ///< wall time; 0: as in the world file
  };
  using Counts = ClientInbox::Counts;

  /// Signs messages that control the run when SHOAL_RUN_KEY contains its key.  Throws BusError when LCM cannot be used,
  /// or when that variable is invalid.
  LockstepClient(const std::string& url, std::string name);

  /// Subscribes to a channel.  May be called from a handler; the new handler then receives the messages after the
  /// present one.
  void subscribe(const std::string& channel, Handler handler);
  /// Publishes a message immediately, so that it precedes the acknowledgement that follows; between an acknowledgement
  /// and the next tick it is delayed until that tick.  Throws BusError when LCM refuses it.
  void publish(std::string_view channel, std::span<const std::byte> payload);
  /// Joins the lockstep with a tick every `period_s` of simulated time.  Throws BusError with the reason when the
  /// simulator refuses, when it does not answer in time, and when stop() is called.
  void join(double period_s, std::chrono::milliseconds timeout, const JoinOptions& options);
  void join(double period_s, std::chrono::milliseconds timeout) { join(period_s, timeout, JoinOptions{}); }
  /// Waits for the tick of this client, and for all messages that it names, and calls their handlers.  Returns false at
  /// the end of the run (its last tick is acknowledged here), when stop() was called, after `silence_limit` without any
  /// message, and in the other cases of End.
  bool next_tick(shoal::sim_tick_t& tick);
  void acknowledge(const shoal::sim_tick_t& tick);
  /// Acknowledges the open tick, and requests to leave the lockstep, for a reason that is reported unless it is empty.
  /// Waits briefly for the confirmation.
  void leave(const std::string& reason = {});
  /// Answers the open tick, and leaves at the next one, which makes the step at which it leaves independent of the
  /// network.  Leaves as leave() does when that tick does not arrive in time, and when the run is over.
  void leave_at_next_tick(const std::string& reason, std::chrono::milliseconds timeout);
  /// Requests a vehicle (`text`: YAML, an entry of `vehicles:`) in the open tick, or the next one when none is open,
  /// and returns its report.  Throws BusError with the reason when the simulator refuses, when it does not answer in
  /// time, when the run is over, and when stop() is called.
  shoal::sim_vehicle_t spawn(const std::string& text, std::chrono::milliseconds timeout);
  /// Follows a run without lockstep: handle_message() requests to be listed in the last tick of the run, again for each
  /// run that is followed.
  void follow();
  /// As LcmListener::take_in_batches(), for a program without lockstep.
  void take_in_batches(std::function<void()> before_wait) { lcm_.take_in_batches(std::move(before_wait)); }
  /// Waits for the next message and calls its handlers, for a program without lockstep.  Returns false when stop() was
  /// called, after `silence_limit`, and after follow() at the end of the run.
  bool handle_message();
  /// Sets the handler of rewinds, which is called before the messages of the first tick of the new branch.
  void on_rewind(std::function<void(const shoal::sim_tick_t&)> handler) { rewound_ = std::move(handler); }
  std::int32_t branch() const { return branch_; }
  /// Stops the client.  May be called from a signal handler or another thread.
  void stop() { stop_ = true; }
  /// Returns why next_tick() or handle_message() returned false.
  End end() const { return end_; }
  /// Returns the reason given by the simulator when it dropped this client.
  const std::string& reason() const { return reason_; }
  const Counts& counts() const { return inbox_.counts(); }
  /// Sets the maximum wall time without any message; zero: unlimited.
  void set_silence_limit(std::chrono::milliseconds limit) { silence_limit_ = limit; }
  /// Sets the wall time without an answer to join(), a first tick, or the message of wait_for(), after which a warning
  /// on standard error names what is missing.  3 s by default; zero: no warning.
  void set_warning_after(std::chrono::milliseconds after) { warning_after_ = after; }
  /// Starts the wait for `what`, a channel with its reason, until mark_received().
  void wait_for(const std::string& what);
  void mark_received() { wait_warning_.reset(); }

 private:
  using Clock = std::chrono::steady_clock;
  /// Tick with messages that have not all arrived.
  struct Incomplete {
    shoal::sim_tick_t tick{};
    std::int64_t sequence;
    Clock::time_point ask_at;
    std::chrono::milliseconds interval;
  };

  /// Waits for a message in short intervals, so that stop() takes effect.
  std::optional<Received> wait(Clock::time_point deadline, bool heed_stop = true);
  /// Sends a request repeatedly until it is answered, and `is_complete` returns true.  Throws BusError.
  void request(
      const std::string& command, double value, const std::string& text, Clock::time_point deadline,
      const std::function<bool()>& is_complete = [] { return true; });
  /// Waits until a tick is open, or has arrived.  Returns false when none arrives in time, and when the session is
  /// over.
  bool await_tick(Clock::time_point deadline);
  bool is_last_tick() const { return incomplete_ && incomplete_->tick.last != 0; }
  void request_leave(const std::string& reason, Clock::time_point deadline);
  void send_request(const std::string& command, std::int32_t id, double value, const std::string& text);
  void request_join(Clock::time_point deadline);
  void request_end_notification();
  void call_handlers(const std::string& channel, std::span<const std::byte> payload);

  void take(Received message);
  void take_tick(std::span<const std::byte> payload);
  void take_reply(std::span<const std::byte> payload);
  void take_request(std::span<const std::byte> payload);
  void take_bundle(std::span<const std::byte> payload);
  void take_vehicle(std::span<const std::byte> payload);
  void start_tick(shoal::sim_tick_t tick, const shoal::sim_due_t& due);
  bool rewind(const shoal::sim_tick_t& tick);
  void request_when_due();
  void handle_tick();
  void send(std::string_view channel, std::span<const std::byte> payload);
  void send_ack();

  LcmListener lcm_;
  std::string name_;
  std::optional<MessageSigner> signer_;  ///< unset: messages are not signed
  std::int64_t session_;
  double period_s_ = 0;
  JoinOptions options_;
  // Handlers may subscribe: a deque grows without moving the handler that is being called.
  std::map<std::string, std::deque<Handler>, std::less<>> handlers_;
  ClientInbox inbox_;
  ClientOutbox outbox_;
  std::size_t channels_reported_ = 0;  // number of channels reported to the simulator
  bool joined_ = false;
  std::int32_t request_id_ = 0, join_id_ = 0;
  std::optional<std::int32_t> answered_id_;
  std::string refusal_;  // reason of the refusal of the request; empty: granted
  std::string granted_;  // text of the reply that grants it
  bool hears_vehicles_ = false;
  std::map<std::string, shoal::sim_vehicle_t, std::less<>> spawned_;  // by name, since the last spawn()

  bool following_ = false;
  int requests_left_ = 0;  // for notification of the end of the followed run
  Clock::time_point ask_at_;
  Clock::time_point asked_;  // when the simulator last requested messages of this client
  std::chrono::milliseconds request_interval_{0};

  std::optional<Incomplete> incomplete_;
  std::int64_t sequence_ = 0;  // sequence of the last handled tick
  shoal::sim_tick_t tick_{};
  std::function<void(const shoal::sim_tick_t&)> rewound_;
  std::int32_t branch_ = 0;

  std::atomic<bool> stop_ = false;
  End end_ = End::none;
  std::string reason_;
  std::chrono::milliseconds silence_limit_{30'000};
  std::chrono::milliseconds warning_after_ = WaitWarning::default_delay;
  std::optional<WaitWarning> wait_warning_;
  static_assert(std::atomic<bool>::is_always_lock_free, "stop() is called from signal handlers");
};

}  // namespace bridges
