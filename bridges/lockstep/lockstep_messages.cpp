// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "bridges/lockstep/lockstep_link.hpp"
#include "bridges/lockstep_client/resend.hpp"
#include "shoal/sim_ack_t.hpp"
#include "shoal/sim_resend_t.hpp"
#include "shoal/sim_tick_t.hpp"
#include "sim/base/log.hpp"
#include "sim/config/message_text.hpp"

// Messages of the lockstep: ticks, acknowledgements, requests for repetition and repeated messages.

namespace bridges {

using std::chrono::milliseconds;

namespace {

/// Maximum number of messages of one kind that are handled at a time.
constexpr int max_at_once = 1000;
/// Reasons why the record lacks messages.
constexpr const char* did_not_arrive = "they did not arrive";
constexpr const char* too_many_channels = "more than 1000 channels";
static_assert(LockstepService::max_recorded_only == 1000);

template <typename Take>
void take_up_to(int max, sim::Mailbox& mailbox, Take&& take) {
  for (int taken = 0; taken < max; ++taken) {
    const auto message = mailbox.take();
    if (!message) return;
    take(*message);
  }
}

void check_permission(const std::string& client, const char* does, const ControlGuard::Opened& opened) {
  if (!opened.refusal.empty())
    throw std::runtime_error("client '" + client + "' " + does + ", which is refused: " + opened.refusal);
}

shoal::sim_due_t due_of(const sim::LockstepMember& member) {
  shoal::sim_due_t due{};
  due.name = member.name;
  due.session = member.terms.session;
  due.sequence = member.sequence;
  due.count = static_cast<std::int32_t>(member.list.size());
  for (const sim::PostedMessage& posted : member.list) {
    due.channel.push_back(posted.channel);
    due.crc.push_back(posted.crc);
  }
  return due;
}

}  // namespace

void LockstepService::publish_tick(const std::vector<std::string>& clients, bool last) {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    shoal::sim_tick_t tick{};
    tick.utime = utime();
    tick.step = world_.step_number();
    tick.branch = branch_;
    tick.last = last;
    // List the clients of this link.
    for (const std::string& client : clients) {
      const sim::LockstepMember* member = lockstep_.find(client);
      if (member == nullptr || member->link != static_cast<int>(i)) continue;
      tick.client.push_back(due_of(*member));
    }
    // List the followers in the last tick.
    for (const Follower& follower : followers_)
      if (last && follower.link == static_cast<int>(i)) {
        shoal::sim_due_t& due = tick.client.emplace_back();
        due.name = follower.name;
        due.session = follower.session;
        due.sequence = 0;  // it has no ticks, and does not answer
        due.count = 0;
      }
    tick.count = static_cast<std::int32_t>(tick.client.size());
    if (tick.count > 0 || last) links_[i]->publish("sim.tick", tick, world_.now());
  }
}

/// Publishes a tick of the abandoned branch to a client that had not answered it.
void LockstepService::publish_left_tick(const sim::LockstepMember& member) {
  shoal::sim_tick_t tick{};
  tick.step = member.left_step;
  tick.utime = world_.epoch_us() + (world_.step_time() * member.left_step).count();
  tick.branch = member.left_branch;
  tick.last = false;
  tick.client.push_back(due_of(member));
  tick.count = 1;
  link_of(member.link).publish("sim.tick", tick, world_.now());
}

/// Sends the last tick again, or one with sequence 0: the client answers both, and does nothing else.
void LockstepService::probe_client(const sim::LockstepMember& member) {
  Link& link = link_of(member.link);
  // Repeat the open tick.
  if (!member.answered) {
    if (member.abandoned)
      publish_left_tick(member);
    else
      publish_tick({member.name}, false);
    return link.network.end_of_step();
  }
  shoal::sim_tick_t tick{};
  tick.utime = utime();
  // Or send an empty tick with the last sequence.
  tick.step = member.requested;
  tick.branch = branch_;
  tick.last = false;
  shoal::sim_due_t& due = tick.client.emplace_back();
  due.name = member.name;
  due.session = member.terms.session;
  due.sequence = member.sequence;
  due.count = 0;
  tick.count = 1;
  link.publish("sim.tick", tick, world_.now());
  link.network.end_of_step();
}

