// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/process/channel_check.hpp"

#include <gmock/gmock.h>

#include "experiment/process/world_programs.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"

namespace {

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
