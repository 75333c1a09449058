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
#include "sim/run/lockstep.hpp"

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
/// The world waits between a tick and its acknowledgement.  Messages are held until the tick that lists them, and
/// then handled in the order of that list; missing ones are requested.  So a client does the same whatever
/// the network loses, repeats or puts in another order; docs/guides/lockstep.md has the protocol.  Payloads that are
/// not valid ticks or replies are ignored; a handler that decodes with shoal::decode() should catch
/// shoal::MessageError, which else leaves next_tick().
class LockstepClient {
 public:
  using Handler = std::function<void(std::span<const std::byte>)>;
  enum class End {
    none,
    last_tick,
    stopped,
    silence,
    rewound,  ///< the world went back, and on_rewind() was not called before
    dropped,  ///< the world continued without this client; see reason()
  };
  struct JoinOptions {
    std::optional<sim::OnTimeout> on_timeout;  ///< unset: the world's choice
    double timeout_s = 0;                      ///< wall time; 0: the world's
  };
  using Counts = ClientInbox::Counts;

  /// Signs what controls the run when SHOAL_RUN_KEY has its key.  Throws BusError when LCM cannot be used, or when that
  /// variable has something else.
  LockstepClient(const std::string& url, std::string name);

  /// Also from a handler, which then sees the messages after its own.
  void subscribe(const std::string& channel, Handler handler);
  /// At once, so it is out before the acknowledgement that follows; between an acknowledgement and the next tick it
  /// waits for that tick.  Throws BusError when LCM refuses it.
  void publish(std::string_view channel, std::span<const std::byte> payload);
  /// Asks for a tick every `period_s` of simulated time.  Throws BusError with the simulator's text when it
  /// refuses, when it does not answer in time, and when stop() is called.
  void join(double period_s, std::chrono::milliseconds timeout, const JoinOptions& options);
  void join(double period_s, std::chrono::milliseconds timeout) { join(period_s, timeout, JoinOptions{}); }
  /// Waits for the tick of this client, and for all messages that it names, and calls their handlers.  False at the
  /// end of the run (its last tick is acknowledged here), when stop() was called, after `silence_limit` without any
  /// message, and for what End says.
  bool next_tick(shoal::sim_tick_t& tick);
  void acknowledge(const shoal::sim_tick_t& tick);
  /// Acknowledges the tick that is open, and asks the simulator to stop waiting for this client.  Waits for a
  /// moment until it knows.
  void leave();
  /// For a program that does not take part in the lockstep: asks the simulator, from handle_message(), to be listed in
  /// the last tick of its run.  Again for each run that is followed.
  void follow();
  /// Calls the handlers of the next message: for a program that does not take part in the lockstep.
  /// False when stop() was called, after `silence_limit`, and after follow() at the end of the run.
  bool handle_message();
  /// `handler` is called when the world went back, before the messages of the first tick there.
  void on_rewind(std::function<void(const shoal::sim_tick_t&)> handler) { rewound_ = std::move(handler); }
  std::int32_t branch() const { return branch_; }
  /// From a signal handler or another thread.
  void stop() { stop_ = true; }
  /// Why next_tick() or handle_message() returned false.
  End end() const { return end_; }
  /// The simulator's words, when it dropped this client.
  const std::string& reason() const { return reason_; }
  const Counts& counts() const { return inbox_.counts(); }
  /// Zero: wait forever.
  void set_silence_limit(std::chrono::milliseconds limit) { silence_limit_ = limit; }
  /// Wall time without an answer to join(), a first tick, or the message of wait_for(), after which a warning on
  /// standard error names what is missing.  3 s unless set; zero: never.
  void set_warning_after(std::chrono::milliseconds after) { warning_after_ = after; }
  /// `what`, a channel with its reason, is waited for from now on, until mark_received().
  void wait_for(const std::string& what);
  void mark_received() { wait_warning_.reset(); }

 private:
  using Clock = std::chrono::steady_clock;
  /// The tick that this client waits to have all messages of.
  struct Incomplete {
    shoal::sim_tick_t tick;
    std::int64_t sequence;
    Clock::time_point ask_at;
    std::chrono::milliseconds interval;
  };

  /// Waits in slices, so that stop() is seen.
  std::optional<Received> wait(Clock::time_point deadline, bool heed_stop = true);
  /// Sends a request until it is answered; gives the text.  Throws BusError.
  void request(const std::string& command, double value, const std::string& text, Clock::time_point deadline,
               bool heed_stop);
  void send_request(const std::string& command, std::int32_t id, double value, const std::string& text);
  void request_join(Clock::time_point deadline);
  void request_end_notification();
  void call_handlers(const std::string& channel, std::span<const std::byte> payload);

  void take(Received message);
  void take_tick(std::span<const std::byte> payload);
  void take_reply(std::span<const std::byte> payload);
  void take_request(std::span<const std::byte> payload);
  void take_bundle(std::span<const std::byte> payload);
  void start_tick(shoal::sim_tick_t tick, const shoal::sim_due_t& due);
  bool rewind(const shoal::sim_tick_t& tick);
  void request_when_due();
  void handle_tick();
  void send(std::string_view channel, std::span<const std::byte> payload);
  void send_ack();

  LcmListener lcm_;
  std::string name_;
  std::optional<MessageSigner> signer_;  ///< unset: nothing is signed
  std::int64_t session_;
  double period_s_ = 0;
  JoinOptions options_;
  // Handlers may subscribe: a deque grows without moving the one that is called.
  std::map<std::string, std::deque<Handler>, std::less<>> handlers_;
  ClientInbox inbox_;
  ClientOutbox outbox_;
  std::size_t channels_reported_ = 0;  // number of channels that the simulator knows
  bool joined_ = false;
  std::int32_t request_id_ = 0, join_id_ = 0;
  std::optional<std::int32_t> answered_id_;
  std::string refusal_;  // of the request; empty: granted

  bool following_ = false;
  int requests_left_ = 0;  // for notification of the end of the followed run
  Clock::time_point ask_at_;
  std::chrono::milliseconds request_interval_{0};

  std::optional<Incomplete> incomplete_;
  std::int64_t sequence_ = 0;  // of the last tick that was handled
  shoal::sim_tick_t tick_;
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
