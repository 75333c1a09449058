#include "bridges/lcm/lockstep_service.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "shoal/message_codec.hpp"
#include "shoal/sim_ack_t.hpp"
#include "shoal/sim_control_reply_t.hpp"
#include "shoal/sim_resend_t.hpp"
#include "shoal/sim_resent_t.hpp"
#include "shoal/sim_tick_t.hpp"
#include "sim/config/message_text.hpp"

namespace bridges {

using std::chrono::milliseconds;

namespace {

/// A tick is on its way for microseconds; what takes longer is lost, or its client is still at work.
constexpr milliseconds first_interval{20}, last_interval{250};
/// Messages that arrive after the acknowledgement that names them get this long before they are asked for.
constexpr milliseconds grace{1};
/// After this the world takes another client of the same name.
constexpr std::chrono::seconds alive_for{1};
/// A datagram: the loss of one loses no more than this.
constexpr std::size_t bundle_bytes = 60'000;
/// Messages of a kind that are looked at before the world looks at something else.
constexpr int most_at_once = 1000;
/// Of clients; at most 1000 of them take part at the same time.
constexpr std::size_t most_summaries = 2000;

}  // namespace

/// A bus on which clients may be.
struct LockstepService::Line {
  Line(sim::Bus& bus, sim::MailGate& mail_gate)
      : network(bus),
        gate(mail_gate),
        mail(mail_gate),
        acks(bus.open_mailbox("sim.ack")),
        questions(bus.open_mailbox("sim.resend")),
        bundles(bus.open_mailbox("sim.resent")) {}

  sim::Bus& network;
  sim::MailGate& gate;
  sim::ClientMail mail;
  std::unique_ptr<sim::Mailbox> acks, questions, bundles;
  std::vector<std::unique_ptr<sim::Mailbox>> passed_on;  // read for the sake of other clients only
};

LockstepService::LockstepService(sim::World& world, sim::RunControl& control) : world_(world), control_(control) {
  const sim::LockstepConfig& config = world.config().lockstep;
  defaults_.on_timeout = config.on_timeout;
  defaults_.timeout_s = config.timeout_s;
  defaults_.agreed = config.agreed;
}

LockstepService::~LockstepService() {
  for (const auto& line : lines_) {
    line->gate.set_watch({});
    line->gate.set_order({});
  }
}

void LockstepService::add_line(sim::Bus& network, sim::MailGate& gate) {
  const int index = static_cast<int>(lines_.size());
  lines_.push_back(std::make_unique<Line>(network, gate));
  gate.set_order([this, index, line = lines_.back().get()](std::vector<sim::MailGate::Mail>& mail) {
    if (suspended_) return;
    line->mail.order(mail);
    for (const sim::MailGate::Mail& each : mail) lockstep_.post(index, each.channel, each.payload);
  });
}

void LockstepService::watch_gates() {
  const bool wanted = std::any_of(lockstep_.members().begin(), lockstep_.members().end(),
                                  [](const auto& entry) { return !entry.second.terms.receives.empty(); });
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (!wanted)
      lines_[i]->gate.set_watch({});
    else
      lines_[i]->gate.set_watch([this, i](std::string_view channel, std::span<const std::byte> payload) {
        if (!suspended_) lockstep_.post(static_cast<int>(i), channel, payload);
      });
  }
}

template <typename Message>
void LockstepService::publish(sim::Bus& bus, const char* channel, const Message& message) {
  shoal::encode_into(message, buffer_);
  bus.publish(channel, buffer_, world_.now());
  bus.end_of_step();
}

LockstepSummary& LockstepService::summary_of(const std::string& client) {
  if (summaries_.size() >= most_summaries && !summaries_.contains(client)) {
    const auto gone = std::find_if(summaries_.begin(), summaries_.end(),
                                   [&](const auto& entry) { return !lockstep_.has(entry.first); });
    if (gone != summaries_.end()) summaries_.erase(gone);
  }
  LockstepSummary& summary = summaries_[client];
  summary.client = client;
  return summary;
}

std::vector<LockstepSummary> LockstepService::summaries() const {
  std::vector<LockstepSummary> all;
  for (const auto& [client, summary] : summaries_) all.push_back(summary);
  return all;
}

std::uint64_t LockstepService::dropped_messages() const {
  std::uint64_t dropped = 0;
  for (const auto& line : lines_) dropped += line->mail.dropped();
  return dropped;
}

void LockstepService::complain(const std::string& client, const std::string& text) {
  ++bad_messages_;
  if (told_.size() < 100 && told_.insert(client).second)
    spdlog::warn("{} (ignored; more of this client are only counted)", sim::shortened(sim::printable(text), 300));
}

