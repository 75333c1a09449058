// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "bridges/log/run_journal.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/sim_vehicle_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/state/state_archive.hpp"
#include "sim/world/world_state.hpp"
#include "tests/bridges/control/service_fixture.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

// Vehicles that clients bring, by way of requests on sim.control.

namespace {

using testing::HasSubstr;

/// A world with a ground, one box vehicle `a` and a service; vehicle files come from vehicles/.
struct Host : lcm_test::ServedWorld {
  explicit Host(const std::string& more = "")
      : ServedWorld(
            "shoal: 1\nphysics: {step_s: 0.01}\nobjects: [{name: ground, fixed: true, parts: [{shape: plane}]}, {name: "
            "crate, position_m: [9, 9, 1], parts: [{shape: box, mass_kg: 3}]}]\nvehicles: [{name: a, position_m: [-9, "
            "0, "
            "1], model: {shoal: 1, bodies: [{name: b, parts: [{shape: box, mass_kg: 1}]}]}}]\n" +
            more) {}

  shoal::sim_control_reply_t request_reply(const std::string& command, const std::string& text,
                                           const std::string& client = "pilot") {
    return ServedWorld::request_reply(command, 0, text, client);
  }

  test::Listener<shoal::sim_vehicle_t> vehicles{test, "sim.vehicle"};
};

TEST(Spawn, AVehicleFromAFileDrivesAndReports) {
  Host host;
  const auto reply = host.request_reply("spawn", "{name: r1, file: rover_small.yaml, position_m: [3, 0, 0]}");
  ASSERT_TRUE(reply.ok) << reply.text;
  EXPECT_THAT(reply.text, HasSubstr("r1: drive (takes shoal.twist_command_t"));
  EXPECT_THAT(reply.text, HasSubstr("lidar (shoal.planar_lidar_t on r1.lidar, 10 Hz)"));
  const auto reported = host.vehicles.last();
  EXPECT_EQ(reported.vehicle, "r1");
  EXPECT_TRUE(reported.present);
  EXPECT_EQ(reported.client, "pilot");
  EXPECT_EQ(reported.device, (std::vector<std::string>{"drive", "lidar"}));
  EXPECT_EQ(reported.command_channel, (std::vector<std::string>{"r1.drive.cmd", ""}));
  EXPECT_EQ(reported.report_channel, (std::vector<std::string>{"", "r1.lidar"}));
  EXPECT_EQ(reported.rate_hz[1], 10);
  test::Listener<shoal::planar_lidar_t> scans(host.test, "r1.lidar");
  shoal::twist_command_t command{};
  command.forward_mps = 1;
  host.test.send("r1.drive.cmd", command);
  host.test.run_for(3);
  // 1 m/s after 0.5 s of acceleration at 2 m/s^2, in 3 s: 2.75 m.
  EXPECT_NEAR(host.test.world.find_vehicle("r1")->X_WV().translation().x(), 5.75, 0.1);
  EXPECT_EQ(scans.take_all().size(), 30u);
}

TEST(Spawn, AVehicleAsTextIsBuiltAndRemovedAndBuiltAgain) {
  Host host;
  const std::string text =
      "{name: box1, position_m: [0, 0, 5], model: {shoal: 1, bodies: [{name: b, parts: [{shape: sphere, mass_kg: "
      "1}]}], "
      "devices: [{name: gps, type: gps}]}}";
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(host.request_reply("spawn", text).ok);
    host.test.run_for(0.1);
    // The body falls for 0.1 s; the step is exact for constant gravity.
    EXPECT_NEAR(host.test.world.find_vehicle("box1")->X_WV().translation().z(), 5 - 9.80665 * 0.1 * 0.1 / 2, 1e-9);
    ASSERT_TRUE(host.request_reply("remove", "box1").ok);
    EXPECT_FALSE(host.vehicles.last().present);
    EXPECT_EQ(host.test.world.find_vehicle("box1"), nullptr);
    host.test.run_for(0.1);
  }
  EXPECT_EQ(host.test.world.devices().size(), 1u);  // the number was used again
}

