// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/spdlog.h>

#include "bridges/lockstep/lockstep_line.hpp"
#include "bridges/lockstep_client/resend.hpp"
#include "shoal/sim_ack_t.hpp"
#include "shoal/sim_resend_t.hpp"
#include "shoal/sim_tick_t.hpp"
#include "sim/config/message_text.hpp"

// The messages of the lockstep: ticks, acknowledgements, and what is asked for and sent again.

namespace bridges {

using std::chrono::milliseconds;

namespace {

/// Messages of a kind that are looked at before the world looks at something else.
constexpr int most_at_once = 1000;

template <typename Take>
void take_up_to(int most, sim::Mailbox& mailbox, Take&& take) {
  for (int taken = 0; taken < most; ++taken) {
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
  shoal::sim_due_t due;
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
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    shoal::sim_tick_t tick;
    tick.utime = utime();
    tick.step = world_.step_number();
    tick.branch = branch_;
    tick.last = last;
    for (const std::string& client : clients) {
      const sim::LockstepMember* member = lockstep_.find(client);
      if (member == nullptr || member->line != static_cast<int>(i)) continue;
      tick.client.push_back(due_of(*member));
    }
    for (const Follower& follower : followers_)
      if (last && follower.line == static_cast<int>(i)) {
        shoal::sim_due_t& due = tick.client.emplace_back();
        due.name = follower.name;
        due.session = follower.session;
        due.sequence = 0;  // it has no ticks, and does not answer
        due.count = 0;
      }
    tick.count = static_cast<std::int32_t>(tick.client.size());
    if (tick.count > 0 || last) lines_[i]->publish("sim.tick", tick, world_.now());
  }
}

/// A tick of the branch that was left, to a client that had not answered it.
void LockstepService::publish_left_tick(const sim::LockstepMember& member) {
  shoal::sim_tick_t tick;
  tick.step = member.left_step;
  tick.utime = world_.epoch_us() + (world_.step_time() * member.left_step).count();
  tick.branch = member.left_branch;
  tick.last = false;
  tick.client.push_back(due_of(member));
  tick.count = 1;
  line_of(member.line).publish("sim.tick", tick, world_.now());
}

/// Its last tick once more, or one with sequence 0: it answers both, and does nothing else.
void LockstepService::ask_whether_it_lives(const sim::LockstepMember& member) {
  Line& line = line_of(member.line);
  if (!member.answered) {
    if (member.abandoned)
      publish_left_tick(member);
    else
      publish_tick({member.name}, false);
    return line.network.end_of_step();
  }
  shoal::sim_tick_t tick;
  tick.utime = utime();
  tick.step = member.asked;
  tick.branch = branch_;
  tick.last = false;
  shoal::sim_due_t& due = tick.client.emplace_back();
  due.name = member.name;
  due.session = member.terms.session;
  due.sequence = member.sequence;
  due.count = 0;
  tick.count = 1;
  line.publish("sim.tick", tick, world_.now());
  line.network.end_of_step();
}

void LockstepService::ask_client(const sim::LockstepMember& member) {
  Line& line = line_of(member.line);
  shoal::sim_resend_t question;
  question.utime = utime();
  question.client = member.name;
  question.session = member.terms.session;
  question.sequence = member.sequence;
  question.of_client = true;
  question.first = line.mail.first_missing(member.name);
  line.publish("sim.resend", question, world_.now());
}

void LockstepService::take_messages() {
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    Line& line = *lines_[i];
    if (!lockstep_.empty()) line.mail.collect();
    take_up_to(most_at_once, *line.acks, [&](const sim::Message& ack) { take_ack(static_cast<int>(i), ack); });
    take_up_to(most_at_once, *line.questions,
               [&](const sim::Message& question) { take_question(static_cast<int>(i), question); });
    take_up_to(most_at_once, *line.bundles,
               [&](const sim::Message& bundle) { take_bundle(static_cast<int>(i), bundle); });
    for (const auto& mailbox : line.passed_on)
      while (mailbox->take()) {
      }
  }
}

void LockstepService::check_line(int line, const std::string& client, const char* does) const {
  const auto& members = lockstep_.members();
  const auto member = members.find(client);
  if (member == members.end() || member->second.line == line) return;
  throw std::runtime_error("client '" + client + "' " + does + " on " + line_of(line).called + ", but takes part on " +
                           line_of(member->second.line).called);
}

void LockstepService::take_ack(int line_index, const sim::Message& message) {
  std::string who;
  try {
    const ControlGuard::Opened opened = guard_.open(message.channel, message.payload);
    if (opened.came_before) return;  // the network repeats messages as well
    const auto ack = shoal::decode<shoal::sim_ack_t>(opened.content, shoal::Finite::any);
    who = ack.client.substr(0, 60);
    check_permission(ack.client, "acknowledges a tick", opened);
    if (ack.channel.size() > sim::most_named_messages)
      throw std::runtime_error("client '" + ack.client + "' names " + std::to_string(ack.channel.size()) +
                               " messages; at most " + std::to_string(sim::most_named_messages) + " are allowed");
    check_line(line_index, ack.client, "acknowledges a tick");
    std::string why;
    const auto verdict =
        lockstep_.acknowledge({ack.client, ack.step, ack.session, ack.sequence}, world_.step_number(), why);
    if (verdict == sim::Lockstep::Verdict::refused) {
      if (const auto dropped = dropped_.find(ack.client);
          dropped != dropped_.end() && dropped->second.session == ack.session && !lockstep_.has(ack.client))
        tell_dropped(dropped->second, ack.client);
      else if (is_over(ack.client, ack.session))
        return;  // its last answer, sent again while it left
      throw std::runtime_error(why);
    }
    if (heard_ && line_index == 0) heard_(ack.client);
    if (const auto challenge = challenges_.find(ack.client); challenge != challenges_.end())
      challenge->second.lives = true;
    compare_answers(ack, opened.signer);
    if (verdict == sim::Lockstep::Verdict::repeated) return;
    sim::LockstepMember& member = *lockstep_.find(ack.client);
    Line& line = line_of(member.line);
    std::vector<sim::NamedMessage> named;
    for (std::size_t i = 0; i < ack.channel.size(); ++i)
      named.push_back({ack.channel[i], static_cast<std::uint32_t>(ack.crc[i])});
    if (verdict == sim::Lockstep::Verdict::abandoned) {
      line.mail.collect();  // what came before this answer
      asked_.erase(ack.client);
      if (ack.listed)
        line.mail.drop(ack.client, named);
      else
        line.mail.drop_unnamed();
      return;
    }
    if (!ack.listed) return;
    for (const std::string& channel : ack.channel)
      if (!line.gate.reads(channel) && lockstep_.somebody_receives(line_index, channel) && !channel.empty() &&
          channel.size() <= sim::Bus::max_channel_length)
        line.passed_on.push_back(line.gate.open_mailbox(channel));
    line.mail.collect();  // what came before this answer, also since the mail was looked at
    line.mail.expect(ack.client, named);
    Asked& asked = asked_[ack.client];
    asked.send_at = Clock::now() + resend_grace;
    asked.interval = first_resend_interval;
  } catch (const std::runtime_error& error) {
    complain(who, std::string("sim.ack: ") + error.what());
  }
}

/// Not only the first answer counts: the one that was forged may have come before that of the client.
void LockstepService::compare_answers(const shoal::sim_ack_t& ack, const std::string& signer) {
  const auto difference = answers_[ack.client].add(ack);
  if (!difference) return;
  LockstepSummary& summary = summary_of(ack.client);
  const std::string text = "client '" + ack.client + "' gave two different answers to the tick of step " +
                           std::to_string(ack.step) + ": " + *difference;
  if (++summary.contradictions == 1)
    spdlog::warn("lockstep: {}; another program answers in its name (the first answer counts; more are only counted)",
                 sim::shortened(sim::printable(text), 300));
  if (contradiction_) contradiction_(ack.client, signer, text);
}

void LockstepService::take_question(int line_index, const sim::Message& message) {
  std::string who;
  try {
    const ControlGuard::Opened opened = guard_.open(message.channel, message.payload);
    if (opened.came_before) return;  // the network repeats messages as well
    const auto question = shoal::decode<shoal::sim_resend_t>(opened.content, shoal::Finite::any);
    if (question.of_client) return;  // our own
    who = question.client.substr(0, 60);
    check_permission(question.client, "asks for messages", opened);
    check_line(line_index, question.client, "asks for messages");
    const sim::LockstepMember* member = lockstep_.find(question.client);
    if (is_over(question.client, question.session)) return;
    if (member == nullptr || member->terms.session != question.session)
      throw std::runtime_error("client '" + question.client + "' asks for messages, but takes no part in the lockstep");
    if (question.sequence != member->sequence || member->answered) return;  // late
    if (question.first < 0 || static_cast<std::size_t>(question.first) >= member->list.size())
      throw std::runtime_error("client '" + question.client + "' asks for message " + std::to_string(question.first) +
                               " of " + std::to_string(member->list.size()));
    const auto asked = asked_.find(question.client);
    // What is on its way need not go out twice.
    if (asked == asked_.end() || Clock::now() < asked->second.serve_after) return;
    asked->second.serve_after = Clock::now() + milliseconds(5);
    send_again(*member, question.first);
  } catch (const std::runtime_error& error) {
    complain(who, std::string("sim.resend: ") + error.what());
  }
}

void LockstepService::send_again(const sim::LockstepMember& member, std::int32_t first) {
  Line& line = line_of(member.line);
  shoal::sim_resent_t head;
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
        summary_of(member.name).messages_sent_again += bundle.count;
        line.publish("sim.resent", bundle, world_.now());
      });
}

