// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/process/process_check.hpp"

#include <gmock/gmock.h>

#include "experiment/process/world_programs.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"
#include "tests/sim/medium/log_capture.hpp"

namespace {

using testing::HasSubstr;

/// A world with vehicles auv, boat1 and boat2, and these processes: a name and its program with its arguments each.
sim::LoadedWorld world(const std::vector<std::pair<std::string, std::string>>& processes,
                       const std::string& more = "") {
  std::string yaml = "shoal: 1\nprocesses:\n";
  for (const auto& [name, program] : processes)
    yaml += "  - {name: " + name + ", client: " + name + ", " + program + "}\n";
  yaml += "vehicles:\n";
  for (const char* name : {"auv", "boat1", "boat2"})
    yaml += std::string("  - {name: ") + name + ", position_m: [0, 0, " +
            (name[0] == 'a'   ? "0"
             : name[4] == '1' ? "10"
                              : "20") +
            "], model: {shoal: 1, vehicle: ball, bodies: [{name: hull, parts: [{shape: sphere, mass_kg: 1}]}]}}\n";
  sim::LoadedWorld loaded =
      sim::load_world_text(yaml + more, "worlds/test.yaml", test::LoadedTestWorld::with_messages({}));
  experiment::read_programs(loaded, {true, {}, {test_support::built_path("bin")}});
  return loaded;
}

std::string warnings_of(const std::vector<std::pair<std::string, std::string>>& processes,
                        const std::string& more = "") {
  const sim::LoadedWorld loaded = world(processes, more);
  const test_support::LogCapture log;
  sim::Warnings warnings;
  experiment::warn_of_processes(loaded, warnings);
  return log.text();
}

std::string craft(const std::string& name, const std::string& args) {
  return "program: shoal-coop-craft, args: {name: " + name + ", " + args + "}";
}

/// A craft on a route that sends in a slot of a cycle.
std::string sender(const std::string& name, int slot, int slots, const std::string& more = "") {
  return craft(name,
               "waypoints_m: [[1, 1]], slot: " + std::to_string(slot) + ", slots: " + std::to_string(slots) + more);
}

const std::string auv = "program: shoal-coop-auv, args: {name: auv, waypoints_m: [[1, 1]]";

TEST(ProcessCheck, ReportsTwoInOneSlot) {
  EXPECT_EQ(warnings_of({{"boat1", sender("boat1", 0, 2)}, {"boat2", sender("boat2", 0, 2)}}),
            "worlds/test.yaml:4:110: process 'boat2': its slot 0/2 is also that of process 'boat1': their packets "
            "collide\n");
  EXPECT_EQ(warnings_of({{"boat1", sender("boat1", 0, 2)}, {"boat2", sender("boat2", 1, 2)}}), "");
}

TEST(ProcessCheck, ReportsSlotsOfCyclesThatRunThroughEachOther) {
  // Cycles of 10 and 15 s have 5 s in common: slots of 5 s meet, wherever they begin.
  EXPECT_THAT(
      warnings_of({{"boat1", sender("boat1", 0, 2, ", slot_s: 5")}, {"boat2", sender("boat2", 1, 3, ", slot_s: 5")}}),
      HasSubstr("its slot 1/3 meets that of process 'boat1' (0/2), whose cycle has another length"));
  // Every second turn of a cycle of 20 s is one of 10 s: 0 to 5 s of each 10, and 5 to 10 s of each 20.
  EXPECT_EQ(
      warnings_of({{"boat1", sender("boat1", 0, 2, ", slot_s: 5")}, {"boat2", sender("boat2", 1, 4, ", slot_s: 5")}}),
      "");
}

TEST(ProcessCheck, ReportsSomeOneToFollowWhoIsNotThere) {
  EXPECT_THAT(warnings_of({{"boat1", craft("boat1", "follow: auw, follow_offset_m: [0, 30]")}}),
              HasSubstr("process 'boat1': it is to follow 'auw', and there is no such vehicle"));
}

TEST(ProcessCheck, ReportsSomeOneToFollowWhoNeverSends) {
  const std::string follower = craft("boat1", "follow: auv, follow_offset_m: [0, 30]");
  EXPECT_THAT(warnings_of({{"auv", auv + "}"}, {"boat1", follower}}),
              HasSubstr("it is to follow 'auv', whose program sends nothing: it has neither 'slot' nor 'random_s'"));
  EXPECT_EQ(warnings_of({{"auv", auv + ", slot: 0, slots: 1}"}, {"boat1", follower}}), "");
  EXPECT_EQ(warnings_of({{"auv", auv + ", random_s: 20}"}, {"boat1", follower}}), "");
  EXPECT_EQ(warnings_of({{"auv", "command: [another_program]"}, {"boat1", follower}}), "") << "it may well speak";
}

TEST(ProcessCheck, ReportsAClientThatJoinsByAnotherName) {
  EXPECT_THAT(warnings_of({{"boat1", sender("boat2", 0, 2)}}),
              HasSubstr("process 'boat1': the run waits for client 'boat1', but its program joins as 'boat2'"));
}

TEST(ProcessCheck, ReportsAMetricOfAChannelOnWhichNoneOfThemPublishes) {
  const std::string metric = "metrics: [{name: error, type: position_error, vehicle: auv, channel: auv.estimat}]\n";
  EXPECT_THAT(
      warnings_of({{"auv", auv + "}"}}, metric),
      HasSubstr("metric 'error': no device and no program of this world publishes on 'auv.estimat'; did you mean "
                "'auv.estimate'?"));
  EXPECT_EQ(warnings_of({{"auv", auv + "}"}, {"other", "command: [another_program]"}}, metric), "");
}

TEST(ProcessCheck, ReportsAnEventOnAChannelWithoutSubscriber) {
  const auto event = [](const std::string& channel) {
    return "events: [{name: go, at: 1, do: [{one_of: {choices: [[{publish: {channel: " + channel +
           ", type: shoal.twist_command_t}}]]}}]}]\n";
  };
  EXPECT_THAT(warnings_of({{"auv", auv + "}"}}, event("auv.estimat")),
              HasSubstr("event 'go': no device and no program of this world subscribes to 'auv.estimat'"));
  EXPECT_THAT(warnings_of({}, event("nothing")), HasSubstr("event 'go': no device and no program"));
  EXPECT_EQ(warnings_of({{"auv", auv + "}"}, {"other", "command: [another_program]"}}, event("nothing")), "");
  EXPECT_EQ(warnings_of({}, event("received") + "metrics: [{name: m, type: messages, channel: received}]\n"), "");
}

TEST(ProcessCheck, ReportsAProgramThatIsNotThere) {
  const auto missing = [](const std::string& program) {
    const sim::LoadedWorld loaded = world({{"auv", "command: [" + program + "]"}});
    const test_support::LogCapture log;
    sim::Warnings warnings;
    experiment::warn_of_missing_programs(loaded, warnings);
    return log.text();
  };
  EXPECT_EQ(missing("shoal-coop-auw, --name, auv"),
            "worlds/test.yaml:3:40: process 'auv': there is no program 'shoal-coop-auw' beside shoal or in PATH\n");
  EXPECT_THAT(missing("/nowhere/program"), HasSubstr("process 'auv': there is no program '/nowhere/program'"));
  EXPECT_EQ(missing("sh, -c, \"true\""), "");
  EXPECT_EQ(missing("/bin/sh"), "");
}

TEST(ProcessCheck, HintsAtADeclarationThatACommandDoesNotUse) {
  const auto hint = [](const std::string& program) {
    const sim::LoadedWorld loaded = world({{"auv", program}});
    const test_support::LogCapture log;
    sim::Warnings warnings;
    experiment::warn_of_unchecked_arguments(loaded, warnings);
    return log.text();
  };
  EXPECT_EQ(hint("command: [" + test_support::built_path("bin/shoal-coop-auv") + ", --name, auv]"),
            "worlds/test.yaml:3:40: process 'auv': the arguments in 'command' are not checked; those of 'program: " +
                test_support::built_path("bin/shoal-coop-auv") + "' with 'args:' are, by its declaration\n");
  EXPECT_EQ(hint("command: [sh]"), "");
  EXPECT_EQ(hint(auv + "}"), "");
}

using testing::ElementsAre;
using testing::IsEmpty;

/// Published and subscribed channels of client `pilot` in a world with two boats that carry an IMU and a modem.
struct PilotWorld {
  explicit PilotWorld(const std::string& more = "")
      : loaded(sim::load_world_text("shoal: 1\nmedium: {water: {}}\nvehicles:\n" + boat("a1", 0) + boat("a2", 9) + more,
                                    "worlds/test.yaml", test::LoadedTestWorld::with_messages({}))) {
    experiment::read_programs(loaded, {true, {}, {test_support::built_path("bin")}});
  }
  static std::string boat(const std::string& name, int east_m) {
    return "  - {name: " + name + ", position_m: [" + std::to_string(east_m) +
           ", 0, 0], model: {shoal: 1, vehicle: ball, bodies: [{name: hull, parts: [{shape: sphere, mass_kg: 500}]}], "
           "devices: [{name: imu, type: imu, truth: true}, {name: modem, type: acoustic_modem}]}}\n";
  }
  /// `spawned`: name of a vehicle as a1 that is added to the run; empty: none.
  std::vector<std::string> warnings(bool is_recorded = false, const std::string& spawned = "") const {
    sim::InProcessBus bus;
    sim::World world(loaded.config, bus);
    if (!spawned.empty()) {
      sim::VehicleInstance instance = loaded.config.vehicles.front();
      instance.name = spawned;
      instance.X_WV = sim::make_pose({-9, 0, 0}, sim::Vector3d::Zero());
      world.editor().add_vehicle(instance);
    }
    sim::Warnings warnings;
    experiment::warn_of_channels(loaded, world, use, is_recorded, warnings);
    return warnings.lines();
  }
  void publishes(const std::string& channel, bool is_read = false) { use.add_published("pilot", channel, is_read); }
  void subscribes(const std::string& channel, bool has_received = false) {
    use.add_subscribed("pilot", channel, has_received);
  }

