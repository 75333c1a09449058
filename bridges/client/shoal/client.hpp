// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "shoal/message_codec.hpp"

namespace shoal {

/// A bus that cannot be used, or a simulator that refuses or does not answer; the text says why and what to do.
class ClientError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The connection of an autonomy program to its vehicle, in one thread:
///
///     shoal::Client client("pilot");
///     client.subscribe<shoal::dvl_t>("auv1.dvl", [&](const shoal::dvl_t& dvl) { ... });
///     client.join(0.1);
///     while (client.next_tick()) client.publish("auv1.autopilot.cmd", command);
///
/// Handlers are called in next_tick() and wait_until() only: in lockstep for all messages up to the tick, in the
/// order in which they were published, independent of losses and duplicates in the network; otherwise in the order of
/// arrival.  An invalid payload is counted, reported once per channel on standard error, and not handled; the same
/// holds for one whose handler throws MessageError.  Any other exception of a handler leaves the call that waited.
/// Handlers may publish and subscribe.
class Client {
 public:
  /// Reason why next_tick() returned nothing.
  enum class End {
    none,       ///< the run continues
    last_tick,  ///< the simulator ended the run
    stopped,    ///< stop() was called
    silence,    ///< no message arrived within the silence limit
    rewound,    ///< the world was rewound, and there is no on_rewind()
    dropped,    ///< the world continued without this client, which had not answered in time; see reason()
  };
  /// What is to happen when the client does not answer.
  struct JoinOptions {
    std::string on_timeout;  ///< wait, pause (the world pauses), continue (without it), end (the run); "": the world's
    double timeout_s = 0;    ///< of wall time; 0: the world's
    std::chrono::milliseconds timeout = std::chrono::seconds(30);  ///< to wait for a simulator
  };
  /// Numbers of messages since the client was made.
  struct Counts {
    std::uint64_t received = 0;   ///< messages on channels that were subscribed to
    std::uint64_t bad = 0;        ///< of those, refused
    std::uint64_t published = 0;  ///< messages published
    std::uint64_t asked_for = 0;  ///< in lockstep: lost messages and received on request
    std::uint64_t repeated = 0;   ///< in lockstep: messages that came twice
  };
  /// Handler of an undecoded payload.
  using BytesHandler = std::function<void(std::span<const std::byte>)>;

  /// `name`: of the program, by which the simulator waits for it.  `lcm_url` "": LCM_DEFAULT_URL, then LCM's default.
  /// Throws ClientError when LCM cannot be used there.
  explicit Client(const std::string& name, const std::string& lcm_url = {});
  /// Leaves the lockstep, so that the world does not wait for a program that is gone.
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Calls `handler(const Message&)` for each message of this channel.  `numbers`: whether NaN and infinity are
  /// refused; many reports say NaN for what was not measured.
  template <class Message, class Handler>
  void subscribe(const std::string& channel, Handler handler, Finite numbers = Finite::any) {
    subscribe_bytes(channel, [handler = std::move(handler), numbers](std::span<const std::byte> payload) mutable {
      handler(shoal::decode<Message>(payload, numbers));
    });
  }
  /// The payload as it came.
  void subscribe_bytes(const std::string& channel, BytesHandler handler);

  /// At once; in lockstep what is published before the first tick waits for it.  Throws MessageError when an array is
  /// not as long as its length member says, ClientError when LCM refuses.
  template <class Message>
  void publish(std::string_view channel, const Message& message) {
    encode_into(message, buffer_);
    publish_bytes(channel, buffer_);
  }
  /// Publishes an encoded payload; see publish().
  void publish_bytes(std::string_view channel, std::span<const std::byte> payload);

  /// Lockstep: the world waits at a tick every `period_s` of simulated time, a multiple of its step.  Throws
  /// ClientError with the simulator's words when it refuses, when none answers within `timeout` of wall time, and when
  /// stop() is called meanwhile.
  void join(double period_s, std::chrono::milliseconds timeout = std::chrono::seconds(30));
  /// Joins with a policy for the case that this client does not answer in time; see JoinOptions.
  void join(double period_s, const JoinOptions& options);
  /// Free running: the world does not wait.  next_tick() then returns when sim.clock passes a multiple of `period_s`;
  /// sim.clock is published at the world's `state_rate_hz`, 10 Hz by default.
  void follow(double period_s);

  /// In lockstep this acknowledges the tick before: what was published since acts in the next step.  Waits for the next
  /// tick, and gives the simulator's time in microseconds.  Every report up to then has been handled (when not in
  /// lockstep: those received so far).  Nothing when the run is over, also on further calls: see end().  Throws
  /// std::logic_error before join() and follow().
  std::optional<std::int64_t> next_tick();
  /// Goes through the ticks up to the first one at or after `utime`.
  std::optional<std::int64_t> wait_until(std::int64_t utime);

  /// Makes next_tick() return, for good.  From a signal handler or another thread.
  void stop() noexcept;
  /// Reason why the run is over for this client; End::none while it continues.
  End end() const;
  /// What the simulator said when it dropped this client.
  const std::string& reason() const;
  /// `handler(utime)` is called in next_tick() when the world was rewound, before any message of the new branch is
  /// handled; held messages are dropped.  Without a handler next_tick() then returns nothing.
  void on_rewind(std::function<void(std::int64_t utime)> handler);
  /// How often the world went back before the present tick.
  std::int32_t branch() const;
  /// How much wall time may pass without any message; zero: forever.  10 minutes by default, as the world may be
  /// paused.
  void set_silence_limit(std::chrono::milliseconds limit);
  /// While join() waits for an answer, and next_tick() for the first tick or for sim.clock, longer than `after` of wall
  /// time, one line on standard error says what is waited for, on which channel and LCM URL.  3 s by default; zero:
  /// no warning.
  void set_wait_warning(std::chrono::milliseconds after);
  /// Numbers of messages so far.
  Counts counts() const;

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
  std::vector<std::byte> buffer_;
};

}  // namespace shoal
