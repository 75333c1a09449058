// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bridges/bus/lcm_bus.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_ack_t.hpp"
#include "shoal/sim_control_reply_t.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "shoal/sim_resend_t.hpp"
#include "shoal/sim_resent_t.hpp"
#include "shoal/sim_tick_t.hpp"
#include "sim/base/crc32.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace lcm_test {

/// The simulator's side of the protocol, as a thread of the test calls it.
class FakeSimulator {
 public:
  FakeSimulator()
      : bus_(own_url(1)),
        requests_(bus_.open_mailbox("sim.control")),
        acks_(bus_.open_mailbox("sim.ack")),
        questions_(bus_.open_mailbox("sim.resend")),
        bundles_(bus_.open_mailbox("sim.resent")),
        commands_(bus_.open_mailbox("auv1.cmd")) {}

  bridges::LcmBus& bus() { return bus_; }
  sim::Mailbox& commands() { return *commands_; }  ///< on auv1.cmd

  /// Publishes, and puts the message on the lists of those who joined and receive the channel.
  void publish(const std::string& channel, const sim::Bytes& payload) {
    name(channel, payload);
    bus_.publish(channel, payload, sim::Time(0));
    bus_.end_of_step();
  }
  template <class M>
  void send(const std::string& channel, const M& message) {
    publish(channel, shoal::encode(message));
  }
  /// Puts it on the lists only: the network lost it.
  void name(const std::string& channel, const sim::Bytes& payload) {
    for (auto& [client, member] : members_)
      for (std::size_t i = 0; i < member.receives.size(); ++i)
        if (member.receives[i] == channel) {
          member.due.channel.push_back(static_cast<std::int32_t>(i));
          member.due.crc.push_back(sim::crc32(payload));
        }
  }

  /// The next one that was not replied to: on a busy machine a client asks again while the reply is on its way.
  shoal::sim_control_request_t await_request() {
    while (true) {
      const auto request = await_message<shoal::sim_control_request_t>(*requests_);
      if (!replied_.contains({request.client, request.id}) || request.command.empty()) return request;
    }
  }
  shoal::sim_ack_t await_ack() { return await_message<shoal::sim_ack_t>(*acks_); }
  shoal::sim_resend_t await_question() { return await_message<shoal::sim_resend_t>(*questions_); }
  shoal::sim_resent_t await_bundle() { return await_message<shoal::sim_resent_t>(*bundles_); }

  void reply(const shoal::sim_control_request_t& request, bool ok, const std::string& text) {
    replied_.insert({request.client, request.id});
    if (ok && (request.command == "join" || request.command == "follow")) join(request);
    shoal::sim_control_reply_t reply{};
    reply.id = request.id;
    reply.client = request.client;
    reply.session = session_of(request);
    reply.ok = ok ? 1 : 0;
    reply.text = text;
    send("sim.control.reply", reply);
  }

  void tick(std::int64_t step, const std::vector<std::string>& clients, bool last = false, std::int32_t branch = 0) {
    shoal::sim_tick_t tick{};
    tick.utime = 1000 + step * 10;
    tick.step = step;
    tick.last = last ? 1 : 0;
    tick.branch = branch;
    tick.count = static_cast<std::int32_t>(clients.size());
    for (const std::string& client : clients) tick.client.push_back(next_of(client));
    last_tick_ = tick;
    send("sim.tick", tick);
  }
  void repeat_tick() { send("sim.tick", last_tick_); }
  std::int64_t session(const std::string& client) const { return members_.at(client).due.session; }
  std::int32_t join_id(const std::string& client) const { return members_.at(client).join_id; }
  std::vector<std::string> receives(const std::string& client) const { return members_.at(client).receives; }

 private:
  struct Member {
    std::vector<std::string> receives;
    shoal::sim_due_t due{};
    std::int32_t join_id = 0;  ///< number of the request
  };

  static std::int64_t session_of(const shoal::sim_control_request_t& request) {
    std::smatch match;
    const bool has_session = std::regex_search(request.text, match, std::regex("session: (\\d+)"));
    return has_session ? std::stoll(match[1]) : 0;
  }

  void join(const shoal::sim_control_request_t& request) {
    const std::int64_t session = session_of(request);
    Member& member = members_[request.client];
    if (member.due.session != session) member = {};
    member.receives.clear();
    member.join_id = request.id;
    member.due.name = request.client;
    member.due.session = session;
    const std::regex channel("\"([^\"]*)\"");
    for (std::sregex_iterator i(request.text.begin(), request.text.end(), channel), end; i != end; ++i)
      member.receives.push_back((*i)[1]);
  }

  shoal::sim_due_t next_of(const std::string& client) {
    const auto found = members_.find(client);
    if (found == members_.end()) {
      shoal::sim_due_t due{};
      due.name = client;
      return due;
    }
    shoal::sim_due_t& due = found->second.due;
    ++due.sequence;
    due.count = static_cast<std::int32_t>(due.crc.size());
    shoal::sim_due_t now = due;
    due.channel.clear();
    due.crc.clear();
    return now;
  }

  template <class M>
  M await_message(sim::Mailbox& mailbox) {
    std::optional<sim::Message> message;
    EXPECT_TRUE(await([&] { return (message = mailbox.take()).has_value(); }));
    return message ? shoal::decode<M>(message->payload, shoal::Finite::any) : M{};
  }

  bridges::LcmBus bus_;
  std::unique_ptr<sim::Mailbox> requests_, acks_, questions_, bundles_, commands_;
  std::map<std::string, Member> members_;
  std::set<std::pair<std::string, std::int32_t>> replied_;  // client and number of the request
  shoal::sim_tick_t last_tick_{};
};

}  // namespace lcm_test