  sim::LoadedWorld loaded;
  bridges::ChannelUse use;
};

TEST(ChannelCheck, NamesTheChannelForCommandsOfADevice) {
  PilotWorld world;
  world.publishes("a1.modem", true);  // the pilot itself subscribes to it
  world.publishes("a1.modem", true);
  world.publishes("a1.modem.cmd", true);
  EXPECT_THAT(world.warnings(true),
              ElementsAre("client 'pilot': it published 2 messages on 'a1.modem', where device 'a1/modem' reports; it "
                          "takes commands on 'a1.modem.cmd'"));
}

TEST(ChannelCheck, NamesTheChannelThatAMisspeltOneMeans) {
  PilotWorld world;
  world.publishes("a1.modm.cmd");
  EXPECT_THAT(world.warnings(true),
              ElementsAre("client 'pilot': it published 1 message on 'a1.modm.cmd', which nothing "
                          "reads; did you mean 'a1.modem.cmd'?"));
}

TEST(ChannelCheck, NamesWhatNothingReceivesUnlessItIsRecorded) {
  PilotWorld world;
  world.publishes("a1.innovations");
  world.publishes("a1.particles");
  EXPECT_THAT(world.warnings(), ElementsAre("client 'pilot': no device, metric or client of this run receives what it "
                                            "published on 'a1.innovations', 'a1.particles'"));
  EXPECT_THAT(world.warnings(true), IsEmpty());
}

/// The names of a swarm differ by one character.
TEST(ChannelCheck, DoesNotTakeTheChannelOfAnotherVehicleForAMisspeltOne) {
  PilotWorld world("metrics: [{name: error, type: position_error, vehicle: a1, channel: a1.dead_reckoning}]\n");
  world.publishes("a1.dead_reckoning", true);
  world.publishes("a2.dead_reckoning");
  EXPECT_THAT(world.warnings(true), IsEmpty());
}

TEST(ChannelCheck, NamesASubscriptionToAChannelOnWhichNothingIsPublished) {
  PilotWorld world;
  world.subscribes("a1/imu");
  world.subscribes("a1.imu");    // nothing yet
  world.subscribes("a2.modem");  // perhaps no one sends
  world.subscribes("other", true);
  world.subscribes("sim.clock");
  EXPECT_THAT(world.warnings(),
              ElementsAre("client 'pilot': it subscribes to 'a1/imu', on which nothing was published; "
                          "did you mean 'a1.imu'?"));
}

TEST(ChannelCheck, KnowsTheTruthOfASpawnedVehicle) {
  PilotWorld world;
  world.subscribes("a3.imu.truth");
  EXPECT_EQ(world.warnings().size(), 1u);
  EXPECT_THAT(world.warnings(false, "a3"), IsEmpty());
}

TEST(ChannelCheck, IsSilentAboutChannelsThatAProgramDeclares) {
  PilotWorld world(
      "processes: [{name: a1, client: a1, program: shoal-coop-auv, args: {name: a1, waypoints_m: [[1, 1]]}}]\n");
  world.use.add_subscribed("a1", "a1.dvl", false);
  world.use.add_subscribed("a1", "a1.camera", false);
  world.use.add_published("a1", "a1.dead_reckoning", false);
  EXPECT_THAT(world.warnings(),
              ElementsAre("client 'a1': it subscribes to 'a1.camera', on which nothing was published"));
}

}  // namespace
