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
#include "bridges/lockstep/control_guard.hpp"
#include "bridges/lockstep/lockstep_summary.hpp"
#include "shoal/sim_ack_t.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "sim/bus/bus.hpp"
#include "sim/bus/message_gate.hpp"
#include "sim/run/client_messages.hpp"
#include "sim/run/lockstep.hpp"
#include "sim/run/run_control.hpp"
#include "sim/world/world.hpp"

namespace bridges {

/// A lockstep client did not answer in time, and the run ends with that.
class LockstepTimeout : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class LockstepOutcome {
  done,
  stopped,  ///< `idle` returned false, or the run ends; the next call continues with the same step
};

/// A bus on which clients of the lockstep may be.
struct LockstepBus {
  sim::Bus& network;  ///< under `gate`; the handshake goes there directly, so that records leave it out
  sim::MessageGate& gate;
  std::string name = {};  ///< empty: the world's own, which is the first
};

/// The lockstep on the bus: sends sim.tick, receives sim.ack, and requests and repeats messages on sim.resend and
/// sim.resent, so that neither a tick nor a message between world and client is lost.  See docs/guides/lockstep.md.
class LockstepService {
 public:
  /// Flushes published messages, and waits for messages up to the given time, or returns earlier.
  using Wait = std::function<void(std::chrono::milliseconds)>;

  /// The defaults are those of the world's `lockstep`.  All must outlive this.  `posts_messages` false: messages from
  /// outside are not listed for clients; for playing a record, which contains them.
  LockstepService(sim::World& world, sim::RunControl& control, const std::vector<LockstepBus>& buses = {},
                  bool posts_messages = true);
  LockstepService(const LockstepService&) = delete;
  LockstepService& operator=(const LockstepService&) = delete;
  ~LockstepService();

  /// `the world's bus`, or `bus 'NAME'`.
  const std::string& called(int link) const;
  /// Whether a client on the bus `line` must receive every message of this channel.
  bool has_receiver(std::string_view channel, int link = 0) const { return lockstep_.has_receiver(link, channel); }
  /// Called with the name of each client that answers on the world's bus.
  void set_on_answer(std::function<void(const std::string&)> received) { on_answer_ = std::move(received); }

  /// Lockstep messages pass through it, as should all others that control the run.
  ControlGuard& guard() { return guard_; }
  /// Called when a second answer of a client to a tick differs from the first: with its name, the signer of the
  /// second, and a text with the difference.
  using Contradiction = std::function<void(const std::string& client, const std::string& signer, const std::string&)>;
  void set_on_contradiction(Contradiction contradiction) { contradiction_ = std::move(contradiction); }

  /// False: not decided yet, and not to be answered; the client asks again.  Throws std::runtime_error that says why
  /// it is refused.
  bool join(int link, const shoal::sim_control_request_t& request);
  /// False as with join().  Throws std::runtime_error when there is no such client on this line.
  bool leave(int link, const shoal::sim_control_request_t& request);
  /// A program that does not take part is to be listed in the last tick.  Throws std::runtime_error that says why it is
  /// refused.
  void follow(int link, const shoal::sim_control_request_t& request);
  /// Handles the end of its process: the agreed action of a time-out is taken at once; without one the world continues.
  void client_exited(const std::string& client);
  bool has(const std::string& client) const { return lockstep_.has(client); }
  /// Whether it takes part on this link.
  bool has(const std::string& client, int link) const;
  /// Whether it took part and left; false: it takes part, was dropped, or never joined.
  bool has_left(const std::string& client) const;
  bool empty() const { return lockstep_.empty(); }
  /// Names of the clients that take part, in order, separated by commas.
  std::string names() const;
  /// Client that the world waits for: `waits 1.5 s for 'pilot'`; empty: none.
  std::string waits_for();
  /// To be called periodically, also while the world is paused.
  void check_clock();