bool LockstepService::join(int line, const shoal::sim_control_request_t& request) {
  if (request.client.empty() || request.client.size() > 60)
    throw std::runtime_error("'join' needs a client name of 1 to 60 characters");
  const double steps = request.value * 1e6 / static_cast<double>(world_.step_time().count());
  if (!(steps > 0.5 && steps < 1e12))
    throw std::runtime_error("'join' needs a period of at least one step, in seconds");
  const auto period_steps = static_cast<std::int64_t>(std::llround(steps));
  if (std::abs(steps - static_cast<double>(period_steps)) > 1e-6)
    throw std::runtime_error("'join' needs a period that is a multiple of the step of " +
                             std::to_string(sim::to_seconds(world_.step_time())) + " s");
  const sim::LockstepTerms terms = sim::read_lockstep_terms(request.text, defaults_);
  if (const sim::LockstepMember* first = lockstep_.find(request.client);
      first && (first->terms.session != terms.session || first->line != line)) {
    if (!may_join(*first, terms)) return false;
    forget(request.client, "another client of its name took its place");
  }
  if (!lockstep_.has(request.client) && lockstep_.members().size() >= 1000)
    throw std::runtime_error("1000 clients have joined; there is room for no more");
  lockstep_.join(request.client, terms, period_steps, world_.step_number(), line);
  challenges_.erase(request.client);
  dropped_.erase(request.client);
  join_ids_[request.client] = request.id;
  summary_of(request.client).ended.clear();
  watch_gates();
  return true;
}

/// The other of that name may have died a moment ago; while the world waits for it, it can show that it lives.
bool LockstepService::may_join(const sim::LockstepMember& first, const sim::LockstepTerms& terms) {
  if (first.gone) return true;
  const auto refuse = [&] {
    challenges_.erase(first.name);
    throw std::runtime_error("another client of the name '" + first.name + "' takes part, and answers" +
                             (terms.session == 0 ? "" : "; give this one another name"));
  };
  const std::int64_t answers = first.sequence - (first.answered ? 0 : 1);
  const auto [challenge, fresh] = challenges_.try_emplace(first.name, answers);
  if (!fresh && answers > challenge->second) refuse();  // it answered a tick since then
  const auto asked = asked_.find(first.name);
  if (asked != asked_.end() && !first.answered) return Clock::now() - asked->second.begin > alive_for;
  if (control_.paused) refuse();
  return false;
}

bool LockstepService::leave(const shoal::sim_control_request_t& request) {
  const sim::LockstepMember* member = lockstep_.find(request.client);
  if (member == nullptr)
    throw std::runtime_error("no client of the name '" + sim::shortened(request.client) + "' has joined");
  const sim::LeaveTerms terms = sim::read_leave_terms(request.text);
  if (terms.session != 0 && terms.session != member->terms.session)
    throw std::runtime_error("the client '" + member->name + "' that has joined is another one");
  if (terms.acknowledged > member->sequence)
    throw std::runtime_error("the client '" + member->name + "' leaves after tick " +
                             std::to_string(terms.acknowledged) + ", which it was not sent");
  // What it said before it leaves counts, if it takes a while to arrive.  It does not answer ticks that come later.
  const bool answered = member->answered || (terms.acknowledged >= 0 && terms.acknowledged < member->sequence);
  const bool complete = lines_[static_cast<std::size_t>(member->line)]->mail.is_complete(member->name);
  if (terms.session != 0 && !(answered && complete)) return false;
  forget(request.client, "left");
  return true;
}

void LockstepService::client_gone(const std::string& client) {
  sim::LockstepMember* member = lockstep_.find(client);
  if (member == nullptr || member->gone) return;
  if (!member->terms.agreed) return forget(client, "its process ended");
  member->gone = true;
  summary_of(client).ended = "its process ended";
}

void LockstepService::forget(const std::string& client, const std::string& why) {
  if (const sim::LockstepMember* member = lockstep_.find(client)) {
    Line& line = *lines_[static_cast<std::size_t>(member->line)];
    line.mail.give_up(client);
    line.mail.release(client);
  }
  lockstep_.leave(client);
  asked_.erase(client);
  join_ids_.erase(client);
  challenges_.erase(client);
  summary_of(client).ended = why;
  watch_gates();
}

void LockstepService::drop(const std::string& client, const std::string& why) {
  const sim::LockstepMember* member = lockstep_.find(client);
  if (member == nullptr) return;
  spdlog::warn("lockstep: {}; the world goes on without it", why);
  if (dropped_.size() < 1000)
    dropped_[client] = {member->terms.session, join_ids_[client], member->line,
                        why + "; the world went on without it: join again"};
  forget(client, why);
}

