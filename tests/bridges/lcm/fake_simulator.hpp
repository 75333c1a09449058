#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bridges/lcm/lcm_bus.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_ack_t.hpp"
#include "shoal/sim_control_reply_t.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "shoal/sim_tick_t.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace lcm_test {

/// The simulator's side of the protocol, as a thread of the test calls it.
class FakeSimulator {
 public:
  FakeSimulator()
      : bus_(own_url(1)),
        requests_(bus_.open_mailbox("sim.control")),
        acks_(bus_.open_mailbox("sim.ack")),
        commands_(bus_.open_mailbox("auv1.cmd")) {}

  bridges::LcmBus& bus() { return bus_; }
  sim::Mailbox& commands() { return *commands_; }  ///< on auv1.cmd

  template <class M>
  void send(const std::string& channel, const M& message) {
    bus_.publish(channel, shoal::encode(message), sim::Time(0));
    bus_.end_of_step();
  }

  shoal::sim_control_request_t await_request() { return await_message<shoal::sim_control_request_t>(*requests_); }
  shoal::sim_ack_t await_ack() { return await_message<shoal::sim_ack_t>(*acks_); }

  void reply(const shoal::sim_control_request_t& request, bool ok, const std::string& text) {
    shoal::sim_control_reply_t reply{};
    reply.id = request.id;
    reply.client = request.client;
    reply.ok = ok ? 1 : 0;
    reply.text = text;
    send("sim.control.reply", reply);
  }

  void tick(std::int64_t step, const std::vector<std::string>& clients, bool last = false) {
    shoal::sim_tick_t tick{};
    tick.utime = 1000 + step * 10;
    tick.step = step;
    tick.last = last ? 1 : 0;
    tick.count = static_cast<std::int32_t>(clients.size());
    tick.client = clients;
    send("sim.tick", tick);
  }

 private:
  template <class M>
  M await_message(sim::Mailbox& mailbox) {
    std::optional<sim::Message> message;
    EXPECT_TRUE(await([&] { return (message = mailbox.take()).has_value(); }));
    return message ? shoal::decode<M>(message->payload, shoal::Finite::any) : M{};
  }

  bridges::LcmBus bus_;
  std::unique_ptr<sim::Mailbox> requests_, acks_, commands_;
};

}  // namespace lcm_test
