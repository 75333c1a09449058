// SPDX-License-Identifier: BSD-3-Clause
#include "sim/run/lockstep.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sim/base/crc32.hpp"
#include "sim/config/message_text.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/world_file/vehicle_loader.hpp"

namespace sim {
namespace {

template <class Terms>
Terms terms_in(const std::string& text, const char* command, Terms terms) {
  if (text.empty()) return terms;
  const ConfigNode node = parse_untrusted(text, command);
  Diagnostics diagnostics;
  ParamReader in(node, "", diagnostics);
  terms.read(in);
  in.finish();
  diagnostics.throw_if_any();
  return terms;
}

}  // namespace

void LockstepTerms::read(ParamReader& in) {
  in.read("session", session, between(0, 9e18),
          "fresh random number per start of the client, so that replies from an earlier instance are recognized as "
          "stale; 0: none");
  in.read("receives", receives, "channels of which it must have every message");
  in.read_choice("on_timeout", on_timeout, on_timeout_words, "when it does not answer in timeout_s");
  in.read("timeout_s", timeout_s, between(0.001, 1e6), "wall time to wait for its acknowledgement");
  agreed = agreed || in.has("on_timeout");
  if (receives.size() > 10'000) in.error("receives", "'receives' may name at most 10000 channels");
  if (!receives.empty() && session == 0) in.error("receives", "'receives' needs a 'session' other than 0");
  for (const std::string& channel : receives)
    if (channel.empty() || channel.size() > Bus::max_channel_length)
      in.error("receives", "'receives': a channel must have 1 to 63 characters, got '" + shortened(channel) + "'");
}

LockstepTerms read_lockstep_terms(const std::string& text, const LockstepTerms& defaults) {
  LockstepTerms terms = terms_in(text, "join", defaults);
  if (defaults.agreed) {
    terms.on_timeout = defaults.on_timeout;
    terms.timeout_s = std::min(terms.timeout_s, defaults.timeout_s);
  }
  return terms;
}

void LeaveTerms::read(ParamReader& in) {
  in.read("session", session, between(0, 9e18), "session of the join; 0: any");
  in.read("acknowledged", acknowledged, between(-1, 9e18), "sequence of the last tick it acknowledged; -1: unknown");
  in.read("reason", reason, "why it leaves before the end of the run, such as an error; empty: as planned");
}

LeaveTerms read_leave_terms(const std::string& text) {
  return terms_in(text, "leave", LeaveTerms{});
}

void FollowTerms::read(ParamReader& in) {
  in.read("session", session, between(0, 9e18), "fresh random number per start of the program");
}

FollowTerms read_follow_terms(const std::string& text) {
  return terms_in(text, "follow", FollowTerms{});
}

std::int64_t session_in(const std::string& text, std::string_view command) {
  try {
    if (command == "join") return read_lockstep_terms(text, {}).session;
    if (command == "leave") return read_leave_terms(text).session;
    if (command == "follow") return read_follow_terms(text).session;
  } catch (const std::runtime_error&) {
  }
  return 0;
}

void Lockstep::join(const std::string& client, const LockstepTerms& terms, std::int64_t period_steps, std::int64_t step,
                    int link) {
  LockstepMember* known = find(client);
  if (known != nullptr && known->terms.session == terms.session && known->link == link) {
    const std::vector<std::string>& before = known->terms.receives;
    if (before.size() > terms.receives.size() || !std::equal(before.begin(), before.end(), terms.receives.begin()))
      throw std::invalid_argument("the channels of 'receives' must keep their order; new ones are appended");
    known->terms = terms;
    if (known->period_steps != period_steps) {  // a repeated request does not change the ticks
      known->period_steps = period_steps;
      known->joined = step;
      // An open tick remains open; the new period starts with it.
      if (terms.session == 0 && known->answered) known->requested = -1;
    }
  } else {
    LockstepMember& member = members_[client];
    member = LockstepMember{};
    member.name = client;
    member.link = link;
    member.terms = terms;
    member.period_steps = period_steps;
    member.joined = step;
  }
  index_receivers();
}

bool Lockstep::leave(const std::string& client) {
  const bool known = members_.erase(client) > 0;
  if (known) index_receivers();
  return known;
}

LockstepMember* Lockstep::find(std::string_view client) {
  const auto found = members_.find(client);
  return found == members_.end() ? nullptr : &found->second;
}

void Lockstep::index_receivers() {
  receivers_.clear();
  for (auto& [name, member] : members_)
    for (std::size_t i = 0; i < member.terms.receives.size(); ++i)
      receivers_[member.terms.receives[i]].push_back({&member, static_cast<std::int32_t>(i)});
}

bool Lockstep::has_receiver(int link, std::string_view channel) const {
  const auto found = receivers_.find(channel);
  return found != receivers_.end() &&
         std::any_of(found->second.begin(), found->second.end(),
                     [&](const Receiver& receiver) { return receiver.member->link == link; });
}

void Lockstep::post(int link, std::string_view channel, std::span<const std::byte> payload) {
  const auto found = receivers_.find(channel);
  if (found == receivers_.end()) return;
  // Share one copy among all receivers.
  std::shared_ptr<const Bytes> shared;
  std::uint32_t crc = 0;
  for (const Receiver& receiver : found->second) {
    if (receiver.member->link != link) continue;
    if (!shared) {
      shared = std::make_shared<const Bytes>(payload.begin(), payload.end());
      crc = crc32(payload);
    }
    LockstepMember& member = *receiver.member;
    member.has_received.resize(member.terms.receives.size());
    member.has_received[static_cast<std::size_t>(receiver.channel)] = true;
    // Replay: collect the repeated messages.
    if (again_) {
      member.again_bytes += payload.size() + sizeof(PostedMessage);
      if (member.again_bytes > max_pending_bytes)
        member.again.clear();
      else
        member.again.push_back({receiver.channel, crc, shared});
      continue;
    }
    // Otherwise add to the list of the next tick, up to the limit.
    if (member.too_much) continue;
    member.pending_bytes += payload.size() + sizeof(PostedMessage);
    if (member.pending_bytes > max_pending_bytes) {
      member.too_much = true;
      member.pending = {};
    } else {
      member.pending.push_back({receiver.channel, crc, shared});
    }
  }
}

void Lockstep::close_list(LockstepMember& member, std::int64_t step) {
  ++member.sequence;
  member.requested = step;
  member.answered = false;
  member.abandoned = false;
  member.list.clear();
  member.list.swap(member.pending);
  member.pending_bytes = 0;
}

void Lockstep::send_request(std::int64_t step) {
  for (auto& [name, member] : members_)
    if (member.due(step) && member.requested < step && !member.abandoned) close_list(member, step);
}

void Lockstep::request_all(std::int64_t step) {
  for (auto& [name, member] : members_) close_list(member, step);
}

std::vector<LockstepMember*> Lockstep::missing(std::int64_t step) {
  std::vector<LockstepMember*> late;
  for (auto& [name, member] : members_)
    if (member.due(step) && (member.requested < step || !member.answered)) late.push_back(&member);
  return late;
}

std::vector<LockstepMember*> Lockstep::abandoned() {
  std::vector<LockstepMember*> members;
  for (auto& [name, member] : members_)
    if (member.abandoned) members.push_back(&member);
  return members;
}

Lockstep::Verdict Lockstep::acknowledge(const LockstepAck& ack, std::int64_t step, std::string& why) {
  const std::string who = "client '" + printable(shortened(ack.client)) + "'";
  LockstepMember* member = find(ack.client);
  // Handle answers to abandoned and earlier ticks.
  if (member != nullptr && member->terms.session == ack.session) {
    const bool left = ack.session != 0 ? ack.sequence == member->left_sequence : ack.step == member->left_step;
    if (left && member->abandoned && ack.step == member->left_step) {
      member->abandoned = false;
      member->answered = true;
      member->requested = -1;
      member->list.clear();
      return Verdict::abandoned;
    }
    if (left && ack.step != member->requested) return Verdict::repeated;
    // Sequence 0 is a sign of life before the first tick.
    if (ack.session != 0 && (ack.sequence < member->sequence || ack.sequence == 0)) return Verdict::repeated;
  }
  // Refuse acknowledgements that match no tick.
  if (ack.step > step)
    why = who + " acknowledges step " + std::to_string(ack.step) + ", which is in the future";
  else if (member == nullptr)
    why = who + " acknowledges a tick, but is not a lockstep client";
  else if (member->terms.session != ack.session)
    why = who + " acknowledges in session " + std::to_string(ack.session) + ", which is not the one that joined";
  else if (ack.session != 0 && ack.sequence > member->sequence)
    why = who + " acknowledges tick " + std::to_string(ack.sequence) + ", which was not sent to it";
  else if (ack.session != 0 && ack.sequence == member->sequence && ack.step != member->requested)
    why = who + " acknowledges step " + std::to_string(ack.step) + " for the tick of step " +
          std::to_string(member->requested);
  if (!why.empty()) return Verdict::refused;
  // Accept the first answer to the present tick.
  const bool current = ack.session != 0 ? ack.sequence == member->sequence : ack.step == member->requested;
  if (!current || member->answered) return Verdict::repeated;
  member->answered = true;
  return Verdict::accepted;
}

void Lockstep::restart_replay() {
  again_ = true;
  for (auto& [name, member] : members_) {
    member.again.clear();
    member.again_bytes = 0;
  }
}

void Lockstep::pass(std::int64_t step) {
  for (auto& [name, member] : members_) {
    if ((step - member.joined) % member.period_steps != 0) continue;  // the phase also applies before it joined
    member.again.clear();
    member.again_bytes = 0;
  }
}

std::int64_t Lockstep::needed_from(std::int64_t step, std::int64_t max_steps) const {
  std::int64_t needed = step;
  for (const auto& [name, member] : members_) {
    if (member.terms.receives.empty()) continue;
    const std::int64_t since = (step - 1 - member.joined) % member.period_steps;
    const std::int64_t last = step - 1 - (since < 0 ? since + member.period_steps : since);
    if (step - last <= max_steps) needed = std::min(needed, last);
  }
  return std::max<std::int64_t>(needed, 0);
}

void Lockstep::rewound(std::int64_t step) {
  for (auto& [name, member] : members_) {
    // Keep the phase, also for a client that joined later than this.
    if (member.joined > step)
      member.joined -= (member.joined - step + member.period_steps - 1) / member.period_steps * member.period_steps;
    if (!member.answered && !member.abandoned) {
      member.abandoned = true;
      member.left_sequence = member.sequence;
      member.left_step = member.requested;
    }
    if (!member.abandoned) {
      member.requested = -1;
      member.list.clear();
    }
    member.too_much = member.again_bytes > max_pending_bytes;
    member.pending = std::exchange(member.again, {});
    member.pending_bytes = std::exchange(member.again_bytes, 0);
  }
}

}  // namespace sim
