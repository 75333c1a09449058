// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/control/other_simulators.hpp"

#include <algorithm>
#include <random>

#include "shoal/message_codec.hpp"
#include "shoal/sim_control_reply_t.hpp"

namespace bridges {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// A run that goes on looks at its requests every 20 ms, and between two steps.
constexpr milliseconds time_to_answer{150};
/// Of that: while this process had no processor the others may not have had one either.
constexpr milliseconds slice{15};

/// As which client a run asks.
constexpr const char* asker_name = "shoal-run";
constexpr const char* sharing = "{shared: true}";

template <class Message>
std::optional<Message> take_valid(sim::Mailbox& mailbox) {
  while (const auto message = mailbox.take()) {
    try {
      return shoal::decode<Message>(message->payload, shoal::Finite::any);
    } catch (const shoal::MessageError&) {  // anybody may publish anything
    }
  }
  return std::nullopt;
}

template <class Message>
void publish(sim::Bus& network, const char* channel, const Message& message) {
  network.publish(channel, shoal::encode(message), sim::Time(0));
  network.end_of_step();
}

}  // namespace

OtherSimulators::OtherSimulators(const std::vector<BusToAsk>& buses, bool shared)
    : shared_(shared), id_(static_cast<std::int32_t>(std::random_device()() >> 1)), asked_at_(Clock::now()) {
  for (const BusToAsk& bus : buses) {
    if (!shared)
      lines_.push_back({bus.url, bus.network, bus.network->open_mailbox("sim.control"),
                        bus.network->open_mailbox("sim.control.reply"), bus.network->open_mailbox("sim.clock"),
                        bus.network->open_mailbox("sim.tick")});
    ask(*bus.network);
  }
}

void OtherSimulators::ask(sim::Bus& network) {
  shoal::sim_control_request_t question{};
  question.id = id_;
  question.client = asker_name;
  question.command = "alive";  // also one that is paused answers it
  if (shared_) question.text = sharing;
  publish(network, "sim.control", question);
}

OtherSimulators::Asker OtherSimulators::who_asks(const shoal::sim_control_request_t& request) const {
  if (request.client != asker_name || request.command != "alive") return Asker::nobody;
  if (request.id == id_) return Asker::this_run;
  return request.text == sharing ? Asker::another_run_that_shares : Asker::another_run;
}

bool OtherSimulators::is_answered(Line& line) const {
  while (const auto reply = take_valid<shoal::sim_control_reply_t>(*line.replies))
    if (reply->client == asker_name && reply->id == id_) return true;
  return false;
}

/// Two runs that start at the same time: that with the smaller number stays.  Who heard a question may have asked
/// before the other one listened, so it asks again.
bool OtherSimulators::answer_questions(Line& line) {
  bool met = false;
  while (const auto question = take_valid<shoal::sim_control_request_t>(*line.requests)) {
    if (who_asks(*question) != Asker::another_run) continue;
    if (met_.insert(question->id).second) {
      met = true;
      ask(*line.network);
    }
    if (question->id < id_) continue;
    shoal::sim_control_reply_t reply{};
    reply.id = question->id;
    reply.client = question->client;
    reply.ok = 1;
    publish(*line.network, "sim.control.reply", reply);
  }
  return met;
}

std::optional<std::string> OtherSimulators::take(Line& line) {
  if (is_answered(line)) return another_simulator + std::string(" answers on ") + line.url;
  for (const auto& [channel, mailbox] : {std::pair("sim.clock", line.clock.get()), {"sim.tick", line.tick.get()}})
    if (mailbox->take())
      return another_simulator + std::string(", or a player of a log, publishes ") + channel + " on " + line.url;
  return std::nullopt;
}

std::optional<std::string> OtherSimulators::look(const Wait& wait) {
  // Time that passed while the world was built counts; one slice is kept to read what has come.
  const auto passed = std::chrono::duration_cast<milliseconds>(Clock::now() - asked_at_);
  milliseconds left = lines_.empty() ? milliseconds(0) : std::max(time_to_answer - passed, slice);
  std::optional<std::string> found;
  while (!found && left.count() > 0) {
    const auto before = Clock::now();
    wait(std::min(left, slice));
    left -= std::clamp(std::chrono::ceil<milliseconds>(Clock::now() - before), milliseconds(1), slice);
    for (Line& line : lines_) {
      if (answer_questions(line)) left = std::max(left, time_to_answer / 2);
      if (!found) found = take(line);
    }
  }
  lines_.clear();
  return found;
}

}  // namespace bridges
