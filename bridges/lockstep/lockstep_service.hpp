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
#include "sim/bus/mail_gate.hpp"
#include "sim/run/client_mail.hpp"
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
  stopped,  ///< `idle` said so, or the run is to end; the next call goes on with the same step
};

/// A bus on which clients of the lockstep may be.
struct LockstepBus {
  sim::Bus& network;  ///< under `gate`; the handshake goes there directly, so that records leave it out
  sim::MailGate& gate;
  std::string name = {};  ///< empty: the world's own, which is the first
};

/// The lockstep on the bus: sends sim.tick, takes sim.ack, and asks and answers on sim.resend and sim.resent, so that
/// neither a tick nor a message between world and client is lost.  See docs/guides/lockstep.md.
class LockstepService {
 public:
  /// Has what was published sent, and waits for messages up to the given time, or returns earlier.
  using Wait = std::function<void(std::chrono::milliseconds)>;

  /// The defaults are those of the world's `lockstep`.  All must outlive this.  `posts_mail` false: what comes from
  /// outside is put on nobody's list, for who plays a record, which holds what came then.
  LockstepService(sim::World& world, sim::RunControl& control, const std::vector<LockstepBus>& buses = {},
                  bool posts_mail = true);
  LockstepService(const LockstepService&) = delete;
  LockstepService& operator=(const LockstepService&) = delete;
  ~LockstepService();

  /// `the world's bus`, or `bus 'NAME'`.
  const std::string& called(int line) const;
  /// Some client on the bus `line` must have every message of this channel.
  bool somebody_receives(std::string_view channel, int line = 0) const {
    return lockstep_.somebody_receives(line, channel);
  }
  /// Called with the name of each client that answers on the world's bus.
  void set_on_heard(std::function<void(const std::string&)> heard) { heard_ = std::move(heard); }

  /// What comes for the lockstep goes through it, and so should all else that controls the run.
  ControlGuard& guard() { return guard_; }
  /// Called when a second answer of a client to one tick is not its first: with its name, who signed the second, and a
  /// text that says what differs.
  using Contradiction = std::function<void(const std::string& client, const std::string& signer, const std::string&)>;
  void set_on_contradiction(Contradiction contradiction) { contradiction_ = std::move(contradiction); }

  /// False: not decided yet, and not to be answered; the client asks again.  Throws std::runtime_error that says why
  /// it is refused.
  bool join(int line, const shoal::sim_control_request_t& request);
  /// False as with join().  Throws std::runtime_error when there is no such client on this line.
  bool leave(int line, const shoal::sim_control_request_t& request);
  /// A program that does not take part is to be listed in the last tick.  Throws std::runtime_error that says why it is
  /// refused.
  void follow(int line, const shoal::sim_control_request_t& request);
  /// Its process has ended: what was agreed for a time-out is done at once; the world goes on when nothing was agreed.
  void client_gone(const std::string& client);
  bool has(const std::string& client) const { return lockstep_.has(client); }
  /// It takes part on this line.
  bool has(const std::string& client, int line) const;
  /// It took part and asked to leave; false: it takes part, was dropped, or never joined.
  bool has_left(const std::string& client) const;
  bool empty() const { return lockstep_.empty(); }
  /// Of those that take part, in order, with commas between.
  std::string names() const;
  /// For whom the world waits: `waits 1.5 s for 'pilot'`; empty: for nobody.
  std::string waits_for();
  /// Call now and then, also while the world is paused.
  void look_at_clock();

  /// A message that went to a line beside its gate, for the clients that must have it.
  void post(int line, std::string_view channel, std::span<const std::byte> payload) {
    lockstep_.post(line, channel, payload);
  }
  /// Step 8 of a step: ticks the clients that are due, and waits until they have answered and all they published is
  /// there.  `idle` is called while waiting, and handles requests; false ends the wait.  Throws LockstepTimeout.
  LockstepOutcome synchronize(const Wait& wait, const std::function<bool()>& idle);
  /// Tells clients that the run is over, for up to `limit` of wall time until all of them know.
  void publish_end(const Wait& wait, std::chrono::milliseconds limit);

