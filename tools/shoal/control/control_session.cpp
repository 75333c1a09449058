// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/control/control_session.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>

#include "experiment/process/signals.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_control_request_t.hpp"

namespace tools {

using namespace std::chrono_literals;

ControlSession::ControlSession(const Options& options)
    : options_(options), lcm_(options.lcm_url), id_(static_cast<std::int32_t>(getpid()) * 1000) {
  lcm_.listen("sim.control.reply");
  const auto key = options.run.empty() ? bridges::run_key_from_environment() : bridges::read_run_key(options.run);
  if (key) signer_.emplace(*key, options.client);
}

std::optional<shoal::sim_control_reply_t> ControlSession::send_request(const std::string& command,
                                                                       const std::string& text, double value) {
  const Clock::time_point deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options_.timeout_s));
  bridges::WaitWarning audit_entry("shoal: waiting for a simulator to answer on 'sim.control.reply', at " + lcm_.url());
  const std::int32_t request = ++id_, question = ++id_;
  send(request, command, text, value);
  // Requests are answered in order.  When the query, which changes nothing, is answered and the request is not, the
  // simulator has not received the request.
  while (Clock::now() < deadline && experiment::caught_signal() == 0) {
    auto reply = await_reply(request, question, std::min<Clock::time_point>(deadline, Clock::now() + 1s), audit_entry);
    if (!reply) {
      send(question, "alive", "", 0);
      continue;
    }
    if (reply->id == request) return reply;
    send(request, command, text, value);
    return await_reply(request, request, deadline, audit_entry);
  }
  return std::nullopt;
}

std::string ControlSession::no_answer() const {
  return fmt::format("no simulator answered within {:g} s at {}; is one running there? see `shoal doctor`",
                     options_.timeout_s, lcm_.url());
}

void ControlSession::send(std::int32_t id, const std::string& command, const std::string& text, double value) {
  shoal::sim_control_request_t request{};
  request.id = id;
  request.client = options_.client;
  request.command = command;
  request.text = text;
  request.value = value;
  const sim::Bytes payload = shoal::encode(request);
  lcm_.publish("sim.control", signer_ ? signer_->sign("sim.control", payload) : payload);
}

std::optional<shoal::sim_control_reply_t> ControlSession::await_reply(std::int32_t id, std::int32_t other_id,
                                                                      Clock::time_point deadline,
                                                                      bridges::WaitWarning& audit_entry) {
  while (Clock::now() < deadline && experiment::caught_signal() == 0) {
    audit_entry.look();
    const auto message = lcm_.next(50ms);
    if (!message || message->channel != "sim.control.reply") continue;
    try {
      auto reply = shoal::decode<shoal::sim_control_reply_t>(message->payload, shoal::Finite::any);
      if ((reply.id == id || reply.id == other_id) && reply.client == options_.client) return reply;
    } catch (const shoal::MessageError&) {
      // An unrelated message on the channel.
    }
  }
  return std::nullopt;
}

}  // namespace tools