TEST(Spawn, RepeatsItselfBitForBit) {
  const auto hash = [] {
    Host host;
    host.test.run_for(0.5);
    EXPECT_TRUE(host.request_reply("spawn", "{name: r1, file: rover_gps.yaml, position_m: [-3, 0, 0]}").ok);
    EXPECT_TRUE(host.request_reply("spawn", "{name: r2, file: rover_gps.yaml, position_m: [-3, 4, 0]}").ok);
    host.test.run_for(0.5);
    EXPECT_TRUE(host.request_reply("remove", "r1").ok);
    EXPECT_TRUE(host.request_reply("spawn", "{name: r3, file: rover_swarm.yaml, position_m: [-3, 8, 0]}").ok);
    host.test.run_for(0.5);
    return host.test.world.state().hash();
  };
  EXPECT_EQ(hash(), hash());
}

TEST(Spawn, ErrorsReadAsThoseOfFiles) {
  Host host;
  const auto refused = [&](const std::string& text) {
    const auto reply = host.request_reply("spawn", text);
    EXPECT_FALSE(reply.ok);
    EXPECT_EQ(host.vehicles.take_all().size(), 0u);
    return reply.text;
  };
  EXPECT_THAT(refused("{name: [}"), HasSubstr("spawn:1:"));
  EXPECT_THAT(refused("{nme: x}"), HasSubstr("spawn:1:2: unknown key 'nme'"));
  EXPECT_THAT(refused("{name: x, file: nosuch.yaml}"),
              HasSubstr("vehicle 'x': there is no vehicle file 'nosuch.yaml'"));
  EXPECT_THAT(refused("{name: x, file: ../../etc/passwd}"), HasSubstr("'file' must be a bare file name"));
  EXPECT_THAT(refused("{name: a, file: rover.yaml}"), HasSubstr("there already is a vehicle of this name"));
  EXPECT_THAT(refused("{name: crate, file: rover.yaml}"), HasSubstr("there already is an object of this name"));
  EXPECT_THAT(refused("{name: x, model: {shoal: 1, bodies: [{name: b, parts: [{shape: mesh, mesh: /etc/passwd}]}]}}"),
              HasSubstr("spawn:1:76: vehicle 'x': body 'b': part 1: 'mesh' cannot be used in a request from the bus"));
  EXPECT_THAT(refused("{name: x, file: rover.yaml, overrides: {devices.modem.serial: {path: /tmp/x}}}"),
              HasSubstr("'serial' cannot be used"));
  EXPECT_THAT(refused("{name: x, model: {shoal: 1, bodies: [{name: b, parts: [{shape: box}]}]}}"),
              HasSubstr("spawn:1:56: body 'x/b': has no mass"));
  EXPECT_THAT(refused("{name: x, file: rover.yaml, count: 5}"), HasSubstr("'count' must be 1"));
  EXPECT_THAT(refused(std::string(2 << 20, ' ')), HasSubstr("at most 1 MiB"));
  // The world continues as it was.
  EXPECT_EQ(host.test.world.vehicles().size(), 1u);
  EXPECT_NO_THROW(host.test.run_for(0.1));
}

TEST(Spawn, OnlyWhatIsAVehicleIsWrittenDown) {
  Host host;
  bridges::JournalPorts ports;
  bridges::RunJournal journal(host.test.bus, host.test.world, ports);
  bridges::SimService service(host.test.bus, host.test.bus, host.test.world, host.control, host.lockstep,
                              {"{}", "test"}, {.journal = &journal});
  host.answering = &service;
  std::vector<std::string> written;
  journal.set_listener([&](std::int64_t, const bridges::RunJournal::Input& input) {
    written.emplace_back(reinterpret_cast<const char*>(input.payload.data()), input.payload.size());
  });
  journal.start();
  // worlds/ackermann_track.yaml is YAML that lies beside the world, and no vehicle.
  EXPECT_FALSE(host.request_reply("spawn", "{name: x, file: ackermann_track.yaml}").ok);
  EXPECT_FALSE(host.request_reply("spawn", "{name: x, file: .hidden.yaml}").ok);
  EXPECT_THAT(written, testing::IsEmpty());
  EXPECT_TRUE(host.request_reply("spawn", "{name: x, file: rover_small.yaml, position_m: [3, 0, 0]}").ok);
  ASSERT_EQ(written.size(), 1u);
  EXPECT_THAT(written[0], testing::AllOf(HasSubstr("model"), testing::Not(HasSubstr("rover_small.yaml"))));
}

TEST(Spawn, APlaceThatIsTakenIsRefused) {
  Host host;
  EXPECT_THAT(host.request_reply("spawn", "{name: x, file: rover_small.yaml, position_m: [-9, 0.3, 0.9]}").text,
              HasSubstr("spawn:1:1: vehicle 'x': 'position_m' is taken: it would stand 0."));
  EXPECT_EQ(host.test.world.vehicles().size(), 1u);
  EXPECT_TRUE(host.request_reply("spawn", "{name: x, file: rover_small.yaml, position_m: [-6, 0, 0]}").ok);
}

