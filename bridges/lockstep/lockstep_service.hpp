// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridges/lockstep/answer_history.hpp"
#include "bridges/lockstep/channel_use.hpp"
#include "bridges/lockstep/client_requests.hpp"
#include "bridges/lockstep/control_guard.hpp"
#include "bridges/lockstep/own_pause.hpp"
#include "bridges/lockstep/record_gaps.hpp"
#include "shoal/sim_ack_t.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "sim/bus/bus.hpp"
#include "sim/bus/message_gate.hpp"
#include "sim/run/client_messages.hpp"
#include "sim/run/lockstep.hpp"
#include "sim/run/run_control.hpp"
#include "sim/world/world.hpp"

namespace bridges {

/// Summary of a client in the lockstep of a run.
struct LockstepSummary {
  std::string client;
  std::int64_t ticks = 0;
  std::int64_t repeated_ticks = 0;      ///< ticks sent again because there was no answer
  std::int64_t messages_resent = 0;     ///< messages sent again to the client because it had not received them
  std::int64_t messages_requested = 0;  ///< messages requested from the client because they had not arrived
  std::int64_t messages_repeated = 0;   ///< dropped messages that were equal to an earlier one of the client
  std::int64_t timeouts = 0;
  std::int64_t contradictions = 0;  ///< answers that differ from its first answer to the same tick
  std::string ended;                ///< reason why it left; empty: in the lockstep until the end
  double ended_s = 0;               ///< simulated time of that
};

/// Error when a lockstep client did not answer in time, which ends the run.
class LockstepTimeout : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class LockstepOutcome {
  done,
  stopped,  ///< `idle` returned false, or the run ends; the next call continues with the same step
};

/// Bus on which clients of the lockstep may be.
struct LockstepBus {
  sim::Bus& network;  ///< bus behind `gate`; the handshake uses it directly, so that records exclude it
  sim::MessageGate& gate;
  std::string name = {};     ///< empty: bus of the world, which is the first
  bool is_recorded = false;  ///< what clients list is admitted, and so recorded, on channels without a reader as well
};

/// Lockstep protocol on the buses: sends sim.tick, receives sim.ack, and requests and repeats messages on sim.resend
/// and sim.resent, so that neither a tick nor a message between world and client is lost.  See
/// docs/develop/lockstep_protocol.md.
///
/// It connects parts that each know one side of the protocol.  sim::Lockstep knows the members, their periods, and what
/// each must get with its next tick; it knows neither time nor buses.  A Link is a bus: its mailboxes for the
/// handshake, and sim::ClientMessages, which puts what clients have published at the gate in the order of their
/// answers.  Requests of clients that change the world wait in ClientRequests until all who are due have spoken, so
/// that their order does not depend on the network.  AnswerHistory finds contradictory answers, ControlGuard checks
/// signatures, OwnPause and RecordGaps keep what on_timeout and the record need.
///
/// synchronize() is a loop over the clients that are late: tick those that have no tick of this step, ask those again
/// whose answers or messages are missing, at growing intervals, and check their time-outs by Pending; in between it
/// waits for the network, and `idle` lets the run answer requests.  Members come and go while it waits, by join() and
/// leave(), which SimService calls for requests on sim.control: nothing may be kept from before a call of `idle`.
/// After a rewind set_branch() forgets what was asked for on the old branch; a client that has not answered a tick of
/// it gets that tick until it has, and only then those of the new branch.
class LockstepService {
 public:
  /// Flushes published messages, and waits for messages up to the given time, or returns earlier.
  using Wait = std::function<void(std::chrono::milliseconds)>;

  /// Takes the defaults from `lockstep` of the world file.  All arguments must outlive this.  `posts_messages` false:
  /// messages from outside are not listed for clients; for the playback of a record, which contains them.
  LockstepService(sim::World& world, sim::RunControl& control, const std::vector<LockstepBus>& buses = {},
                  bool posts_messages = true);
  LockstepService(const LockstepService&) = delete;
  LockstepService& operator=(const LockstepService&) = delete;
  ~LockstepService();

  /// Returns the name of a link for messages: `the world's bus`, or `bus 'NAME'`.
  const std::string& called(int link) const;
  /// Returns whether a client on a link must receive every message of this channel.
  bool has_receiver(std::string_view channel, int link = 0) const { return lockstep_.has_receiver(link, channel); }
  /// Sets a callback with the name of each client that answers on the bus of the world.
  void set_on_answer(std::function<void(const std::string&)> on_answer) { on_answer_ = std::move(on_answer); }

  /// Returns the guard, which checks lockstep messages and should check all others that control the run.
  ControlGuard& guard() { return guard_; }
  /// Callback when a second answer of a client to a tick differs from the first, with the client, the signer of the
  /// second answer, and a description of the difference.
  using Contradiction = std::function<void(const std::string& client, const std::string& signer, const std::string&)>;
  void set_on_contradiction(Contradiction contradiction) { contradiction_ = std::move(contradiction); }

