// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/bus/bus.hpp"
#include "sim/world_file/on_timeout.hpp"

namespace sim {

class ParamReader;

/// What a client asks for when it joins: the `text` of `join`, a YAML map.
struct LockstepTerms {
  std::int64_t session = 0;           ///< its own random number; 0: a simple client, without lists
  std::vector<std::string> receives;  ///< channels of which it must have every message
  OnTimeout on_timeout = OnTimeout::end_run;
  double timeout_s = 10;  ///< wall time
  bool agreed = false;    ///< on_timeout was asked for, by the client or the world
  void read(ParamReader& in);
};

/// Reads the `text` of a join; what it does not say is as in `defaults`.  Where these are `agreed` the client cannot be
/// waited for longer: their `on_timeout` counts, and their `timeout_s` is the longest.  Throws ConfigError.
LockstepTerms read_lockstep_terms(const std::string& text, const LockstepTerms& defaults);

/// The `text` of `leave`, a YAML map.
struct LeaveTerms {
  std::int64_t session = 0;        ///< 0: whichever has joined
  std::int64_t acknowledged = -1;  ///< sequence of the last tick that it acknowledged; -1: it does not say
  void read(ParamReader& in);
};

/// Throws ConfigError.
LeaveTerms read_leave_terms(const std::string& text);

/// The `text` of `follow`, a YAML map.
struct FollowTerms {
  std::int64_t session = 0;  ///< of the program that is to be listed in the last tick
  void read(ParamReader& in);
};

/// Throws ConfigError.
FollowTerms read_follow_terms(const std::string& text);

/// Of the `text` of a `join`, `leave` or `follow`; 0: it names none, cannot be read, or is of another command.
std::int64_t session_in(const std::string& text, std::string_view command);

/// A message that a client must have.
struct PostedMessage {
  std::int32_t channel = 0;  ///< place in its `receives`
  std::uint32_t crc = 0;
  std::shared_ptr<const Bytes> payload;
};

/// A message that a client says it published.
struct NamedMessage {
  std::string channel;
  std::uint32_t crc = 0;
};

struct LockstepAck {
  std::string client;
  std::int64_t step = 0;
  std::int64_t session = 0;
  std::int64_t sequence = 0;
};

/// Most messages that an acknowledgement may name.
constexpr std::size_t max_named_messages = 10'000;

/// A client as the world knows it.
struct LockstepMember {
  std::string name;
  int link = 0;  ///< which bus it is on, as the caller counts
  LockstepTerms terms;
  std::int64_t period_steps = 1;
  std::int64_t joined = 0;  ///< the first step it is asked
  std::int64_t sequence = 0;
  std::int64_t requested = -1;         ///< step of its last tick
  bool answered = true;                ///< that tick
  bool removed = false;                ///< its process is known to have ended
  std::vector<PostedMessage> list;     ///< of its last tick
  std::vector<PostedMessage> pending;  ///< for the next
  std::size_t pending_bytes = 0;
  std::vector<PostedMessage> again;  ///< pending at the step that the world goes back to
  std::size_t again_bytes = 0;
  bool too_much = false;            ///< to keep: what it must have is lost
  bool abandoned = false;           ///< its last tick was open when the world went back, and still is
  std::int64_t left_step = -1;      ///< of the last such tick
  std::int32_t left_branch = 0;     ///< of that; kept by the caller
  std::int64_t left_sequence = -1;  ///< of that
  bool due(std::int64_t step) const { return step >= joined && (step - joined) % period_steps == 0; }
};

/// Which clients the world waits for, at which steps, and what they must have received by then.  Knows no message type
/// and no clock.
class Lockstep {
 public:
  /// From `step` on the world waits for this client every `period_steps` (at least 1).  Joining again in the same
  /// session changes period and terms, and leaves a tick open that was not answered; the list of channels may only
  /// grow.  Throws std::invalid_argument when it does not.  A new session starts from the beginning.
  void join(const std::string& client, const LockstepTerms& terms, std::int64_t period_steps, std::int64_t step,
            int link = 0);
  /// False when there is no such client.
  bool leave(const std::string& client);
  bool has(std::string_view client) const { return members_.contains(client); }
  bool empty() const { return members_.empty(); }
  /// Null: there is none.
  LockstepMember* find(std::string_view client);
  /// By name.
  std::map<std::string, LockstepMember, std::less<>>& members() { return members_; }
  const std::map<std::string, LockstepMember, std::less<>>& members() const { return members_; }
  /// Some client of this line must have every message of this channel.
  bool has_receiver(int link, std::string_view channel) const;

  /// What is kept of messages that a client must have, until its next tick.
  static constexpr std::size_t max_pending_bytes = 256'000'000;
  /// Adds a message that was published on a link to the lists of the clients that must receive it.
  void post(int link, std::string_view channel, std::span<const std::byte> payload);
  /// Sends the tick to the clients that are due at this step and have not got it yet; their lists are closed.
  void send_request(std::int64_t step);
  /// Sends the last tick to all clients, due or not.
  void ask_all(std::int64_t step);
  /// Those due at this step that have not answered, in the order of their names.
  std::vector<LockstepMember*> missing(std::int64_t step);
  /// Those whose tick was open when the world went back.  No client gets a new tick before they have answered: only
  /// then it is known what they published for the abandoned branch.
  std::vector<LockstepMember*> abandoned();

  /// Abandoned: it answers a tick that was open when the world went back.
  enum class Verdict { accepted, repeated, refused, abandoned };
  /// `why` is the reason for a rejection.
  Verdict acknowledge(const LockstepAck& ack, std::int64_t step, std::string& why);
  /// Before a rewind: messages posted from here on are repetitions.
  void restart_replay();
  /// Call after each step that is simulated again, without the last one: who was due had what came up to then.
  void pass(std::int64_t step);
  /// What is posted from here on comes for the first time.
  void end_replay() { again_ = false; }
  /// The step that the world should be simulated again from, so that the lists of `step` are whole: the last one before
  /// it at which each client was due.  Clients that were due more than `max_steps` before it do not count.
  std::int64_t needed_from(std::int64_t step, std::int64_t max_steps) const;
  /// After a rewind to `step`: lists hold what was posted again, and ticks continue from there by the clients'
  /// periods, once clients with an open tick have answered it.
  void rewound(std::int64_t step);

 private:
  struct Receiver {
    LockstepMember* member;
    std::int32_t channel;
  };
  void close_list(LockstepMember& member, std::int64_t step);
  void index_receivers();

  bool again_ = false;
  std::map<std::string, LockstepMember, std::less<>> members_;
  std::map<std::string, std::vector<Receiver>, std::less<>> receivers_;  // by channel
};

}  // namespace sim
