// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "bridges/control/sim_service.hpp"
#include "shoal/sim_control_reply_t.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace lcm_test {

/// A world from YAML text, and its service on the same in-process bus.
struct ServedWorld {
  /// `vehicle_buses`: beside the world's.  `is_recorded`: whether the world's bus is.
  explicit ServedWorld(const std::string& yaml, const std::vector<bridges::LockstepBus>& vehicle_buses = {},
                       bool is_recorded = false)
      : test(yaml),
        lockstep(test.world, control, with(vehicle_buses, is_recorded)),
        service(test.bus, test.bus, test.world, control, lockstep, {"{}", "test"}, links_of(vehicle_buses)) {}

  /// Sends a request, has it answered, and gives the answer.
  shoal::sim_control_reply_t request_reply(const std::string& command, double value, const std::string& text,
                                           const std::string& client = "pilot") {
    shoal::sim_control_request_t request{};
    request.id = ++id;
    request.client = client;
    request.command = command;
    request.value = value;
    request.text = text;
    test.send("sim.control", request);
    answering->handle_requests(machine);
    return replies.last();
  }

  test::TestWorld test;
  test::Listener<shoal::sim_control_reply_t> replies{test, "sim.control.reply"};
  sim::RunControl control;
  sim::MessageGate gate{test.bus};
  bridges::LockstepService lockstep;
  bridges::SimService service;
  bridges::SimService* answering = &service;  ///< another one of this world may answer in its place
  bridges::TimeMachine* machine = nullptr;    ///< serves what is about time
  std::int32_t id = 0;

 private:
  std::vector<bridges::LockstepBus> with(const std::vector<bridges::LockstepBus>& vehicle_buses, bool is_recorded) {
    std::vector<bridges::LockstepBus> all{{test.bus, gate, "", is_recorded}};
    for (const bridges::LockstepBus& bus : vehicle_buses) all.push_back(bus);
    return all;
  }
  static bridges::ServiceLinks links_of(const std::vector<bridges::LockstepBus>& buses) {
    bridges::ServiceLinks links;
    for (const bridges::LockstepBus& bus : buses) links.vehicle_buses.push_back(&bus.network);
    return links;
  }
};

}  // namespace lcm_test