void LockstepService::take_bundle(int line_index, const sim::Message& message) {
  std::string who;
  try {
    const ControlGuard::Opened opened = guard_.open(message.channel, message.payload);
    if (opened.came_before) return;  // the network repeats messages as well
    const auto bundle = shoal::decode<shoal::sim_resent_t>(opened.content, shoal::Finite::any);
    if (!bundle.of_client) return;  // our own
    who = bundle.client.substr(0, 60);
    check_permission(bundle.client, "sends messages again", opened);
    check_line(line_index, bundle.client, "sends messages again");
    const sim::LockstepMember* member = lockstep_.find(bundle.client);
    if (is_over(bundle.client, bundle.session)) return;
    if (member == nullptr || member->terms.session != bundle.session)
      throw std::runtime_error("client '" + bundle.client +
                               "' sends messages again, but takes no part in the lockstep");
    if (bundle.sequence != member->sequence || !member->answered) return;  // late
    Line& line = line_of(member->line);
    for (std::size_t i = 0; i < bundle.message.size(); ++i) {
      const auto bytes = bytes_of(bundle.message[i]);
      ++summary_of(bundle.client).messages_asked_for;
      if (!line.mail.add(bundle.client, bundle.first + static_cast<std::int32_t>(i), bundle.message[i].channel,
                         {bytes.begin(), bytes.end()}))
        throw std::runtime_error("client '" + bundle.client + "' " +
                                 line.mail.why_not(bundle.client, bundle.first + static_cast<std::int32_t>(i),
                                                   bundle.message[i].channel, {bytes.begin(), bytes.end()}));
    }
  } catch (const std::runtime_error& error) {
    complain(who, std::string("sim.resent: ") + error.what());
  }
}

}  // namespace bridges