void LockstepService::tell_dropped(const Dropped& dropped, const std::string& client) {
  shoal::sim_control_reply_t reply;
  reply.utime = utime();
  reply.id = dropped.join_id;
  reply.client = client;
  reply.ok = false;
  reply.text = dropped.why;
  publish(lines_[static_cast<std::size_t>(dropped.line)]->network, "sim.control.reply", reply);
}

void LockstepService::set_branch(std::int32_t branch) {
  branch_ = branch;
  std::set<std::string> open;
  for (const auto& [name, member] : lockstep_.members())
    if (!member.answered && member.terms.session != 0) open.insert(name);
  lockstep_.rewound(world_.step_number());
  for (const auto& line : lines_) line->mail.clear();
  // What a client published for a tick of the branch that was left may still come.
  for (const auto& [name, member] : lockstep_.members())
    if (open.contains(name)) lines_[static_cast<std::size_t>(member.line)]->mail.hold(name);
  asked_.clear();
  paused_here_ = false;
}

void LockstepService::drop_overflowing() {
  std::vector<std::string> names;
  for (const auto& [name, member] : lockstep_.members())
    if (member.too_much) names.push_back(name);
  for (const std::string& name : names) {
    drop(name, "client '" + name + "' must have more than " +
                   std::to_string(sim::Lockstep::most_pending_bytes / 1'000'000) +
                   " MB of messages until its next tick");
    if (const auto dropped = dropped_.find(name); dropped != dropped_.end()) tell_dropped(dropped->second, name);
  }
}

std::vector<std::string> LockstepService::late() {
  std::vector<std::string> names;
  for (const sim::LockstepMember* member : lockstep_.missing(world_.step_number())) names.push_back(member->name);
  for (const auto& [name, member] : lockstep_.members())
    if (member.answered && !lines_[static_cast<std::size_t>(member.line)]->mail.is_complete(name))
      names.push_back(name);
  return names;
}

LockstepOutcome LockstepService::synchronize(const Wait& wait, const std::function<bool()>& idle) {
  take_messages();  // also when nobody is due: what comes is checked, and does not pile up
  drop_overflowing();
  while (true) {
    std::vector<std::string> names = late();
    if (names.empty()) break;
    if (!idle() || control_.quit) return LockstepOutcome::stopped;
    lockstep_.ask(world_.step_number());
    names = late();  // some may have joined or left
    serve(names);
    if (names.empty()) break;
    wait(nap());
    take_messages();
  }
  asked_.clear();
  resume();
  return LockstepOutcome::done;
}

void LockstepService::resume() {
  if (!paused_here_) return;
  paused_here_ = false;
  if (control_.pause_requests != pause_requests_) return;  // somebody else wants it so
  control_.paused = false;
  ++control_.changes;
  spdlog::info("lockstep: the world goes on");
}

milliseconds LockstepService::nap() const {
  Clock::time_point next = Clock::now() + milliseconds(20);
  for (const auto& [client, asked] : asked_) next = std::min(next, asked.send_at);
  return std::max(milliseconds(1), std::chrono::ceil<milliseconds>(next - Clock::now()));
}

void LockstepService::serve(const std::vector<std::string>& late) {
  std::vector<std::string> to_tick;
  for (const std::string& client : late) {
    const Clock::time_point now = Clock::now();
    const auto [entry, fresh] = asked_.try_emplace(client);
    Asked& asked = entry->second;
    if (fresh) asked = {now, now, now, first_interval, false};
    check_time(client, asked, now);
    const sim::LockstepMember* member = lockstep_.find(client);
    if (member == nullptr || asked.send_at > now) continue;
    asked.send_at = now + asked.interval;
    asked.interval = fresh ? asked.interval : std::min(2 * asked.interval, last_interval);
    if (member->answered) {
      ask_client(*member);
    } else {
      LockstepSummary& summary = summary_of(client);
      ++(fresh ? summary.ticks : summary.repeated_ticks);
      to_tick.push_back(client);
    }
  }
  if (!to_tick.empty()) publish_tick(to_tick, false);
}

