// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bridges/control/sim_service.hpp"
#include "shoal/sim_control_reply_t.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace lcm_test {

/// A world from YAML text, and its service on the same in-process bus.
struct ServedWorld {
  explicit ServedWorld(const std::string& yaml) : test(yaml) { lockstep.add_line(test.bus, gate); }

  /// Sends a request, has it answered, and gives the answer.
  shoal::sim_control_reply_t ask(const std::string& command, double value, const std::string& text,
                                 const std::string& client = "pilot") {
    shoal::sim_control_request_t request{};
    request.id = ++id;
    request.client = client;
    request.command = command;
    request.value = value;
    request.text = text;
    test.send("sim.control", request);
    service.handle_requests();
    return replies.last();
  }

  test::TestWorld test;
  test::Listener<shoal::sim_control_reply_t> replies{test, "sim.control.reply"};
  sim::RunControl control;
  sim::MailGate gate{test.bus};
  bridges::LockstepService lockstep{test.world, control};
  bridges::SimService service{test.bus, test.bus, test.world, control, lockstep, {"{}", "test"}};
  std::int32_t id = 0;
};

}  // namespace lcm_test