void LockstepService::request_from_client(const sim::LockstepMember& member) {
  Link& link = link_of(member.link);
  shoal::sim_resend_t question{};
  question.utime = utime();
  question.client = member.name;
  question.session = member.terms.session;
  question.sequence = member.sequence;
  question.of_client = true;
  question.first = link.messages.first_missing(member.name);
  link.publish("sim.resend", question, world_.now());
}

void LockstepService::take_messages() {
  taken_ = Clock::now();
  for (std::size_t i = 0; i < links_.size(); ++i) {
    Link& link = *links_[i];
    if (!lockstep_.empty()) link.messages.collect();
    take_up_to(max_at_once, *link.acks, [&](const sim::Message& ack) { take_ack(static_cast<int>(i), ack); });
    take_up_to(max_at_once, *link.resend_requests,
               [&](const sim::Message& question) { take_request(static_cast<int>(i), question); });
    take_up_to(max_at_once, *link.bundles,
               [&](const sim::Message& bundle) { take_bundle(static_cast<int>(i), bundle); });
    // These mailboxes only make the gate admit the channel to the record; no client reads them.
    for (const auto& [channel, mailbox] : link.passed_on)
      while (mailbox->take()) {
      }
  }
}

void LockstepService::check_link(int link, const std::string& client, const char* does) const {
  const auto& members = lockstep_.members();
  const auto member = members.find(client);
  if (member == members.end() || member->second.link == link) return;
  throw std::runtime_error("client '" + client + "' " + does + " on " + link_of(link).called + ", but takes part on " +
                           link_of(member->second.link).called);
}

void LockstepService::take_ack(int link_index, const sim::Message& message) {
  std::string who;
  try {
    // Verify and decode the acknowledgement.
    const ControlGuard::Opened opened = guard_.open(message.channel, message.payload);
    if (opened.came_before) return;  // the network repeats messages as well
    const auto ack = shoal::decode<shoal::sim_ack_t>(opened.content, shoal::Finite::any);
    who = ack.client.substr(0, 60);
    check_permission(ack.client, "acknowledges a tick", opened);
    if (ack.channel.size() > sim::max_named_messages)
      throw std::runtime_error("client '" + ack.client + "' names " + std::to_string(ack.channel.size()) +
                               " messages; at most " + std::to_string(sim::max_named_messages) + " are allowed");
    check_link(link_index, ack.client, "acknowledges a tick");
    // Compare it with the tick of the client.
    std::string why;
    const auto verdict =
        lockstep_.acknowledge({ack.client, ack.step, ack.session, ack.sequence}, world_.step_number(), why);
    if (verdict == sim::Lockstep::Verdict::refused) {
      if (const auto dropped = dropped_.find(ack.client);
          dropped != dropped_.end() && dropped->second.session == ack.session && !lockstep_.has(ack.client))
        notify_dropped(dropped->second, ack.client);
      else if (is_over(ack.client, ack.session))
        return;  // repetition of its last answer while it was leaving
      throw std::runtime_error(why);
    }
    // Record that the client is alive.
    if (on_answer_ && link_index == 0) on_answer_(ack.client);
    if (const auto challenge = challenges_.find(ack.client); challenge != challenges_.end())
      challenge->second.is_alive = true;
    compare_answers(ack, opened.signer);
    if (verdict == sim::Lockstep::Verdict::repeated) return;
    // Take over the list of published messages.
    sim::LockstepMember& member = *lockstep_.find(ack.client);
    Link& link = link_of(member.link);
    std::vector<sim::NamedMessage> named;
    for (std::size_t i = 0; i < ack.channel.size(); ++i)
      named.push_back({ack.channel[i], static_cast<std::uint32_t>(ack.crc[i])});
    // Drop the messages of an abandoned tick.
    if (verdict == sim::Lockstep::Verdict::abandoned) {
      link.messages.collect();  // messages that arrived before this answer
      pending_.erase(ack.client);
      if (ack.listed)
        link.messages.drop(ack.client, named);
      else
        link.messages.drop_unnamed();
      return;
    }
    // Expect the listed messages, also those for other clients or for the record only.
    if (!ack.listed) {
      if (link.is_recorded) record_gaps_.add(ack.client, "", "its answers list nothing");
      return;
    }
    open_channels(link_index, ack);
    note_use(link_index, ack);
    link.messages.collect();  // messages before this answer that arrived since the last collection
    link.messages.expect(ack.client, named);
    Pending& requested = pending_[ack.client];
    requested.send_at = Clock::now() + resend_grace;
    requested.interval = first_resend_interval;
  } catch (const std::runtime_error& error) {
    warn_client(who, std::string("sim.ack: ") + error.what());
  }
}

