// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep/lockstep_service.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <utility>

#include "bridges/lockstep/lockstep_link.hpp"
#include "bridges/lockstep_client/resend.hpp"
#include "sim/base/log.hpp"
#include "sim/config/message_text.hpp"

namespace bridges {

using std::chrono::milliseconds;

namespace {

/// Maximum number of client summaries; at most 1000 clients are in the lockstep at the same time.
constexpr std::size_t max_summaries = 2000;
/// Interval of the windows of sim::ClientMessages.
constexpr milliseconds delivery_window{50};

}  // namespace

LockstepService::LockstepService(sim::World& world, sim::RunControl& control, const std::vector<LockstepBus>& buses,
                                 bool posts_messages)
    : world_(world), control_(control), own_pause_(control), posts_messages_(posts_messages) {
  for (const LockstepBus& bus : buses) add_link(bus);
  const sim::LockstepConfig& config = world.config().lockstep;
  defaults_.on_timeout = config.on_timeout;
  defaults_.timeout_s = config.timeout_s;
  defaults_.agreed = config.agreed;
}

LockstepService::~LockstepService() {
  for (const auto& link : links_) {
    link->gate.set_watch({});
    link->gate.set_order({});
  }
}

void LockstepService::add_link(const LockstepBus& bus) {
  const int index = static_cast<int>(links_.size());
  links_.push_back(std::make_unique<Link>(bus));
  bus.gate.set_order([this, index, link = links_.back().get()](std::vector<sim::MessageGate::Delivery>& messages) {
    if (!suspended_) link->messages.order(messages);
    if (!posts_messages_) return;
    for (const sim::MessageGate::Delivery& each : messages) lockstep_.post(index, each.channel, each.payload);
  });
}

const std::string& LockstepService::called(int link) const {
  return link_of(link).called;
}

void LockstepService::watch_gates() {
  const bool any_receives = std::any_of(lockstep_.members().begin(), lockstep_.members().end(),
                                        [](const auto& entry) { return !entry.second.terms.receives.empty(); });
  for (std::size_t i = 0; i < links_.size(); ++i) {
    // A watch costs a call for each message, so it is only set while some client must have all messages.
    if (!any_receives)
      links_[i]->gate.set_watch({});
    else
      links_[i]->gate.set_watch([this, i](std::string_view channel, std::span<const std::byte> payload) {
        lockstep_.post(static_cast<int>(i), channel, payload);
      });
  }
}

LockstepSummary& LockstepService::summary_of(const std::string& client) {
  if (summaries_.size() >= max_summaries && !summaries_.contains(client)) {
    const auto removed = std::find_if(summaries_.begin(), summaries_.end(),
                                      [&](const auto& entry) { return !lockstep_.has(entry.first); });
    if (removed != summaries_.end()) summaries_.erase(removed);
  }
  LockstepSummary& summary = summaries_[client];
  summary.client = client;
  return summary;
}

std::vector<LockstepSummary> LockstepService::summaries() const {
  std::vector<LockstepSummary> all;
  for (const auto& [client, summary] : summaries_) {
    all.push_back(summary);
    for (const auto& link : links_)
      if (const auto repeated = link->messages.repeated().find(client); repeated != link->messages.repeated().end())
        all.back().messages_repeated += static_cast<std::int64_t>(repeated->second);
  }
  return all;
}

std::uint64_t LockstepService::dropped_messages() const {
  std::uint64_t dropped = 0;
  for (const auto& link : links_) dropped += link->messages.dropped();
  return dropped;
}

void LockstepService::warn_client(const std::string& client, const std::string& text) {
  ++bad_messages_;
  if (warned_.size() < 100 && warned_.insert(client).second)
    sim::log_warn("{} (ignored; more of this client are only counted)", sim::shortened(sim::printable(text), 300));
}

void LockstepService::suspend(bool suspended) {
  suspended_ = suspended;
  if (suspended)
    lockstep_.restart_replay();
  else
    lockstep_.end_replay();
}

void LockstepService::set_branch(std::int32_t branch) {
  for (auto& [name, member] : lockstep_.members())
    if (!member.answered && !member.abandoned) member.left_branch = branch_;
  branch_ = branch;
  lockstep_.rewound(world_.step_number());
  for (const auto& link : links_) link->messages.clear();
  pending_.clear();
  for (auto& [client, answers] : answers_) answers.set_branch();
  own_pause_.forget();
}

void LockstepService::drop_overflowing() {
  std::vector<std::string> names;
  for (const auto& [name, member] : lockstep_.members())
    if (member.too_much) names.push_back(name);
  for (const std::string& name : names) {
    drop(name, "client '" + name + "' must have more than " +
                   std::to_string(sim::Lockstep::max_pending_bytes / 1'000'000) +
                   " MB of messages until its next tick");
    if (const auto dropped = dropped_.find(name); dropped != dropped_.end()) notify_dropped(dropped->second, name);
  }
}

std::vector<std::string> LockstepService::late() {
  std::vector<std::string> names;
  for (const sim::LockstepMember* member : lockstep_.abandoned()) names.push_back(member->name);
  if (!names.empty()) return names;
  for (const sim::LockstepMember* member : lockstep_.missing(world_.step_number())) names.push_back(member->name);
  for (const auto& [name, member] : lockstep_.members())
    if (member.answered && !link_of(member.link).messages.is_complete(name)) names.push_back(name);
  return names;
}

LockstepOutcome LockstepService::synchronize(const Wait& wait, const std::function<bool()>& idle) {
  take_messages();  // even when no client is due: messages are checked, and do not accumulate
  drop_overflowing();
  while (true) {
    std::vector<std::string> names = late();
    if (names.empty()) break;
    if (!idle() || control_.quit) return LockstepOutcome::stopped;
    // Send new ticks and repetitions.
    if (lockstep_.abandoned().empty()) lockstep_.send_request(world_.step_number());
    names = late();  // some may have joined or left
    serve(names);
    if (names.empty()) break;
    wait(nap(names));
    take_messages();
  }
  pending_.clear();
  report_repeated();
  if (own_pause_.end()) sim::log_info("lockstep: the world continues");
  return LockstepOutcome::done;
}

milliseconds LockstepService::nap(const std::vector<std::string>& late) const {
  Clock::time_point next = Clock::now() + milliseconds(20);
  for (const std::string& client : late)
    if (const auto requested = pending_.find(client); requested != pending_.end())
      next = std::min(next, requested->second.send_at);
  return std::max(milliseconds(1), std::chrono::ceil<milliseconds>(next - Clock::now()));
}

std::string LockstepService::waits_for() {
  std::string text;
  for (const auto& [client, requested] : pending_) {
    const sim::LockstepMember* member = lockstep_.find(client);
    if (member == nullptr || (member->answered && link_of(member->link).messages.is_complete(client))) continue;
    if (requests_.has(client)) continue;  // it waits for the others
    text += fmt::format("{}waits {:.1f} s for '{}'", text.empty() ? "" : ", ",
                        std::chrono::duration<double>(Clock::now() - requested.since).count(), client);
    if (text.size() > 1000) return text + ", ...";
  }
  return text;
}

void LockstepService::check_clock() {
  const Clock::time_point now = Clock::now();
  // One at a time: messages that arrived while this process was not scheduled are read before a time-out.
  if (now - window_start_ < delivery_window) return;
  window_start_ = now;
  for (const auto& link : links_) link->messages.next_window();
}

void LockstepService::report_repeated() {
  for (const auto& link : links_) {
    const auto repeated = link->messages.take_repeated();
    if (!repeated || warned_repeated_) continue;
    warned_repeated_ = true;
    sim::log_warn(
        "lockstep: a message on '{}' was dropped: it equals one of client '{}' and may be the same message, delayed or "
        "duplicated by the network (further ones are only counted)",
        sim::printable(repeated->channel), sim::printable(repeated->client));
  }
}

/// Suspends the time-outs while a user has paused the world.
void LockstepService::rest_time_outs(Clock::time_point now) {
  const auto passed = now - std::exchange(served_, now);
  if (!control_.paused || control_.single_steps > 0 || own_pause_.holds()) return;
  for (auto& [client, requested] : pending_) requested.begin = std::min(now, requested.begin + passed);
}

void LockstepService::serve(const std::vector<std::string>& late) {
  // Time-outs end at the last look at the messages: in the time since then, which is long when the machine is busy, an
  // answer may have come.
  rest_time_outs(taken_);
  // Check the time-outs, and repeat requests with back-off.
  std::vector<std::string> to_tick;
  for (const std::string& client : late) {
    const Clock::time_point now = Clock::now();
    const auto [entry, fresh] = pending_.try_emplace(client);
    Pending& requested = entry->second;
    if (fresh) requested = {now, now, now, now, first_resend_interval, false, false};
    // The time-out of the client starts when its request has been carried out.
    constexpr int max_extensions = 100;
    const bool awaits_turn = requests_.has(client);
    const bool awaits_others = awaits_turn && std::any_of(late.begin(), late.end(), [this](const std::string& each) {
                                 return !requests_.has(each);
                               });
    if ((std::exchange(requested.awaits_turn, awaits_turn) || awaits_turn) &&
        (awaits_others || ++requested.extensions <= max_extensions))
      requested.begin = taken_;
    check_time(client, requested, taken_);
    const sim::LockstepMember* member = lockstep_.find(client);
    if (member == nullptr || requested.send_at > now) continue;
    if (member->answered && link_of(member->link).messages.is_complete(client)) continue;  // it continues without some
    requested.send_at = now + requested.interval;
    requested.interval = fresh ? requested.interval : next_resend_interval(requested.interval);
    if (awaits_others && !fresh) continue;
    if (member->answered) {
      request_from_client(*member);
    } else {
      LockstepSummary& summary = summary_of(client);
      ++(fresh && !member->abandoned ? summary.ticks : summary.repeated_ticks);
      if (member->abandoned)
        publish_left_tick(*member);
      else
        to_tick.push_back(client);
    }
  }
  if (!to_tick.empty()) publish_tick(to_tick, false);
}

void LockstepService::check_time(const std::string& client, Pending& requested, Clock::time_point now) {
  const sim::LockstepMember* member = lockstep_.find(client);
  const double timeout_s = member->terms.timeout_s;
  if (now - requested.begin < std::chrono::duration<double>(timeout_s) && !member->removed) return;
  if (do_without(*member)) return;
  // Describe what is late.
  const std::string step = std::to_string(member->requested);
  const std::string when = member->removed ? "before its process ended" : fmt::format("within {:g} s", timeout_s);
  const std::string why = member->answered ? what_is_missing(*member) + " " + when
                          : member->removed
                              ? "the process of client '" + client + "' ended before it answered step " + step
                              : "no acknowledgement from '" + client + "' for step " + step + " " + when;
  if (!requested.reported) ++summary_of(client).timeouts;
  // Execute the agreed action.
  switch (member->terms.on_timeout) {
    case sim::OnTimeout::wait:
      if (!requested.reported) sim::log_warn("lockstep: {}; the world waits", why);
      break;
    case sim::OnTimeout::pause:
      if (!requested.reported) {
        sim::log_warn("lockstep: {}; the world pauses", why);
        own_pause_.start();
      } else if (!control_.paused) {
        own_pause_.forget();
        drop(client, why);
        return;
      }
      break;
    case sim::OnTimeout::go_on:
      return drop(client, why);
    case sim::OnTimeout::end_run:
      requested.reported = true;
      end_summary(client, why);
      throw LockstepTimeout("lockstep: " + why);
  }
  requested.reported = true;
}

/// Lists all members, because clients ignore a last tick that does not list them; clients that cannot answer are not
/// waited for.
void LockstepService::publish_end(const Wait& wait, milliseconds limit) {
  constexpr int max_extensions = 10;
  pending_.clear();
  lockstep_.request_all(world_.step_number());
  for (const auto& [client, dropped] : dropped_) notify_dropped(dropped, client);
  // Repeat the last tick until all clients have confirmed.  Without back-off: a client that misses it waits without
  // success.
  const Clock::time_point start = Clock::now();
  Clock::time_point end = start + limit;
  Clock::time_point send_at = start;
  while (true) {
    std::vector<std::string> names;
    // Collect the clients that have not answered.
    bool is_awaited = false;
    for (const auto& [name, member] : lockstep_.members()) {
      if (member.answered || member.removed) continue;
      names.push_back(name);
      if (member.terms.session == 0 || !summary_of(name).ended.empty()) continue;
      is_awaited = true;
      // A client that requests messages of the last tick is alive, and is given more time.
      const Pending& pending = pending_[name];
      end = std::max(end, std::min(pending.serve_after + limit, start + max_extensions * limit));
    }
    const Clock::time_point now = Clock::now();
    if (now >= send_at) {
      publish_tick(names, true);
      send_at = now + first_resend_interval;
    }
    if (!is_awaited || now >= end) break;
    wait(milliseconds(10));
    take_messages();
  }
  for (const auto& link : links_) link->network.end_of_step();
}

}  // namespace bridges