  /// The world went back, to its present step, as another branch.
  void set_branch(std::int32_t branch);
  std::int32_t branch() const { return branch_; }
  /// While suspended the mail at the gates keeps its order: it is played in again, and with what the world publishes
  /// makes the lists of the step that the world goes back to.
  void suspend(bool suspended);
  /// See sim::Lockstep.
  void pass_again(std::int64_t step) { lockstep_.pass(step); }
  std::int64_t needed_from(std::int64_t step, std::int64_t most_steps) const {
    return lockstep_.needed_from(step, most_steps);
  }
  /// Bad acknowledgements and questions so far.
  std::int64_t bad_messages() const { return bad_messages_; }
  /// Messages from outside that had to make room before they were admitted.
  std::uint64_t dropped_messages() const;
  /// By name, with those that are gone, up to 2000.
  std::vector<LockstepSummary> summaries() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Line;
  /// A client that the world waits for.
  struct Asked {
    Clock::time_point since;
    Clock::time_point begin;  ///< of its time-out: later than `since` by what somebody had paused the world
    Clock::time_point send_at, serve_after;
    std::chrono::milliseconds interval;
    bool told = false;  ///< that it is late
  };
  /// Another one wants its name: does it live?
  struct Challenge {
    Clock::time_point since, ask_at;
    bool lives = false;
  };
  /// One that was dropped, and is told so when it answers late.
  struct Dropped {
    std::int64_t session = 0;
    std::int32_t join_id = 0;
    int line = 0;
    std::string why;
  };
  /// A program that follows the run without taking part.
  struct Follower {
    std::string name;
    std::int64_t session;
    int line;
  };

  /// This session of the client took part, and does no more.
  bool is_over(const std::string& client, std::int64_t session) const;
  void check_session(const std::string& client, std::int64_t session) const;
  void add_line(const LockstepBus& bus);
  bool may_join(const sim::LockstepMember& first, const sim::LockstepTerms& terms);
  void ask_whether_it_lives(const sim::LockstepMember& member);
  void drop_overflowing();
  std::vector<std::string> late();
  void serve(const std::vector<std::string>& late);
  void check_time(const std::string& client, Asked& asked, Clock::time_point now);
  void drop(const std::string& client, const std::string& why);
  void forget(const std::string& client, const std::string& why);
  void tell_who_left(const sim::LockstepMember& member, int line, const sim::LeaveTerms& terms);
  void tell_dropped(const Dropped& dropped, const std::string& client);
  void resume();

  void rest_time_outs(Clock::time_point now);
  void tell_repeated();
  /// A client that answered, but not all that it names has come.
  std::string what_is_missing(const sim::LockstepMember& member);
  /// Throws std::runtime_error when the client takes part on another line.
  void check_line(int line, const std::string& client, const char* does) const;
  void publish_tick(const std::vector<std::string>& clients, bool last);
  void publish_left_tick(const sim::LockstepMember& member);
  void ask_client(const sim::LockstepMember& member);
  void take_messages();
  void take_ack(int line, const sim::Message& message);
  void take_question(int line, const sim::Message& message);
  void take_bundle(int line, const sim::Message& message);
  void compare_answers(const shoal::sim_ack_t& ack, const std::string& signer);
  void send_again(const sim::LockstepMember& member, std::int32_t first);
  void complain(const std::string& client, const std::string& text);
  void watch_gates();
  std::chrono::milliseconds nap(const std::vector<std::string>& late) const;
  std::int64_t utime() const { return world_.epoch_us() + world_.now().count(); }
  LockstepSummary& summary_of(const std::string& client);
  Line& line_of(int number) { return *lines_[static_cast<std::size_t>(number)]; }
  const Line& line_of(int number) const { return *lines_[static_cast<std::size_t>(number)]; }

  sim::World& world_;
  sim::RunControl& control_;
  sim::LockstepTerms defaults_;
  sim::Lockstep lockstep_;
  std::vector<std::unique_ptr<Line>> lines_;
  std::map<std::string, Asked, std::less<>> asked_;  // in the present step
  std::map<std::string, Dropped, std::less<>> dropped_;
  std::map<std::string, std::int32_t, std::less<>> join_ids_;
  std::map<std::string, Challenge, std::less<>> challenges_;
  std::deque<std::pair<std::string, std::int64_t>> ended_;  // clients and their sessions, the last ones
  std::deque<Follower> followers_;                          // the last ones
  Clock::time_point served_, window_began_;
  bool told_repeated_ = false;
  int told_left_ = 0;
  std::map<std::string, LockstepSummary, std::less<>> summaries_;
  std::set<std::string, std::less<>> told_;  // whose bad messages were told of
  std::function<void(const std::string&)> heard_;
  ControlGuard guard_;
  std::map<std::string, AnswerHistory, std::less<>> answers_;  // of those that take part
  Contradiction contradiction_;
  bool paused_here_ = false;
  std::int64_t pause_requests_ = 0;  // as they were then
  bool suspended_ = false;
  const bool posts_mail_;
  std::int32_t branch_ = 0;
  std::int64_t bad_messages_ = 0;
};

}  // namespace bridges
