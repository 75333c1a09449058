// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "shoal/sim_ack_t.hpp"
#include "shoal/sim_resend_t.hpp"
#include "shoal/sim_resent_t.hpp"
#include "shoal/sim_tick_t.hpp"
#include "sim/base/crc32.hpp"
#include "tests/bridges/control/service_fixture.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace lcm_test {

/// A world with one box, whose clients are in lockstep.
struct LockstepWorld : ServedWorld {
  explicit LockstepWorld(const std::string& terms = "{timeout_s: 60}",
                         const std::vector<bridges::LockstepBus>& vehicle_buses = {}, bool is_recorded = false)
      : ServedWorld("shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\nlockstep: " + terms +
                        "\nvehicles: [{name: a, model: {shoal: 1, bodies: [{name: b, parts: [{shape: box, mass_kg: "
                        "1}]}]}}]\n",
                    vehicle_buses, is_recorded) {}

  shoal::sim_control_reply_t join(const std::string& client, const std::string& text = "", double period_s = 0.01) {
    return request_reply("join", period_s, text, client);
  }
  void send_request(const std::string& command, double value, const std::string& client = "",
                    const std::string& text = "") {
    shoal::sim_control_request_t request{};
    request.client = client;
    request.command = command;
    request.value = value;
    request.text = text;
    test.send("sim.control", request);
  }
  /// A request that is not answered yet.
  bool is_undecided(const std::string& command, const std::string& client, const std::string& text) {
    replies.take_all();
    send_request(command, 0.01, client, text);
    service.handle_requests();
    return replies.take_all().empty();
  }
  void acknowledge(std::int64_t step, const std::string& client, std::int64_t session = 0, std::int64_t sequence = 0,
                   const std::vector<std::pair<std::string, std::string>>& published = {}) {
    shoal::sim_ack_t ack{};
    ack.step = step;
    ack.client = client;
    ack.session = session;
    ack.sequence = sequence;
    ack.listed = session != 0;
    for (const auto& [channel, text] : published) {
      ack.channel.push_back(channel);
      ack.crc.push_back(sim::crc32(bytes_of(text)));
    }
    ack.count = static_cast<std::int32_t>(published.size());
    test.send("sim.ack", ack);
  }
  /// Sends the first message that `client` has published in session 5, on "cmd", once more.
  void resend(const std::string& client, char data) {
    shoal::sim_resent_t bundle{};
    bundle.client = client;
    bundle.session = 5;
    bundle.sequence = 1;
    bundle.of_client = 1;
    bundle.count = 1;
    bundle.message = {{"cmd", 1, {static_cast<std::uint8_t>(data)}}};
    test.send("sim.resent", bundle);
  }
  /// `while_waiting` is called each time that the world waits for someone.
  bridges::LockstepOutcome synchronize(const std::function<void()>& while_waiting = [] {}) {
    return lockstep.synchronize([&](std::chrono::milliseconds) { while_waiting(); },
                                [&] {
                                  service.handle_requests();
                                  return true;
                                });
  }
  std::string admitted() {
    std::string all;
    for (const sim::MessageGate::Delivery& inputs : gate.admit())
      all.append(reinterpret_cast<const char*>(inputs.payload.data()), inputs.payload.size());
    return all;
  }

  test::Listener<shoal::sim_tick_t> ticks{test, "sim.tick"};
  test::Listener<shoal::sim_resend_t> resend_requests{test, "sim.resend"};
  test::Listener<shoal::sim_resent_t> bundles{test, "sim.resent"};
};

}  // namespace lcm_test