void LockstepService::check_time(const std::string& client, Asked& asked, Clock::time_point now) {
  const sim::LockstepMember* member = lockstep_.find(client);
  const double timeout_s = member->terms.timeout_s;
  if (now - asked.begin < std::chrono::duration<double>(timeout_s) && !member->gone) return;
  char limit[32];
  std::snprintf(limit, sizeof limit, "%g s", timeout_s);
  const std::string step = std::to_string(world_.step_number());
  const std::string why = member->gone
                              ? "the process of client '" + client + "' ended before it answered step " + step
                              : "no acknowledgement from '" + client + "' for step " + step + " within " + limit;
  if (!asked.told) ++summary_of(client).timeouts;
  switch (member->terms.policy()) {
    case sim::OnTimeout::wait:
      if (!asked.told) spdlog::warn("lockstep: {}; the world waits", why);
      break;
    case sim::OnTimeout::pause:
      if (!asked.told) {
        spdlog::warn("lockstep: {}; the world pauses", why);
        if (!control_.paused) {
          paused_here_ = control_.paused = true;
          pause_requests_ = control_.pause_requests;
          ++control_.changes;
        }
      } else if (control_.may_step()) {
        paused_here_ = false;
        drop(client, why);
        return;
      }
      break;
    case sim::OnTimeout::go_on:
      return drop(client, why);
    case sim::OnTimeout::end_run:
      asked.told = true;
      summary_of(client).ended = why;
      throw LockstepTimeout("lockstep: " + why);
  }
  asked.told = true;
}

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
      shoal::sim_due_t& due = tick.client.emplace_back();
      due.name = client;
      due.session = member->terms.session;
      due.sequence = member->sequence;
      due.count = static_cast<std::int32_t>(member->list.size());
      for (const sim::PostedMessage& posted : member->list) {
        due.channel.push_back(posted.channel);
        due.crc.push_back(posted.crc);
      }
    }
    tick.count = static_cast<std::int32_t>(tick.client.size());
    if (tick.count > 0 || last) publish(lines_[i]->network, "sim.tick", tick);
  }
}

void LockstepService::ask_client(const sim::LockstepMember& member) {
  Line& line = *lines_[static_cast<std::size_t>(member.line)];
  shoal::sim_resend_t question;
  question.utime = utime();
  question.client = member.name;
  question.session = member.terms.session;
  question.sequence = member.sequence;
  question.of_client = true;
  question.first = line.mail.first_missing(member.name);
  publish(line.network, "sim.resend", question);
}

void LockstepService::take_messages() {
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    Line& line = *lines_[i];
    if (!lockstep_.empty()) line.mail.collect();
    for (int taken = 0; taken < most_at_once; ++taken) {
      const auto message = line.acks->take();
      if (!message) break;
      take_ack(static_cast<int>(i), *message);
    }
    for (int taken = 0; taken < most_at_once; ++taken) {
      const auto message = line.questions->take();
      if (!message) break;
      take_question(*message);
    }
    for (int taken = 0; taken < most_at_once; ++taken) {
      const auto message = line.bundles->take();
      if (!message) break;
      take_bundle(*message);
    }
    for (const auto& mailbox : line.passed_on)
      while (mailbox->take()) {
      }
  }
}

void LockstepService::take_ack(int line_index, const sim::Message& message) {
  std::string who;
  try {
    const auto ack = shoal::decode<shoal::sim_ack_t>(message.payload, shoal::Finite::any);
    who = ack.client.substr(0, 60);
    if (ack.channel.size() > sim::most_named_messages)
      throw std::runtime_error("client '" + ack.client + "' names " + std::to_string(ack.channel.size()) +
                               " messages; at most " + std::to_string(sim::most_named_messages) + " are allowed");
    std::string why;
    const auto verdict =
        lockstep_.acknowledge({ack.client, ack.step, ack.session, ack.sequence}, world_.step_number(), why);
    if (verdict == sim::Lockstep::Verdict::refused) {
      if (const auto dropped = dropped_.find(ack.client);
          dropped != dropped_.end() && dropped->second.session == ack.session && !lockstep_.has(ack.client))
        tell_dropped(dropped->second, ack.client);
      throw std::runtime_error(why);
    }
    if (heard_) heard_(ack.client);
    if (verdict == sim::Lockstep::Verdict::repeated) return;
    sim::LockstepMember& member = *lockstep_.find(ack.client);
    Line& line = *lines_[static_cast<std::size_t>(member.line)];
    std::vector<sim::NamedMessage> named;
    if (verdict == sim::Lockstep::Verdict::abandoned) {
      for (std::size_t i = 0; i < ack.channel.size(); ++i)
        named.push_back({ack.channel[i], static_cast<std::uint32_t>(ack.crc[i])});
      line.mail.drop(named);
      line.mail.release(ack.client);
      member.left_open = 0;  // once
      return;
    }
    line.mail.release(ack.client);
    if (!ack.listed) return;
    for (std::size_t i = 0; i < ack.channel.size(); ++i) {
      const std::string& channel = ack.channel[i];
      if (!line.gate.reads(channel) && lockstep_.somebody_receives(line_index, channel) && !channel.empty() &&
          channel.size() <= sim::Bus::max_channel_length)
        line.passed_on.push_back(line.gate.open_mailbox(channel));
      named.push_back({channel, static_cast<std::uint32_t>(ack.crc[i])});
    }
    line.mail.expect(ack.client, named);
    Asked& asked = asked_[ack.client];
    asked.send_at = Clock::now() + grace;
    asked.interval = first_interval;
  } catch (const std::runtime_error& error) {
    complain(who, std::string("sim.ack: ") + error.what());
  }
}