  /// Handles a join.  Returns false when it is undecided and must not be answered; the client repeats the request.
  /// Throws std::runtime_error with the reason of a refusal.
  bool join(int link, const shoal::sim_control_request_t& request);
  /// Handles a leave.  Returns false as join().  Throws std::runtime_error when there is no such client on this link.
  bool leave(int link, const shoal::sim_control_request_t& request);
  /// Handles a follow: the last tick will list a program that is not in the lockstep.  Throws std::runtime_error with
  /// the reason of a refusal.
  void follow(int link, const shoal::sim_control_request_t& request);
  /// Returns whether a request waits for its turn in requests(): one of a client on this link that changes the world,
  /// or by which it leaves in place of an answer to its open tick.
  bool takes_turns(int link, const shoal::sim_control_request_t& request) const;
  /// Requests that wait for their turn.
  ClientRequests& requests() { return requests_; }
  /// Removes and returns the request whose turn it is; none while a client that is due has no tick of this step, or
  /// neither a request nor an answer.
  std::optional<ClientRequests::Waiting> next_request();
  /// Returns whether the open tick of a client is of a branch that was left by a rewind.
  bool is_of_left_branch(const std::string& client) const;
  /// Handles the exit of the process of a client: executes the agreed time-out action immediately; without one the
  /// world continues.
  void client_exited(const std::string& client);
  /// Removes all clients, whose processes have been ended for this reason, and what they have sent.
  void remove_all(const std::string& why);
  bool has(const std::string& client) const { return lockstep_.has(client); }
  /// Returns whether a client is in the lockstep on this link.
  bool has(const std::string& client, int link) const;
  /// Returns whether a client has left the lockstep, or leaves it at its turn; false when it is in it, was dropped, or
  /// never joined.
  bool has_left(const std::string& client) const;
  /// Returns the reason that a client gave when it left; empty: it gave none, or has not left.
  std::string reason_to_leave(const std::string& client) const;
  /// Returns the simulated time at which the client was last removed; 0: it never was.
  double end_s(const std::string& client) const;
  bool empty() const { return lockstep_.empty(); }
  /// Returns the names of the clients in the lockstep, in order, separated by commas.
  std::string names() const;
  /// Returns the client that the world waits for, as `waits 1.5 s for 'pilot'`; empty: none.
  std::string waits_for();
  /// Updates the time-outs; must be called periodically, even while the world is paused.
  void check_clock();

  /// Posts a message that was sent on a link without its gate, for the clients that must receive it.
  void post(int link, std::string_view channel, std::span<const std::byte> payload) {
    lockstep_.post(link, channel, payload);
  }
  /// Runs stage 8 of a step: sends the tick to the clients that are due, and waits until they have answered and all
  /// messages they published have arrived.  `idle` is called while waiting to handle requests, and ends the wait by
  /// returning false.  Throws LockstepTimeout.
  LockstepOutcome synchronize(const Wait& wait, const std::function<bool()>& idle);
  /// Notifies clients of the end of the run, for up to `limit` of wall time until all have confirmed.
  void publish_end(const Wait& wait, std::chrono::milliseconds limit);

  /// Starts another branch after a rewind to the present step.
  void set_branch(std::int32_t branch);
  std::int32_t branch() const { return branch_; }
  /// Suspends the service during a replay: messages at the gates then keep their order, and together with the reports
  /// of the world form the lists of the step to which the world is rewound.
  void suspend(bool suspended);
  /// See sim::Lockstep.
  void pass_again(std::int64_t step) { lockstep_.pass(step); }
  std::int64_t needed_from(std::int64_t step, std::int64_t max_steps) const {
    return lockstep_.needed_from(step, max_steps);
  }
  /// Returns the number of bad acknowledgements and requests.
  std::int64_t bad_messages() const { return bad_messages_; }
  /// Returns the number of messages from outside dropped from full queues before they were admitted.
  std::uint64_t dropped_messages() const;
  /// Returns the summaries by name, including former clients, up to 2000.
  std::vector<LockstepSummary> summaries() const;
  /// Returns what clients published and the record lacks, as RecordGaps::phrases().  Only with recorded buses.
  std::vector<std::string> not_recorded() const { return record_gaps_.phrases(); }

  /// Returns what the clients did with each channel, including former clients.
  ChannelUse channel_use() const;

  /// Maximum number of channels of a bus that are open only for the record.
  static constexpr std::size_t max_recorded_only = 1000;