  /// Posts a message that was sent on a link past its gate, for the clients that must receive it.
  void post(int link, std::string_view channel, std::span<const std::byte> payload) {
    lockstep_.post(link, channel, payload);
  }
  /// Step 8 of a step: ticks the clients that are due, and waits until they have answered and all they published is
  /// there.  `idle` is called while waiting, and handles requests; false ends the wait.  Throws LockstepTimeout.
  LockstepOutcome synchronize(const Wait& wait, const std::function<bool()>& idle);
  /// Notifies clients of the end of the run, for up to `limit` of wall time until all have confirmed.
  void publish_end(const Wait& wait, std::chrono::milliseconds limit);

  /// After a rewind to the present step, as another branch.
  void set_branch(std::int32_t branch);
  std::int32_t branch() const { return branch_; }
  /// While suspended, messages at the gates keep their order: they are replayed, and together with the world's
  /// reports form the lists of the step to which the world is rewound.
  void suspend(bool suspended);
  /// See sim::Lockstep.
  void pass_again(std::int64_t step) { lockstep_.pass(step); }
  std::int64_t needed_from(std::int64_t step, std::int64_t max_steps) const {
    return lockstep_.needed_from(step, max_steps);
  }
  /// Bad acknowledgements and questions so far.
  std::int64_t bad_messages() const { return bad_messages_; }
  /// Messages from outside dropped from full queues before they were admitted.
  std::uint64_t dropped_messages() const;
  /// By name, including former clients, up to 2000.
  std::vector<LockstepSummary> summaries() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Link;
  /// A client that the world waits for.
  struct Pending {
    Clock::time_point since;
    Clock::time_point begin;  ///< of its time-out: later than `since` by the time that the world was paused
    Clock::time_point send_at, serve_after;
    std::chrono::milliseconds interval;
    bool reported = false;  ///< that it is late
  };
  /// Another client requests its name: checks whether it is alive.
  struct Challenge {
    Clock::time_point since, ask_at;
    bool is_alive = false;
  };
  /// A client that was dropped, and is notified when it answers late.
  struct Dropped {
    std::int64_t session = 0;
    std::int32_t join_id = 0;
    int link = 0;
    std::string why;
  };
  /// A program that follows the run without taking part.
  struct Follower {
    std::string name;
    std::int64_t session;
    int link;
  };

  /// This session of the client took part, and does no more.
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
  void discard(const std::string& client, const std::string& why);
  void report_who_left(const sim::LockstepMember& member, int link, const sim::LeaveTerms& terms);
  void notify_dropped(const Dropped& dropped, const std::string& client);
  void resume();

  void rest_time_outs(Clock::time_point now);
  void report_repeated();
  /// A client that answered, but not all that it names has come.
  std::string what_is_missing(const sim::LockstepMember& member);
  /// Throws std::runtime_error when the client takes part on another line.
  void check_link(int link, const std::string& client, const char* does) const;
  void publish_tick(const std::vector<std::string>& clients, bool last);
  void publish_left_tick(const sim::LockstepMember& member);
  void request_from_client(const sim::LockstepMember& member);
  void take_messages();
  void take_ack(int link, const sim::Message& message);
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
  std::map<std::string, Pending, std::less<>> pending_;  // in the present step
  std::map<std::string, Dropped, std::less<>> dropped_;
  std::map<std::string, std::int32_t, std::less<>> join_ids_;
  std::map<std::string, Challenge, std::less<>> challenges_;
  std::deque<std::pair<std::string, std::int64_t>> ended_;  // clients and their sessions, the last ones
  std::deque<Follower> followers_;                          // the last ones
  Clock::time_point served_, window_start_;
  bool warned_repeated_ = false;
  int reported_left_ = 0;
  std::map<std::string, LockstepSummary, std::less<>> summaries_;
  std::set<std::string, std::less<>> warned_;  // clients whose bad messages were reported
  std::function<void(const std::string&)> on_answer_;
  ControlGuard guard_;
  std::map<std::string, AnswerHistory, std::less<>> answers_;  // of those that take part
  Contradiction contradiction_;
  bool paused_here_ = false;
  std::int64_t pause_requests_ = 0;  // as they were then
  bool suspended_ = false;
  const bool posts_messages_;
  std::int32_t branch_ = 0;
  std::int64_t bad_messages_ = 0;
};

}  // namespace bridges