void LockstepService::take_question(const sim::Message& message) {
  std::string who;
  try {
    const auto question = shoal::decode<shoal::sim_resend_t>(message.payload, shoal::Finite::any);
    if (question.of_client) return;  // our own
    who = question.client.substr(0, 60);
    const sim::LockstepMember* member = lockstep_.find(question.client);
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
  Line& line = *lines_[static_cast<std::size_t>(member.line)];
  shoal::sim_resent_t bundle;
  bundle.utime = utime();
  bundle.client = member.name;
  bundle.session = member.terms.session;
  bundle.sequence = member.sequence;
  bundle.of_client = false;
  for (std::size_t at = static_cast<std::size_t>(first); at < member.list.size();) {
    bundle.first = static_cast<std::int32_t>(at);
    bundle.message.clear();
    for (std::size_t bytes = 0; at < member.list.size(); ++at) {
      const sim::PostedMessage& posted = member.list[at];
      bytes += posted.payload->size() + 80;
      if (bytes > bundle_bytes && !bundle.message.empty()) break;
      shoal::sim_payload_t& payload = bundle.message.emplace_back();
      payload.channel = member.terms.receives[static_cast<std::size_t>(posted.channel)];
      payload.size = static_cast<std::int32_t>(posted.payload->size());
      const auto* data = reinterpret_cast<const std::uint8_t*>(posted.payload->data());
      payload.data.assign(data, data + posted.payload->size());
    }
    bundle.count = static_cast<std::int32_t>(bundle.message.size());
    summary_of(member.name).messages_sent_again += bundle.count;
    publish(line.network, "sim.resent", bundle);
  }
}

void LockstepService::take_bundle(const sim::Message& message) {
  std::string who;
  try {
    const auto bundle = shoal::decode<shoal::sim_resent_t>(message.payload, shoal::Finite::any);
    if (!bundle.of_client) return;  // our own
    who = bundle.client.substr(0, 60);
    const sim::LockstepMember* member = lockstep_.find(bundle.client);
    if (member == nullptr || member->terms.session != bundle.session)
      throw std::runtime_error("client '" + bundle.client +
                               "' sends messages again, but takes no part in the lockstep");
    if (bundle.sequence != member->sequence || !member->answered) return;  // late
    Line& line = *lines_[static_cast<std::size_t>(member->line)];
    for (std::size_t i = 0; i < bundle.message.size(); ++i) {
      const auto* data = reinterpret_cast<const std::byte*>(bundle.message[i].data.data());
      const sim::Bytes payload(data, data + bundle.message[i].data.size());
      ++summary_of(bundle.client).messages_asked_for;
      if (!line.mail.add(bundle.client, bundle.first + static_cast<std::int32_t>(i), bundle.message[i].channel,
                         payload))
        throw std::runtime_error("client '" + bundle.client + "' sends again what it had not named");
    }
  } catch (const std::runtime_error& error) {
    complain(who, std::string("sim.resent: ") + error.what());
  }
}

void LockstepService::publish_end(const Wait& wait, milliseconds limit) {
  asked_.clear();
  lockstep_.ask_all(world_.step_number());
  const Clock::time_point end = Clock::now() + limit;
  milliseconds interval = first_interval;
  Clock::time_point send_at = Clock::now();
  while (true) {
    std::vector<std::string> names;
    for (const auto& [name, member] : lockstep_.members())
      if (member.terms.session != 0 && !member.answered && !member.gone && summary_of(name).ended.empty()) {
        names.push_back(name);
        asked_.try_emplace(name);
      }
    const Clock::time_point now = Clock::now();
    if (now >= send_at) {
      publish_tick(names, true);
      send_at = now + interval;
      interval = std::min(2 * interval, last_interval);
    }
    if (names.empty() || now >= end) return;
    wait(milliseconds(10));
    take_messages();
  }
}

}  // namespace bridges