TEST(Spawn, TheSurfacesOfOthersStayAsTheyAre) {
  Host host;
  const auto ball = [](const std::string& contacts) {
    return "{name: x, position_m: [0, 0, 3], model: {shoal: 1, materials: [{name: ice}], contacts: [" + contacts +
           "], bodies: [{name: b, parts: [{shape: sphere, mass_kg: 1, material: ice}]}]}}";
  };
  EXPECT_THAT(host.request_reply("spawn", ball("{between: [default, any], friction: 0}")).text,
              HasSubstr("its contact between 'default' and 'any' would change the surfaces of others"));
  EXPECT_TRUE(host.request_reply("spawn", ball("{between: [ice, any], friction: 0}")).ok);
}

TEST(Spawn, NeitherFilesNorEndlessTextComeByAnAction) {
  Host host;
  EXPECT_THAT(
      host.request_reply("do", "{add: {object: {name: m, fixed: true, parts: [{shape: mesh, mesh: /etc/passwd}]}}}")
          .text,
      HasSubstr("'mesh' cannot be used in a request from the bus"));
  EXPECT_THAT(host.request_reply("do", std::string(2 << 20, ' ')).text, HasSubstr("at most 1 MiB"));
  EXPECT_THAT(host.request_reply("do", "{publish: {channel: sim.control, type: shoal.utime_t, value: {}}}").text,
              HasSubstr("sim.* belongs to the simulator"));
  EXPECT_TRUE(host.request_reply("do", "{move: {name: crate, position_m: [5, 5, 1]}}").ok);
}

TEST(Spawn, ADeviceOnTheWorldIsRefused) {
  Host host;
  EXPECT_THAT(
      host.request_reply("spawn",
                         "{name: x, position_m: [0, 0, 3], model: {shoal: 1, bodies: [{name: b, parts: [{shape: "
                         "box, mass_kg: 1}]}], devices: [{name: g, type: gps, body: world}]}}")
          .text,
      HasSubstr("'body' must be a body of the vehicle, got 'world'"));
}

TEST(Spawn, WhatAnActionTakesAwayIsNotifiedToo) {
  Host host;
  ASSERT_TRUE(host.request_reply("do", "{remove: a}").ok);
  const auto reported = host.vehicles.last();
  EXPECT_EQ(reported.vehicle, "a");
  EXPECT_FALSE(reported.present);
}

TEST(Spawn, LimitsProtectTheRun) {
  Host host("limits: {vehicles: 3, bodies_per_vehicle: 2, devices_per_vehicle: 2}\n");
  EXPECT_THAT(host.request_reply("spawn", "{name: x, file: rover_small.yaml}").text,
              HasSubstr("at most 2 bodies in a vehicle are allowed (limits of the world), got 3"));
  const auto box = [](const std::string& name) {
    return "{name: " + name + ", position_m: [0, " + std::to_string(name.back()) +
           ", 1], model: {shoal: 1, bodies: [{name: b, parts: [{shape: box, mass_kg: 1}]}]}}";
  };
  EXPECT_TRUE(host.request_reply("spawn", box("x1")).ok);
  EXPECT_TRUE(host.request_reply("spawn", box("x2")).ok);
  EXPECT_THAT(host.request_reply("spawn", box("x3")).text, HasSubstr("at most 3 vehicles are allowed"));
}

TEST(Spawn, AFloodIsAnsweredInPortions) {
  Host host;
  for (int i = 0; i < 300; ++i) {
    shoal::sim_control_request_t request{};
    request.command = "spawn";
    request.text = "{name: x";
    host.test.send("sim.control", request);
  }
  host.service.handle_requests();
  EXPECT_EQ(host.replies.take_all().size(), 50u);
  for (int i = 0; i < 5; ++i) host.service.handle_requests();
  EXPECT_EQ(host.replies.take_all().size(), 250u);
  EXPECT_EQ(host.service.bad_messages(), 300);
}