void LockstepService::open_channels(int link_index, const shoal::sim_ack_t& ack) {
  Link& link = link_of(link_index);
  for (const std::string& channel : ack.channel) {
    if (link.gate.reads(channel) || channel.empty() || channel.size() > sim::Bus::max_channel_length) continue;
    const bool has_receiver = lockstep_.has_receiver(link_index, channel);
    if (!has_receiver && !link.is_recorded) continue;
    const char* why_not = nullptr;
    if (!has_receiver) {
      if (link.passed_on.size() >= max_recorded_only) why_not = too_many_channels;
      if (link.lost.contains(channel)) why_not = did_not_arrive;
      if (channel.starts_with("sim.")) why_not = "channels of the simulator";
    }
    if (why_not == nullptr)
      link.passed_on.emplace(channel, link.gate.open_mailbox(channel));
    else
      record_gaps_.add(ack.client, channel, why_not);
  }
}

bool LockstepService::is_only_recorded(int link_index, std::string_view channel) const {
  const Link& link = link_of(link_index);
  return link.is_recorded && link.passed_on.contains(channel) && link.gate.readers(channel) == 1 &&
         !lockstep_.has_receiver(link_index, channel);
}

void LockstepService::note_use(int link_index, const shoal::sim_ack_t& ack) {
  const Link& link = link_of(link_index);
  for (const std::string& channel : ack.channel)
    use_.add_published(ack.client, channel, link.gate.reads(channel) && !is_only_recorded(link_index, channel));
}

bool LockstepService::do_without(const sim::LockstepMember& member) {
  Link& link = link_of(member.link);
  const std::vector<std::string> missing = link.messages.missing_channels(member.name);
  if (!member.answered || missing.empty() || !std::all_of(missing.begin(), missing.end(), [&](const std::string& each) {
        return is_only_recorded(member.link, each);
        // A message that a device or another client needs is worth waiting for; one that is only recorded is not.
      }))
    return false;
  sim::log_warn("lockstep: {}; only the record needs them, and the run continues without them",
                what_is_missing(member));
  give_up(member);
  for (const std::string& channel : missing) {
    link.passed_on.erase(channel);
    link.lost.insert(channel);
  }
  return true;
}

void LockstepService::give_up(const sim::LockstepMember& member) {
  sim::ClientMessages& messages = link_of(member.link).messages;
  for (const std::string& channel : messages.missing_channels(member.name))
    if (is_only_recorded(member.link, channel)) record_gaps_.add(member.name, channel, did_not_arrive);
  messages.give_up(member.name);
}

/// Compares the answers to a tick, because a forged one may arrive before that of the client.
void LockstepService::compare_answers(const shoal::sim_ack_t& ack, const std::string& signer) {
  const auto difference = answers_[ack.client].add(ack);
  if (!difference) return;
  LockstepSummary& summary = summary_of(ack.client);
  const std::string text = "client '" + ack.client + "' gave two different answers to the tick of step " +
                           std::to_string(ack.step) + ": " + *difference;
  if (++summary.contradictions == 1)
    sim::log_warn(
        "lockstep: {}; another program answers under its name (the first answer is used; further ones are only "
        "counted)",
        sim::shortened(sim::printable(text), 300));
  if (contradiction_) contradiction_(ack.client, signer, text);
}

