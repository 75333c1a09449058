// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <signal.h>

#include "bridges/lcm/lcm_listener.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/modem_received_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/sim_state_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "tests/system/shoal_program.hpp"

// `shoal control` against a run in another process, and runs with a bus for each vehicle.

namespace {

using namespace system_test;
using testing::HasSubstr;

/// Waits for a message on a channel and decodes it.
template <typename Message, typename Condition>
bool receives(bridges::LcmListener& listener, const std::string& channel, const Condition& condition,
              std::chrono::milliseconds limit = timeout) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (std::chrono::steady_clock::now() < deadline) {
    const auto message = listener.next(100ms);
    if (!message || message->channel != channel) continue;
    if (condition(shoal::decode<Message>(message->payload, shoal::Finite::any))) return true;
  }
  return false;
}

TEST(Control, SpawnsDrivesAndRemovesAVehicleOverLcm) {
  bridges::LcmListener listener(own_url());
  listener.listen("sim.state");
  Program shoal(
      {built("shoal"), "run", source("worlds/minimal.yaml"), "--duration", "forever", "--lcm-url", own_url()});
  ASSERT_TRUE(receives<shoal::sim_state_t>(listener, "sim.state", [](const auto& state) { return state.count == 1; }));
  const Ended spawned = control({"spawn", "{name: guest, file: rover.yaml, position_m: [0, 3, 0]}"});
  EXPECT_EQ(spawned.exit_code, 0) << spawned.errors;
  EXPECT_THAT(spawned.output, HasSubstr("guest: drive (takes shoal.twist_command_t"));
  shoal::twist_command_t forward{};
  forward.forward_mps = 1;
  listener.publish("guest.drive.cmd", shoal::encode(forward));
  EXPECT_TRUE(receives<shoal::sim_state_t>(listener, "sim.state", [](const auto& state) {
    return state.count == 2 && state.vehicle[1] == "guest" && state.position_m[1][0] > 0.5;
  }));
  const Ended twice = control({"spawn", "{name: guest, file: rover.yaml}"});
  EXPECT_EQ(twice.exit_code, 1);
  EXPECT_THAT(twice.errors, HasSubstr("vehicle 'guest': there already is a vehicle of this name"));
  EXPECT_EQ(control({"remove", "guest"}).exit_code, 0);
  EXPECT_TRUE(receives<shoal::sim_state_t>(listener, "sim.state", [](const auto& state) { return state.count == 1; }));
  EXPECT_EQ(control({"quit"}).exit_code, 0);
  EXPECT_EQ(shoal.wait(), 0) << shoal.errors();
}

TEST(Control, AVehicleGoesWithTheProgramThatBroughtIt) {
  bridges::LcmListener listener(own_url());
  listener.listen("sim.state");
  Program shoal(
      {built("shoal"), "run", source("worlds/minimal.yaml"), "--duration", "forever", "--lcm-url", own_url()});
  ASSERT_TRUE(receives<shoal::sim_state_t>(listener, "sim.state", [](const auto& state) { return state.count == 1; }));
  Program client({built("shoal"), "control", "spawn", "--stay", "--timeout", "60", "--lcm-url", own_url(),
                  "{name: guest, file: rover.yaml, position_m: [0, 3, 0], with_client: true, alive_timeout_s: 2}"});
  EXPECT_TRUE(receives<shoal::sim_state_t>(listener, "sim.state", [](const auto& state) { return state.count == 2; }));
  client.send_signal(SIGKILL);  // it cannot say good-bye
  EXPECT_TRUE(receives<shoal::sim_state_t>(listener, "sim.state", [](const auto& state) { return state.count == 1; }));
  EXPECT_EQ(control({"quit"}).exit_code, 0);
  EXPECT_EQ(shoal.wait(), 0) << shoal.errors();
}

TEST(Control, SaysThatNoOneAnswers) {
  const Ended ended = control({"pause", "--timeout", "0.2"});
  EXPECT_EQ(ended.exit_code, 5);
  EXPECT_THAT(ended.errors, HasSubstr("no simulator answered within 0.2 s"));
}

/// Two rovers, each on its own bus, that have nothing in common but a modem.
std::string two_buses() {
  const auto rover = [](const std::string& name, const std::string& y_m) {
    return "  - {name: " + name + ", bus: " + name + "_bus, position_m: [0, " + y_m +
           ", 0], file: " + source("vehicles/rover.yaml") + "}\n";
  };
  return "shoal: 1\nrun: {duration_s: forever, speed: 1}\nbuses:\n  - {name: r1_bus, lcm_url: \"" + own_url(1) +
         "\"}\n  - {name: r2_bus, lcm_url: \"" + own_url(2) +
         "\"}\nobjects: [{name: ground, fixed: true, parts: [{shape: plane}]}]\nvehicles:\n" + rover("r1", "0") +
         rover("r2", "5");
}

TEST(SeparateBus, NothingButTheModemConnectsTwoRobots) {
  ScratchFolder folder;
  write_file(folder.file("world.yaml"), two_buses());
  bridges::LcmListener world(own_url()), at_r1(own_url(1)), at_r2(own_url(2));
  for (auto* listener : {&world, &at_r1, &at_r2}) listener->listen_to_all();
  Program shoal({built("shoal"), "run", folder.file("world.yaml"), "--lcm-url", own_url()});
  ASSERT_TRUE(receives<shoal::sim_state_t>(world, "sim.state", [](const auto& state) { return state.count == 2; }));

  // A command for r2 that r1's programs send stays on r1's bus; a message by modem arrives at r2.
  shoal::twist_command_t forward{};
  forward.forward_mps = 1;
  at_r1.publish("r2.drive.cmd", shoal::encode(forward));
  at_r1.publish("r1.drive.cmd", shoal::encode(forward));
  shoal::modem_send_t send{};
  send.destination = "r2";
  send.data = {'h', 'i'};
  send.size = 2;
  at_r1.publish("r1.modem.cmd", shoal::encode(send));
  EXPECT_TRUE(receives<shoal::modem_received_t>(at_r2, "r2.modem", [](const auto& m) { return m.source == "r1"; }));
  EXPECT_TRUE(receives<shoal::sim_state_t>(world, "sim.state", [](const auto& state) {
    EXPECT_NEAR(state.position_m[1][0], 0, 1e-3);  // r2 stands
    return state.position_m[0][0] > 0.5;           // when r1 has driven
  }));
  EXPECT_EQ(control({"quit"}).exit_code, 0);
  EXPECT_EQ(shoal.wait(), 0) << shoal.errors();
  // All that was on the buses: reports of a rover on its own bus only, the truth on the world's bus only.
  const auto received = [](bridges::LcmListener& listener, const std::string& start) {
    bool any = false;
    while (const auto message = listener.next(0ms)) any = any || message->channel.starts_with(start);
    return any;
  };
  EXPECT_FALSE(received(at_r1, "r2.lidar"));
  EXPECT_FALSE(received(at_r2, "sim.state"));
  EXPECT_FALSE(received(world, "r1."));
}

}  // namespace