TEST(Spawn, WhatAMetricScoresStays) {
  Host host("metrics: [{name: m, type: position_error, vehicle: a, channel: est}]\n");
  EXPECT_EQ(host.request_reply("remove", "a").text, "vehicle 'a' cannot be removed: metric 'm' scores it");
  EXPECT_EQ(host.request_reply("remove", "nobody").text, "there is no object 'nobody'");
  EXPECT_EQ(host.request_reply("describe", "nobody").text, "there is no vehicle 'nobody'");
  EXPECT_TRUE(host.request_reply("describe", "a").ok);
  EXPECT_TRUE(host.request_reply("remove", "crate").ok);
}

TEST(Spawn, AVehicleGoesWithItsClientWhenItAskedForThat) {
  Host host;
  const std::string with = "{name: w, with_client: true, file: rover_small.yaml, position_m: [0, 5, 0]}";
  ASSERT_TRUE(host.request_reply("spawn", with, "one").ok);
  ASSERT_TRUE(host.request_reply("spawn", "{name: s, file: rover_small.yaml, position_m: [0, -5, 0]}", "one").ok);
  EXPECT_TRUE(host.request_reply("leave", "", "one").ok);
  EXPECT_EQ(host.test.world.find_vehicle("w"), nullptr);
  EXPECT_NE(host.test.world.find_vehicle("s"), nullptr);
  // Its process ended.
  ASSERT_TRUE(host.request_reply("spawn", with, "two").ok);
  host.service.client_exited("two");
  EXPECT_EQ(host.test.world.find_vehicle("w"), nullptr);
}

TEST(Spawn, AVehicleGoesWhenItsClientIsSilentForTooLong) {
  Host host;
  ASSERT_TRUE(
      host.request_reply("spawn", "{name: w, with_client: true, alive_timeout_s: 0.1, file: rover_small.yaml}", "one")
          .ok);
  EXPECT_TRUE(lcm_test::await([&] {
    host.service.handle_requests();
    return host.test.world.find_vehicle("w") == nullptr;
  }));
}

/// The world and whose vehicles there are, as a snapshot has them.
struct Moment {
  explicit Moment(Host& host) : world(host.test.world.state().snapshot()) {
    auto archive = sim::StateArchive::saver();
    archive.section("owners");
    host.service.visit_state(archive);
    archive.end();
    owners = archive.take_bytes();
  }
  void restore(Host& host) const {
    host.test.world.state().restore(world);
    auto archive = sim::StateArchive::restorer(owners);
    archive.section("owners");
    host.service.visit_state(archive);
  }
  sim::Bytes world, owners;
};

TEST(Rewind, TheWorldReceivesOfVehiclesAsItDidTheFirstTime) {
  Host host;
  const Moment before(host);
  const std::string guest =
      "{name: g, position_m: [0, 0, 5], model: {shoal: 1, bodies: [{name: b, parts: [{shape: sphere, mass_kg: 1}]}]}}";
  ASSERT_TRUE(host.request_reply("spawn", guest).ok);
  ASSERT_TRUE(host.request_reply("describe", "g").ok);
  ASSERT_TRUE(host.request_reply("remove", "g").ok);
  const auto first = host.vehicles.take_all();
  ASSERT_EQ(first.size(), 3u);
  before.restore(host);
  host.service.set_muted(true);
  host.service.publish_step();
  EXPECT_THAT(host.vehicles.take_all(), testing::IsEmpty());
  for (const auto& [command, text] :
       {std::pair<std::string, std::string>{"spawn", guest}, {"describe", "g"}, {"remove", "g"}}) {
    shoal::sim_control_request_t request{};
    request.client = "pilot";
    request.command = command;
    request.text = text;
    EXPECT_NO_THROW(host.service.execute_again(request)) << command;
  }
  const auto again = host.vehicles.take_all();
  ASSERT_EQ(again.size(), first.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(shoal::encode(again[i]), shoal::encode(first[i])) << i;
  host.service.set_muted(false);
  host.service.report_changes();
  EXPECT_THAT(host.vehicles.take_all(), testing::IsEmpty());  // others know all that
}

TEST(Rewind, OthersAreNotifiedOfWhatIsGoneByIt) {
  Host host;
  const Moment before(host);
  ASSERT_TRUE(host.request_reply("spawn", "{name: r1, file: rover_small.yaml, position_m: [3, 0, 0]}").ok);
  host.vehicles.take_all();
  before.restore(host);
  host.service.report_changes();
  const auto reported = host.vehicles.take_all();
  ASSERT_EQ(reported.size(), 1u);
  EXPECT_EQ(reported[0].vehicle, "r1");
  EXPECT_FALSE(reported[0].present);
  EXPECT_EQ(reported[0].client, "pilot");
}

}  // namespace
