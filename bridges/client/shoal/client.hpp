// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
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

/// Error of a bus that cannot be used, or of a simulator that refuses or does not answer; the text has the reason and
/// the remedy.
class ClientError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Channels of a device of a vehicle.
struct DeviceChannels {
  std::string type;           ///< of the device, such as `planar_lidar`
  std::string reports;        ///< channel of its reports; empty: none
  std::string report_type;    ///< such as `shoal.planar_lidar_t`
  double rate_hz = 0;         ///< of the reports; 0: every step
  std::string commands;       ///< channel of commands to it; empty: none
  std::string command_types;  ///< comma separated
};

/// Connection of an autonomy program to its vehicle, in one thread:
///
///     shoal::Client client("pilot");
///     client.subscribe<shoal::dvl_t>("auv1.dvl", [&](const shoal::dvl_t& dvl) { ... });
///     client.join(0.1);
///     while (client.next_tick()) client.publish("auv1.autopilot.cmd", command);
///
/// Handlers are called in next_tick() and wait_until() only: in lockstep for all messages up to the tick, in the
/// order in which they were published, independent of losses and duplicates in the network; otherwise in the order of
/// arrival.  An invalid payload is counted, reported once per channel on standard error, and not handled; the same
/// holds for one whose handler throws MessageError.  Any other exception of a handler propagates out of the waiting
/// call. Handlers may publish and subscribe.
class Client {
 public:
  /// Reason why next_tick() returned std::nullopt.
  enum class End {
    none,       ///< the run continues
    last_tick,  ///< the simulator ended the run
    stopped,    ///< stop() was called
    silence,    ///< no message arrived within the silence limit
    rewound,    ///< the world was rewound, and there is no on_rewind()
    dropped,    ///< the world continued without this client, which had not answered in time; see reason()
    left,       ///< leave() was called
  };
  /// Policy for the case that the client does not answer.
  struct JoinOptions {
    std::string on_timeout;  ///< wait, pause (the world pauses), continue (without the client), end (the run); "": as
                             ///< in the world file
    double timeout_s = 0;    ///< wall time; 0: as in the world file
    std::chrono::milliseconds timeout = std::chrono::seconds(30);  ///< maximum time to wait for a simulator
  };
  /// Numbers of messages since the client was made.
  struct Counts {
    std::uint64_t received = 0;   ///< messages on subscribed channels
    std::uint64_t bad = 0;        ///< received messages that were refused
    std::uint64_t published = 0;  ///< messages published
    std::uint64_t requested = 0;  ///< in lockstep: lost messages that were received on request
    std::uint64_t repeated = 0;   ///< in lockstep: duplicate messages
  };
  /// Handler of an encoded payload.
  using BytesHandler = std::function<void(std::span<const std::byte>)>;

  /// `name`: name of the program, under which the simulator waits for it.  `lcm_url` "": LCM_DEFAULT_URL, or the
  /// default of LCM.  Throws ClientError when LCM cannot be used with this URL.
  explicit Client(const std::string& name, const std::string& lcm_url = {});
  /// Leaves the lockstep, so that the world does not wait for a program that has ended.
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Calls `handler(const Message&)` for each message of this channel.  `numbers`: whether NaN and infinity are
  /// refused; many reports have NaN for values that were not measured.
  template <class Message, class Handler>
  void subscribe(const std::string& channel, Handler handler, Finite numbers = Finite::any) {
    subscribe_bytes(channel, [handler = std::move(handler), numbers](std::span<const std::byte> payload) mutable {
      handler(shoal::decode<Message>(payload, numbers));
    });
  }
  /// Calls `handler` with the encoded payload of each message of this channel.
  void subscribe_bytes(const std::string& channel, BytesHandler handler);

  /// Publishes a message immediately; in lockstep, messages published before the first tick are delayed until that
  /// tick.  Throws MessageError when the size of an array differs from its length member, ClientError when LCM refuses
  /// the message.
  template <class Message>
  void publish(std::string_view channel, const Message& message) {
    encode_into(message, buffer_);
    publish_bytes(channel, buffer_);
  }
  /// Publishes an encoded payload; see publish().
  void publish_bytes(std::string_view channel, std::span<const std::byte> payload);

