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

/// Time for an answer: a run reads its requests every 20 ms, and between two steps.
constexpr milliseconds time_to_answer{150};
/// Interval of the wait: while this process was not scheduled, the others may not have been scheduled either.
constexpr milliseconds slice{15};

/// Client name in the requests of a run.
constexpr const char* requester_name = "shoal-run";
constexpr const char* sharing = "{shared: true}";

template <class Message>
std::optional<Message> take_valid(sim::Mailbox& mailbox) {
  while (const auto message = mailbox.take()) {
    try {
      return shoal::decode<Message>(message->payload, shoal::Finite::any);
    } catch (const shoal::MessageError&) {  // ignore invalid messages, which any program may publish
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
      links_.push_back({bus.url, bus.network, bus.network->open_mailbox("sim.control"),
                        bus.network->open_mailbox("sim.control.reply"), bus.network->open_mailbox("sim.clock"),
                        bus.network->open_mailbox("sim.tick")});
    send_request(*bus.network);
  }
}

void OtherSimulators::send_request(sim::Bus& network) {
  shoal::sim_control_request_t question{};
  question.id = id_;
  question.client = requester_name;
  question.command = "alive";  // also answered by a paused run
  if (shared_) question.text = sharing;
  publish(network, "sim.control", question);
}

OtherSimulators::Requester OtherSimulators::requester_of(const shoal::sim_control_request_t& request) const {
  if (request.client != requester_name || request.command != "alive") return Requester::none_of_ours;
  if (request.id == id_) return Requester::this_run;
  return request.text == sharing ? Requester::another_run_that_shares : Requester::another_run;
}

bool OtherSimulators::is_answered(Link& link) const {
  while (const auto reply = take_valid<shoal::sim_control_reply_t>(*link.replies))
    if (reply->client == requester_name && reply->id == id_) return true;
  return false;
}

/// Answers the requests of other starting runs.  When two runs start at the same time, the one with the smaller
/// number continues.  A run that receives a request may have sent its own before the other one listened, so it sends it
/// again.
bool OtherSimulators::answer_requests(Link& link) {
  bool met = false;
  while (const auto question = take_valid<shoal::sim_control_request_t>(*link.requests)) {
    if (requester_of(*question) != Requester::another_run) continue;
    if (met_.insert(question->id).second) {
      met = true;
      send_request(*link.network);
    }
    if (question->id < id_) continue;
    shoal::sim_control_reply_t reply{};
    reply.id = question->id;
    reply.client = question->client;
    reply.ok = 1;
    publish(*link.network, "sim.control.reply", reply);
  }
  return met;
}

std::optional<std::string> OtherSimulators::take(Link& link) {
  if (is_answered(link)) return another_simulator + std::string(" answers on ") + link.url;
  for (const auto& [channel, mailbox] : {std::pair("sim.clock", link.clock.get()), {"sim.tick", link.tick.get()}})
    if (mailbox->take())
      return another_simulator + std::string(", or a player of a log, publishes ") + channel + " on " + link.url;
  return std::nullopt;
}

std::optional<std::string> OtherSimulators::look(const Wait& wait) {
  // The time in which the world was built counts; keep one interval to read the messages that have arrived.
  const auto passed = std::chrono::duration_cast<milliseconds>(Clock::now() - asked_at_);
  milliseconds left = links_.empty() ? milliseconds(0) : std::max(time_to_answer - passed, slice);
  std::optional<std::string> found;
  while (!found && left.count() > 0) {
    const auto before = Clock::now();
    wait(std::min(left, slice));
    left -= std::clamp(std::chrono::ceil<milliseconds>(Clock::now() - before), milliseconds(1), slice);
    for (Link& link : links_) {
      if (answer_requests(link)) left = std::max(left, time_to_answer / 2);
      if (!found) found = take(link);
    }
  }
  links_.clear();
  return found;
}

}  // namespace bridges