void LockstepService::take_request(int link_index, const sim::Message& message) {
  std::string who;
  try {
    // Verify and decode the request.
    const ControlGuard::Opened opened = guard_.open(message.channel, message.payload);
    if (opened.came_before) return;  // the network repeats messages as well
    const auto question = shoal::decode<shoal::sim_resend_t>(opened.content, shoal::Finite::any);
    if (question.of_client) return;  // our own
    who = question.client.substr(0, 60);
    check_permission(question.client, "requests messages", opened);
    check_link(link_index, question.client, "requests messages");
    // Check session, tick and index.
    const sim::LockstepMember* member = lockstep_.find(question.client);
    if (is_over(question.client, question.session)) return;
    if (member == nullptr || member->terms.session != question.session)
      throw std::runtime_error("client '" + question.client + "' requests messages, but is not a lockstep client");
    if (question.sequence != member->sequence || member->answered) return;  // late
    if (question.first < 0 || static_cast<std::size_t>(question.first) >= member->list.size())
      throw std::runtime_error("client '" + question.client + "' requests message " + std::to_string(question.first) +
                               " of " + std::to_string(member->list.size()));
    const auto requested = pending_.find(question.client);
    // Messages in transit need not be sent twice.
    if (requested == pending_.end() || Clock::now() < requested->second.serve_after) return;
    requested->second.serve_after = Clock::now() + milliseconds(5);
    send_again(*member, question.first);
  } catch (const std::runtime_error& error) {
    warn_client(who, std::string("sim.resend: ") + error.what());
  }
}

void LockstepService::send_again(const sim::LockstepMember& member, std::int32_t first) {
  Link& link = link_of(member.link);
  shoal::sim_resent_t head{};
  head.utime = utime();
  head.client = member.name;
  head.session = member.terms.session;
  head.sequence = member.sequence;
  head.of_client = false;
  send_bundles(
      head, static_cast<std::size_t>(first), member.list.size(),
      [&](std::size_t place) {
        const sim::PostedMessage& posted = member.list[place];
        return ResentMessage{member.terms.receives[static_cast<std::size_t>(posted.channel)], *posted.payload};
      },
      [&](const shoal::sim_resent_t& bundle) {
        summary_of(member.name).messages_resent += bundle.count;
        link.publish("sim.resent", bundle, world_.now());
      });
}

void LockstepService::take_bundle(int link_index, const sim::Message& message) {
  std::string who;
  try {
    // Verify and decode the repeated messages.
    const ControlGuard::Opened opened = guard_.open(message.channel, message.payload);
    if (opened.came_before) return;  // the network repeats messages as well
    const auto bundle = shoal::decode<shoal::sim_resent_t>(opened.content, shoal::Finite::any);
    if (!bundle.of_client) return;  // our own
    who = bundle.client.substr(0, 60);
    check_permission(bundle.client, "sends messages again", opened);
    check_link(link_index, bundle.client, "sends messages again");
    // Check session and tick.
    const sim::LockstepMember* member = lockstep_.find(bundle.client);
    if (is_over(bundle.client, bundle.session)) return;
    if (member == nullptr || member->terms.session != bundle.session)
      throw std::runtime_error("client '" + bundle.client + "' sends messages again, but is not a lockstep client");
    if (bundle.sequence != member->sequence || !member->answered) return;  // late
    // Add the messages to those expected.
    Link& link = link_of(member->link);
    for (std::size_t i = 0; i < bundle.message.size(); ++i) {
      const auto bytes = bytes_of(bundle.message[i]);
      ++summary_of(bundle.client).messages_requested;
      if (!link.messages.add(bundle.client, bundle.first + static_cast<std::int32_t>(i), bundle.message[i].channel,
                             {bytes.begin(), bytes.end()}))
        throw std::runtime_error("client '" + bundle.client + "' " +
                                 link.messages.why_not(bundle.client, bundle.first + static_cast<std::int32_t>(i),
                                                       bundle.message[i].channel, {bytes.begin(), bytes.end()}));
    }
  } catch (const std::runtime_error& error) {
    warn_client(who, std::string("sim.resent: ") + error.what());
  }
}

}  // namespace bridges