  /// Joins the lockstep: the world waits for this client at a tick every `period_s` of simulated time, a multiple of
  /// its step.  Throws ClientError with the reason when the simulator refuses, when none answers within `timeout` of
  /// wall time, and when stop() is called meanwhile.
  void join(double period_s, std::chrono::milliseconds timeout = std::chrono::seconds(30));
  /// Joins with a policy for the case that this client does not answer in time; see JoinOptions.
  void join(double period_s, const JoinOptions& options);
  /// Follows a run without lockstep: the world does not wait.  next_tick() then returns when sim.clock passes a
  /// multiple of `period_s`; sim.clock is published at the `state_rate_hz` of the world, 10 Hz by default.
  void follow(double period_s);

  /// Calls `after_batch` without lockstep whenever all messages that have arrived are handled, before the client waits:
  /// for a program that passes on together what comes together.  Its handlers must return at once.
  void handle_in_batches(std::function<void()> after_batch);
  /// Waits for the next tick, and returns its simulated time in microseconds.  In lockstep it first acknowledges the
  /// previous tick: messages published since then take effect in the next step.  All reports up to the tick have been
  /// handled (without lockstep: those received so far).  Returns std::nullopt if the run is over, also on further
  /// calls: see end().  Throws std::logic_error before join() and follow().
  std::optional<std::int64_t> next_tick();
  /// Handles ticks up to the first one at or after `utime`, and returns its time as next_tick() does.
  std::optional<std::int64_t> wait_until(std::int64_t utime);

  /// Spawns a vehicle in a world in lockstep: `text` is YAML, an entry of `vehicles:`, with the whole vehicle as
  /// `model` or a `file`; with `with_client: true` the vehicle is removed with this client.  Returns the channels of
  /// its devices by name.  The world waits: the vehicle is there when the present tick is answered, or the next one
  /// between ticks. Requests of clients in one step are carried out in the order of their names, so that the run is
  /// repeatable. Throws ClientError with the reason when the simulator refuses, when the run ends, and when no reply
  /// comes within `timeout` of wall time, as the world may wait for another client; std::logic_error before join().
  std::map<std::string, DeviceChannels> spawn(const std::string& text,
                                              std::chrono::milliseconds timeout = std::chrono::seconds(30));
  /// Leaves the lockstep: answers the present tick, and leaves at the next one, in the order of client names, so that
  /// the run is repeatable.  Vehicles of spawn() with `with_client: true` are removed.  When that tick does not come
  /// within `timeout` of wall time, the client leaves without it, as on destruction.
  void leave(std::chrono::milliseconds timeout = std::chrono::seconds(30));

  /// Makes next_tick() return, permanently.  May be called from a signal handler or another thread.
  void stop() noexcept;
  /// Returns why the run is over for this client; End::none while it continues.
  End end() const;
  /// Returns the reason given by the simulator when it dropped this client.
  const std::string& reason() const;
  /// Sets why the client leaves before the end of the run, such as the text of an exception; the simulator warns with
  /// it.  Empty: as planned, without a warning.
  void set_reason_to_leave(const std::string& reason);
  /// Sets the handler of rewinds.  `handler(utime)` is called in next_tick() when the world was rewound, before any
  /// message of the new branch is handled; held messages are dropped.  Without a handler next_tick() then returns
  /// std::nullopt.
  void on_rewind(std::function<void(std::int64_t utime)> handler);
  /// Returns the number of rewinds before the present tick.
  std::int32_t branch() const;
  /// Sets the maximum wall time without any message; zero: unlimited.  10 minutes by default, because the world may be
  /// paused.
  void set_silence_limit(std::chrono::milliseconds limit);
  /// Sets the delay of the warning about a missing simulator.  When join() waits for an answer, or next_tick() for the
  /// first tick or for sim.clock, longer than `after` of wall time, one line on standard error names the expected
  /// message, channel and LCM URL.  3 s by default; zero: no warning.
  void set_wait_warning(std::chrono::milliseconds after);
  /// Returns the numbers of messages since the client was made.
  Counts counts() const;

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
  std::vector<std::byte> buffer_;
};

}  // namespace shoal
