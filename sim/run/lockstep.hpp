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
#include "sim/world_file/world_config.hpp"

namespace sim {

class ParamReader;

/// Terms of a client that joins: the `text` of `join`, a YAML map.
struct LockstepTerms {
  std::int64_t session = 0;           ///< random number chosen by the client; 0: simple client, without lists
  std::vector<std::string> receives;  ///< channels with guaranteed delivery of every message
  OnTimeout on_timeout = OnTimeout::end_run;
  double timeout_s = 10;  ///< wall time
  bool agreed = false;    ///< whether the client or the world has set on_timeout
  void read(ParamReader& in);
};

/// Reads the `text` of a join; missing keys are as in `defaults`.  When these are `agreed`, the client cannot extend
/// the wait: their `on_timeout` applies, and their `timeout_s` is the upper limit.  Throws ConfigError.
LockstepTerms read_lockstep_terms(const std::string& text, const LockstepTerms& defaults);

/// The `text` of `leave`, a YAML map.
struct LeaveTerms {
  std::int64_t session = 0;        ///< 0: any session
  std::int64_t acknowledged = -1;  ///< sequence of the last acknowledged tick; -1: not given
  std::string reason;              ///< why it leaves before the end of the run; empty: as planned
  void read(ParamReader& in);
};

/// Reads the `text` of a leave.  Throws ConfigError.
LeaveTerms read_leave_terms(const std::string& text);

/// The `text` of `follow`, a YAML map.
struct FollowTerms {
  std::int64_t session = 0;  ///< session of the program to be listed in the last tick
  void read(ParamReader& in);
};

/// Reads the `text` of a follow.  Throws ConfigError.
FollowTerms read_follow_terms(const std::string& text);

/// Returns the session in the `text` of a `join`, `leave` or `follow`; 0: there is none, the text is invalid, or the
/// command is another.
std::int64_t session_in(const std::string& text, std::string_view command);

/// Message with guaranteed delivery to a client.
struct PostedMessage {
  std::int32_t channel = 0;  ///< index into its `receives`
  std::uint32_t crc = 0;
  std::shared_ptr<const Bytes> payload;
};

/// Message that a client lists as published.
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

/// Maximum number of messages that an acknowledgement may list.
constexpr std::size_t max_named_messages = 10'000;

/// State of a client in the lockstep.
struct LockstepMember {
  std::string name;
  int link = 0;  ///< index of its bus, assigned by the caller
  LockstepTerms terms;
  std::int64_t period_steps = 1;
  std::int64_t joined = 0;  ///< step of its first tick
  std::int64_t sequence = 0;
  std::int64_t requested = -1;         ///< step of its last tick
  bool answered = true;                ///< whether that tick has been acknowledged
  bool removed = false;                ///< its process is known to have ended
  std::vector<PostedMessage> list;     ///< messages of its last tick
  std::vector<bool> has_received;      ///< of each channel of `receives`, a message; perhaps shorter
  std::vector<PostedMessage> pending;  ///< messages for the next tick
  std::size_t pending_bytes = 0;
  std::vector<PostedMessage> again;  ///< pending messages at the step to which the world is rewound
  std::size_t again_bytes = 0;
  bool too_much = false;            ///< the pending messages exceeded the limit and are lost
  bool abandoned = false;           ///< its last tick was open at a rewind, and still is
  std::int64_t left_step = -1;      ///< step of the last abandoned tick
  std::int32_t left_branch = 0;     ///< branch of that tick; kept by the caller
  std::int64_t left_sequence = -1;  ///< sequence of that tick
  bool due(std::int64_t step) const { return step >= joined && (step - joined) % period_steps == 0; }
};

/// Lockstep protocol state: the clients that the world waits for, their steps, and the messages that they must have
/// received.  Independent of message types and clocks.
class Lockstep {
 public:
  /// Adds a client: from `step` on the world waits for it every `period_steps` (at least 1).  Joining again in the same
  /// session changes period and terms, and keeps an unanswered tick open; the list of channels may only grow, else
  /// std::invalid_argument is thrown.  A new session starts with a new state.
  void join(const std::string& client, const LockstepTerms& terms, std::int64_t period_steps, std::int64_t step,
            int link = 0);
  /// Removes a client; returns false when there is none of this name.
  bool leave(const std::string& client);
  bool has(std::string_view client) const { return members_.contains(client); }
  bool empty() const { return members_.empty(); }
  /// Returns a client; null when there is none of this name.
  LockstepMember* find(std::string_view client);
  /// Returns the clients by name.
  std::map<std::string, LockstepMember, std::less<>>& members() { return members_; }
  const std::map<std::string, LockstepMember, std::less<>>& members() const { return members_; }
  /// Returns whether a client of this link must receive every message of this channel.
  bool has_receiver(int link, std::string_view channel) const;

  /// Limit of the messages kept for a client until its next tick.
  static constexpr std::size_t max_pending_bytes = 256'000'000;
  /// Adds a message that was published on a link to the lists of the clients that must receive it.
  void post(int link, std::string_view channel, std::span<const std::byte> payload);
  /// Sends the tick to the clients that are due at this step and have not received it yet; their lists are closed.
  void send_request(std::int64_t step);
  /// Sends the last tick to all clients, due or not.
  void request_all(std::int64_t step);
  /// Returns the clients due at this step that have not answered, sorted by name.
  std::vector<LockstepMember*> missing(std::int64_t step);
  /// Returns the clients whose tick was open at a rewind.  No client gets a new tick before they have answered: only
  /// then is it known what they published for the abandoned branch.
  std::vector<LockstepMember*> abandoned();

  /// Result of an acknowledgement.  Abandoned: it answers a tick that was open at a rewind.
  enum class Verdict { accepted, repeated, refused, abandoned };
  /// Handles an acknowledgement.  `why`: reason of a refusal.
  Verdict acknowledge(const LockstepAck& ack, std::int64_t step, std::string& why);
  /// Starts a replay, before a rewind: messages posted from now on are repetitions.
  void restart_replay();
  /// Must be called after each repeated step except the last one: clients due at it had received the messages up to
  /// then.
  void pass(std::int64_t step);
  /// Ends the replay: messages posted from now on are new.
  void end_replay() { again_ = false; }
  /// Returns the step from which the world must be simulated again so that the lists of `step` are complete: the last
  /// earlier step at which each client was due.  Clients that were due more than `max_steps` earlier are ignored.
  std::int64_t needed_from(std::int64_t step, std::int64_t max_steps) const;
  /// Completes a rewind to `step`: the lists hold the messages posted again, and ticks continue at the periods of the
  /// clients, once clients with an open tick have answered it.
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