 private:
  using Clock = std::chrono::steady_clock;
  struct Link;
  /// Client that the world waits for.
  struct Pending {
    Clock::time_point since;
    Clock::time_point begin;  ///< start of its time-out: `since` plus the time for which the world was paused
    Clock::time_point send_at, serve_after;
    std::chrono::milliseconds interval;
    bool reported = false;     ///< whether its delay was reported
    bool awaits_turn = false;  ///< whether a request of it waited at the last look
    int extensions = 0;        ///< of its time-out, by requests that waited for no other client
  };
  /// Check whether a client is alive, because another one requests its name.
  struct Challenge {
    Clock::time_point since, ask_at;
    bool is_alive = false;
  };
  /// Dropped client, which is notified when it answers late.
  struct Dropped {
    std::int64_t session = 0;
    std::int32_t join_id = 0;
    int link = 0;
    std::string why;
  };
  /// Program that follows the run without lockstep.
  struct Follower {
    std::string name;
    std::int64_t session;
    int link;
  };

  /// Returns whether this session of the client has ended.
  bool is_over(const std::string& client, std::int64_t session) const;
  void check_session(const std::string& client, std::int64_t session) const;
  void add_link(const LockstepBus& bus);
  bool may_join(const sim::LockstepMember& first, const sim::LockstepTerms& terms);
  void probe_client(const sim::LockstepMember& member);
  void drop_overflowing();
  std::vector<std::string> late();
  void serve(const std::vector<std::string>& late);
  void check_time(const std::string& client, Pending& requested, Clock::time_point now);
  void drop(const std::string& client, const std::string& why);
  void end_summary(const std::string& client, const std::string& why);
  void discard(const std::string& client, const std::string& why);
  void report_who_left(const sim::LockstepMember& member, int link, const sim::LeaveTerms& terms);
  void notify_dropped(const Dropped& dropped, const std::string& client);

  void rest_time_outs(Clock::time_point now);
  void report_repeated();
  /// Describes the missing messages of a client that has answered.
  std::string what_is_missing(const sim::LockstepMember& member);
  /// Throws std::runtime_error when the client is in the lockstep on another link.
  void check_link(int link, const std::string& client, const char* does) const;
  void publish_tick(const std::vector<std::string>& clients, bool last);
  void publish_left_tick(const sim::LockstepMember& member);
  void request_from_client(const sim::LockstepMember& member);
  void take_messages();
  void take_ack(int link, const sim::Message& message);
  /// Opens the channels of an answer that the world does not read, for other clients and for the record.
  void open_channels(int link, const shoal::sim_ack_t& ack);
  bool is_only_recorded(int link, std::string_view channel) const;
  /// Notes for each channel of an answer whether something besides the record reads it.
  void note_use(int link, const shoal::sim_ack_t& ack);
  /// Continues without the missing messages of a client when only the record needs them; otherwise returns false.
  bool do_without(const sim::LockstepMember& member);
  /// Stops waiting for the missing messages of a client.
  void give_up(const sim::LockstepMember& member);
  void take_request(int link, const sim::Message& message);
  void take_bundle(int link, const sim::Message& message);
  void compare_answers(const shoal::sim_ack_t& ack, const std::string& signer);
  void send_again(const sim::LockstepMember& member, std::int32_t first);
  void warn_client(const std::string& client, const std::string& text);
  void watch_gates();
  std::chrono::milliseconds nap(const std::vector<std::string>& late) const;
  std::int64_t utime() const { return world_.epoch_us() + world_.now().count(); }
  LockstepSummary& summary_of(const std::string& client);
  Link& link_of(int number) { return *links_[static_cast<std::size_t>(number)]; }
  const Link& link_of(int number) const { return *links_[static_cast<std::size_t>(number)]; }

  sim::World& world_;
  sim::RunControl& control_;
  sim::LockstepTerms defaults_;
  sim::Lockstep lockstep_;
  std::vector<std::unique_ptr<Link>> links_;
  std::map<std::string, Pending, std::less<>> pending_;  // clients awaited in the present step
  std::map<std::string, Dropped, std::less<>> dropped_;
  std::map<std::string, std::int32_t, std::less<>> join_ids_;
  std::map<std::string, Challenge, std::less<>> challenges_;
  std::deque<std::pair<std::string, std::int64_t>> ended_;  // most recent ended clients and sessions
  std::deque<Follower> followers_;                          // most recent ones
  Clock::time_point served_, window_start_;
  Clock::time_point taken_;  ///< what came before has been taken
  bool warned_repeated_ = false;
  int reported_left_ = 0;
  std::map<std::string, LockstepSummary, std::less<>> summaries_;
  std::set<std::string, std::less<>> warned_;  // clients with reported bad messages
  std::function<void(const std::string&)> on_answer_;
  ControlGuard guard_;
  ClientRequests requests_;
  std::map<std::string, AnswerHistory, std::less<>> answers_;  // of the clients in the lockstep
  Contradiction contradiction_;
  RecordGaps record_gaps_;
  ChannelUse use_;  // published by all clients, subscribed by former ones
  OwnPause own_pause_;
  bool suspended_ = false;
  const bool posts_messages_;
  std::int32_t branch_ = 0;
  std::int64_t bad_messages_ = 0;
};

}  // namespace bridges
