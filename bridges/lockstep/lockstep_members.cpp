// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bridges/lockstep/lockstep_link.hpp"
#include "bridges/lockstep_client/resend.hpp"
#include "shoal/sim_control_reply_t.hpp"
#include "sim/base/log.hpp"
#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"

// Members of the lockstep: joining, leaving, name conflicts.

namespace bridges {

namespace {

/// Time after which the world accepts another client of the same name.
constexpr std::chrono::seconds alive_for{1};
constexpr std::size_t max_ended_sessions = 1000;
/// Text in the summary for a client that left by request.
constexpr const char* left = "left";

std::string seconds_text(sim::Time time) {
  return fmt::format("{:.2f} s", sim::to_seconds(time));
}

void add_subscriptions(ChannelUse& use, const sim::LockstepMember& member) {
  for (std::size_t i = 0; i < member.terms.receives.size(); ++i)
    use.add_subscribed(member.name, member.terms.receives[i], i < member.has_received.size() && member.has_received[i]);
}

}  // namespace

std::string LockstepService::names() const {
  std::string names;
  for (const auto& [name, member] : lockstep_.members()) names += (names.empty() ? "" : ", ") + name;
  return names;
}

bool LockstepService::join(int link, const shoal::sim_control_request_t& request) {
  if (request.client.empty() || request.client.size() > 60)
    throw std::runtime_error("'join' needs a client name of 1 to 60 characters");
  // Convert the period to steps.
  const double steps = request.value * 1e6 / static_cast<double>(world_.step_time().count());
  if (!(steps > 0.5 && steps < 1e12))
    throw std::runtime_error("'join' needs a period of at least one step, in seconds");
  const auto period_steps = static_cast<std::int64_t>(std::llround(steps));
  if (std::abs(steps - static_cast<double>(period_steps)) > 1e-6)
    throw std::runtime_error("'join' needs a period that is a multiple of the step of " +
                             sim::shortest_text(sim::to_seconds(world_.step_time())) + " s");
  // Read the terms, and check for clients of the same name.
  const sim::LockstepTerms terms = sim::read_lockstep_terms(request.text, defaults_);
  check_session(request.client, terms.session);
  const sim::LockstepMember* first = lockstep_.find(request.client);
  // A request acts on its own bus only.
  if (first && first->link != link && !first->removed)
    throw std::runtime_error("a client '" + request.client + "' already takes part on " + link_of(first->link).called +
                             "; give the one on " + link_of(link).called + " another name");
  if (first && (first->terms.session != terms.session || first->link != link)) {
    if (!may_join(*first, terms)) return false;
    discard(request.client, "another client of the same name replaced it");
  }
  if (!lockstep_.has(request.client) && lockstep_.members().size() >= 1000)
    throw std::runtime_error("1000 clients have joined, which is the maximum");
  // Add the client, and reset its records.
  lockstep_.join(request.client, terms, period_steps, world_.step_number(), link);
  challenges_.erase(request.client);
  dropped_.erase(request.client);
  join_ids_[request.client] = request.id;
  summary_of(request.client).ended.clear();
  watch_gates();
  return true;
}

bool LockstepService::is_over(const std::string& client, std::int64_t session) const {
  return session != 0 && std::find(ended_.begin(), ended_.end(), std::pair(client, session)) != ended_.end();
}

/// Checks that a request that the network repeated or delayed does not rejoin a client that has left.
void LockstepService::check_session(const std::string& client, std::int64_t session) const {
  if (!is_over(client, session)) return;
  const auto summary = summaries_.find(client);
  throw std::runtime_error("the session " + std::to_string(session) + " of client '" + client + "' is over" +
                           (summary == summaries_.end() || summary->second.ended.empty() || lockstep_.has(client)
                                ? ""
                                : " (" + summary->second.ended + ")") +
                           "; join with another one");
}

/// Checks whether the present client of that name is alive: it may have ended a moment ago.
bool LockstepService::may_join(const sim::LockstepMember& first, const sim::LockstepTerms& terms) {
  if (first.removed) return true;
  const std::string name = first.name;
  const Clock::time_point now = Clock::now();
  take_messages();  // discard answers sent before the check
  // Start a check, or continue one.
  const auto [entry, fresh] = challenges_.try_emplace(name);
  Challenge& challenge = entry->second;
  if (fresh || now - challenge.ask_at > 5 * alive_for) challenge = {now, now, false};
  // Refuse the name while its owner answers.
  if (challenge.is_alive) {
    challenges_.erase(name);
    throw std::runtime_error("another client named '" + name + "' takes part and is responding" +
                             (terms.session == 0 ? "" : "; give this one another name"));
  }
  // Accept it when the owner did not answer in time.
  const auto requested = pending_.find(name);
  const bool at_work = requested != pending_.end() && !first.answered;
  if (at_work) return now - requested->second.since > alive_for;
  // While the world runs, the next tick shows whether it is alive; a program may be busy between its ticks.
  if (control_.paused && now - challenge.since > alive_for) return true;
  // Repeat the check.
  if (now >= challenge.ask_at) {
    challenge.ask_at = now + first_resend_interval;
    probe_client(first);
  }
  return false;
}

bool LockstepService::has(const std::string& client, int link) const {
  const auto member = lockstep_.members().find(client);
  return member != lockstep_.members().end() && member->second.link == link;
}

bool LockstepService::takes_turns(int link, const shoal::sim_control_request_t& request) const {
  const auto found = lockstep_.members().find(request.client);
  if (found == lockstep_.members().end() || found->second.link != link) return false;
  const sim::LockstepMember& member = found->second;
  if (request.command != "leave") {
    constexpr std::array<std::string_view, 4> changes{"describe", "do", "remove", "spawn"};
    return link == 0 && std::find(changes.begin(), changes.end(), request.command) != changes.end();
  }
  if (member.answered || member.abandoned) return false;
  try {
    const sim::LeaveTerms terms = sim::read_leave_terms(request.text);
    return terms.session != 0 && terms.session == member.terms.session && terms.acknowledged >= 0 &&
           terms.acknowledged < member.sequence;
  } catch (const sim::ConfigError&) {
    return false;  // refused by leave()
  }
}

std::optional<ClientRequests::Waiting> LockstepService::next_request() {
  if (requests_.empty() || !lockstep_.abandoned().empty()) return std::nullopt;
  const std::int64_t step = world_.step_number();
  for (const sim::LockstepMember* member : lockstep_.missing(step))
    if (member->requested < step) return std::nullopt;
  return requests_.next(late());
}

bool LockstepService::is_of_left_branch(const std::string& client) const {
  const auto found = lockstep_.members().find(client);
  return found != lockstep_.members().end() && found->second.abandoned;
}

bool LockstepService::has_left(const std::string& client) const {
  if (requests_.is_leaving(client)) return true;
  const auto summary = summaries_.find(client);
  return !lockstep_.has(client) && summary != summaries_.end() && summary->second.ended.starts_with(left);
}

std::string LockstepService::reason_to_leave(const std::string& client) const {
  const std::size_t start = std::char_traits<char>::length(left) + 2;  // behind the colon and the space
  return has_left(client) && summaries_.at(client).ended.size() > start ? summaries_.at(client).ended.substr(start)
                                                                        : "";
}

double LockstepService::end_s(const std::string& client) const {
  const auto summary = summaries_.find(client);
  return summary == summaries_.end() ? 0 : summary->second.ended_s;
}

bool LockstepService::leave(int link, const shoal::sim_control_request_t& request) {
  const std::string called = "client '" + sim::printable(sim::shortened(request.client)) + "'";
  // Identify the client and its session.
  const sim::LeaveTerms terms = sim::read_leave_terms(request.text);
  const sim::LockstepMember* member = lockstep_.find(request.client);
  if (member == nullptr && is_over(request.client, terms.session))
    return true;  // a repeated request: the answer was lost, or is in transit
  if (member == nullptr)
    throw std::runtime_error("no client named '" + sim::shortened(request.client) + "' has joined");
  if (member->link != link)
    throw std::runtime_error("the " + called + " takes part on " + link_of(member->link).called + "; a request on " +
                             link_of(link).called + " does not affect it");
  if (terms.session != 0 && terms.session != member->terms.session)
    throw std::runtime_error("the client '" + member->name + "' that joined is a different one");
  if (terms.acknowledged > member->sequence)
    throw std::runtime_error("the client '" + member->name + "' leaves after tick " +
                             std::to_string(terms.acknowledged) + ", which was not sent to it");
  // Accept messages that it sent before it left and that arrive later.  It does not answer later ticks.
  const bool answered = member->answered || (terms.acknowledged >= 0 && terms.acknowledged < member->sequence);
  const bool complete = link_of(member->link).messages.is_complete(member->name);
  // The client may leave because a request was not answered in time; that request is dropped.
  if (terms.session != 0 && !(answered && complete)) return false;
  // Remove the client.
  report_who_left(*member, link, terms);
  const std::string reason = sim::printable(sim::shortened(terms.reason, 300));
  discard(request.client, reason.empty() ? left : left + (": " + reason));
  return true;
}

void LockstepService::report_who_left(const sim::LockstepMember& member, int link, const sim::LeaveTerms& terms) {
  constexpr int max_reports = 100;
  if (++reported_left_ > max_reports) return;
  const std::string called = "client '" + sim::printable(member.name) + "'";
  const std::string at = " at " + seconds_text(world_.now()) + " on " + link_of(link).called;
  const std::string more = reported_left_ == max_reports ? " (further ones are not reported)" : "";
  // Without its session a request may come from any program, and the user should know which one ended the client's
  // part.
  if (terms.session == 0 && member.terms.session != 0)
    sim::log_warn("lockstep: a request without its session{} released {}; the world continues without it{}", at, called,
                  more);
  else if (!terms.reason.empty())
    sim::log_warn("lockstep: {} left{}: {}; the world continues without it{}", called, at,
                  sim::printable(sim::shortened(terms.reason, 300)), more);
  else
    sim::log_info("lockstep: {} left{}{}", called, at, more);
}

void LockstepService::follow(int link, const shoal::sim_control_request_t& request) {
  constexpr std::size_t max_followers = 1000;
  if (request.client.empty() || request.client.size() > 60)
    throw std::runtime_error("'follow' needs a client name of 1 to 60 characters");
  const std::int64_t session = sim::read_follow_terms(request.text).session;
  if (session == 0) throw std::runtime_error("'follow' needs a 'session' from 1 on");
  const auto known = std::find_if(followers_.begin(), followers_.end(), [&](const Follower& each) {
    return each.name == request.client && each.session == session && each.link == link;
  });
  if (known != followers_.end()) return;
  followers_.push_back({request.client, session, link});
  // The oldest one gives way: a client that never ends its session must not fill the list.
  if (followers_.size() > max_followers) followers_.pop_front();
}

std::string LockstepService::what_is_missing(const sim::LockstepMember& member) {
  return "client '" + member.name + "' acknowledged step " + std::to_string(member.requested) + ", but " +
         link_of(member.link).messages.missing_text(member.name);
}

void LockstepService::client_exited(const std::string& client) {
  sim::LockstepMember* member = lockstep_.find(client);
  if (member == nullptr || member->removed) return;
  requests_.discard(client);
  if (!member->terms.agreed) return discard(client, "its process ended");
  member->removed = true;
  end_summary(client, "its process ended");
}

void LockstepService::remove_all(const std::string& why) {
  while (!lockstep_.empty()) discard(std::string(lockstep_.members().begin()->first), why);
  for (const auto& link : links_) link->messages.clear();
  requests_.take_all();
  dropped_.clear();
  followers_.clear();
  own_pause_.forget();
}

void LockstepService::discard(const std::string& client, const std::string& why) {
  if (const sim::LockstepMember* member = lockstep_.find(client)) {
    give_up(*member);
    add_subscriptions(use_, *member);
    if (member->terms.session != 0) {
      // Remembered, so that late messages of the old session are recognized when the name is used again.
      ended_.emplace_back(client, member->terms.session);
      if (ended_.size() > max_ended_sessions) ended_.pop_front();
    }
  }
  lockstep_.leave(client);
  pending_.erase(client);
  join_ids_.erase(client);
  challenges_.erase(client);
  answers_.erase(client);
  requests_.discard(client);
  end_summary(client, why);
  watch_gates();
}

void LockstepService::end_summary(const std::string& client, const std::string& why) {
  LockstepSummary& summary = summary_of(client);
  summary.ended = why;
  summary.ended_s = sim::to_seconds(world_.now());
}

ChannelUse LockstepService::channel_use() const {
  ChannelUse use = use_;
  for (const auto& [name, member] : lockstep_.members()) add_subscriptions(use, member);
  return use;
}

void LockstepService::drop(const std::string& client, const std::string& why) {
  const sim::LockstepMember* member = lockstep_.find(client);
  if (member == nullptr) return;
  sim::log_warn("lockstep: {}; the world continues without it", why);
  if (dropped_.size() < 1000)
    dropped_[client] = {member->terms.session, join_ids_[client], member->link,
                        why + "; the world continued without it: join again"};
  discard(client, why);
}

void LockstepService::notify_dropped(const Dropped& dropped, const std::string& client) {
  shoal::sim_control_reply_t reply{};
  reply.utime = utime();
  reply.id = dropped.join_id;
  reply.client = client;
  reply.session = dropped.session;
  reply.ok = false;
  reply.text = dropped.why;
  link_of(dropped.link).publish("sim.control.reply", reply, world_.now());
}

}  // namespace bridges
