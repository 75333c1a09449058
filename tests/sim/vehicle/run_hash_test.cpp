// SPDX-License-Identifier: BSD-3-Clause
// WorldState::run_hash(): over every step and message of a run, and over nothing that observation switches on.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "shoal/acoustic_received_t.hpp"
#include "shoal/imu_t.hpp"
#include "shoal/utime_t.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/comms/modem_fixture.hpp"

namespace {

struct Hashes {
  std::uint64_t run, state;
  bool operator==(const Hashes&) const = default;
};

Hashes of(const sim::World& world) {
  return {world.state().run_hash(), world.state().hash()};
}

/// Two modems 300 m apart that lose nothing: a speaks once.  `keys`: of the modems.
std::string two_modems(const std::string& fading, const std::string& keys = "") {
  const std::string modem = "{name: modem, type: acoustic_modem" + keys + "}";
  return test::modem_sea({{"a", "[0, 0, -20]", modem}, {"b", "[300, 0, -20]", modem}},
                         "acoustics: {fading: " + fading + "}\n");
}

TEST(RunHash, ReportsRunsApartThatDifferOnTheirWayAndEndInOneState) {
  std::set<std::uint64_t> run_hashes, state_hashes;
  std::set<double> snrs;
  for (const char* fading : {"{type: none}", "{type: log_normal, std_dB: 3}", "{type: log_normal, std_dB: 6}"}) {
    test::TestWorld test(two_modems(fading));
    test::Listener<shoal::acoustic_received_t> at_b(test, "b.modem");
    test.send("a.modem.cmd", test::bytes_to("hello"));
    test.run_for(6);
    const auto received = at_b.take_all();
    ASSERT_EQ(received.size(), 1u) << fading;
    snrs.insert(received[0].snr_db);
    run_hashes.insert(test.world.state().run_hash());
    state_hashes.insert(test.world.state().hash());
  }
  EXPECT_EQ(snrs.size(), 3u);
  EXPECT_EQ(state_hashes.size(), 1u) << "nothing is left of the packet: the state hash cannot tell";
  EXPECT_EQ(run_hashes.size(), 3u);
}

/// A thing that is moved away and back between two whole states: only its motion in between differs.
TEST(RunHash, HasTheMotionOfEveryBodyAfterEachStep) {
  const auto run = [](bool moved) {
    test::TestWorld test(test::box_world("", "{step_s: 0.01, gravity_mps2: 0}"));
    for (int step = 0; step < 20; ++step) {
      if (moved && step == 13) test.world.editor().move_vehicle("r1", sim::make_pose({1, 0, 0}, {0, 0, 0}));
      if (moved && step == 14) test.world.editor().move_vehicle("r1", sim::Pose::Identity());
      test.world.step();
    }
    return of(test.world);
  };
  const Hashes straight = run(false), other = run(true);
  EXPECT_EQ(straight.state, other.state);
  EXPECT_NE(straight.run, other.run);
}

TEST(RunHash, HasTheStateNow) {
  test::TestWorld test(test::box_world(""));
  test.run_for(0.05);
  const Hashes before = of(test.world);
  test.world.editor().move_vehicle("r1", sim::make_pose({1, 0, 0}, {0, 0, 0}));
  EXPECT_NE(test.world.state().run_hash(), before.run) << "nothing was stepped or published";
}

TEST(RunHash, HasWhatEventsPublishAndNotWhatIsPublishedBesideTheWorld) {
  const auto run = [](const std::string& events, bool beside) {
    test::TestWorld test(test::box_world("", "{step_s: 0.01}", events));
    shoal::utime_t message{};
    for (int step = 0; step < 30; ++step) {
      if (beside) test.send("sim.clock", message);
      test.world.step();
    }
    return of(test.world);
  };
  const auto event = [](int mps) {
    return "events: [{name: hail, at: 0.1, do: [{publish: {channel: shore.hail, type: shoal.twist_command_t, value: "
           "{forward_mps: " +
           std::to_string(mps) + "}}}]}]\n";
  };
  EXPECT_EQ(run(event(1), false), run(event(1), true));
  const Hashes one = run(event(1), false), two = run(event(2), false);
  EXPECT_EQ(one.state, two.state);
  EXPECT_NE(one.run, two.run);
}

/// `more`: keys of the world; `truth`: of every sensor.
std::string sensed_world(const std::string& truth, const std::string& more = "") {
  return test::rover_world(
      "        - {name: imu, type: imu, rate_hz: 50, gyro_noise: {gaussian_std: 0.01}, latency_s: 0.02, truth: " +
          truth + "}\n        - {name: lidar, type: lidar, rate_hz: 10, beams: 900, truth: " + truth +
          "}\n        - {name: odometry, type: odometry, left_joint: left, right_joint: right, track_m: 0.5, truth: " +
          truth + "}\n        - {name: clock, type: clock, rate_hz: 5}\n",
      "", "", more);
}

Hashes run_of(const std::string& yaml, int threads = 1) {
  test::TestWorld test(yaml);
  test.world.use_threads(threads);
  test.run_for(1);
  return of(test.world);
}

TEST(RunHash, IsTheSameWhoeverObserves) {
  const Hashes plain = run_of(sensed_world("false"));
  EXPECT_EQ(run_of(sensed_world("true")), plain) << "with truth channels";
  EXPECT_EQ(run_of(sensed_world("false", "state_rate_hz: 100\n")), plain);
  EXPECT_EQ(run_of(sensed_world("false", "run: {hash_every_steps: 1, track_rate_hz: 50}\n")), plain);
}

TEST(RunHash, IsTheSameWhenSomeOneBeginsToObserve) {
  const Hashes plain = run_of(sensed_world("false"));
  test::TestWorld test(sensed_world("false"));
  test::Listener<shoal::imu_t> truth(test, "r1.imu.truth");
  test.run_for(0.333);
  for (const char* device : {"r1/imu", "r1/lidar", "r1/odometry"})
    EXPECT_EQ(test.change(device, "{truth: true}"), "") << device;
  test.run_for(1 - 0.333);
  EXPECT_GT(truth.take_all().size(), 10u);
  EXPECT_EQ(of(test.world), plain);
}

TEST(RunHash, IsTheSameWithAnyThreads) {
  const std::string yaml = sensed_world("false");
  const Hashes one = run_of(yaml);
  for (const int threads : {2, 8}) EXPECT_EQ(run_of(yaml, threads), one) << threads;
}

/// The others' noise is as it was: what differs are the messages of one device.
TEST(RunHash, HasTheMessagesOfEveryDeviceOnEveryBus) {
  const Hashes plain = run_of(sensed_world("false"));
  EXPECT_NE(run_of(sensed_world("false", "channels: {report: \"other.{vehicle}.{device}\"}\n")).run, plain.run);
  const auto on_a_bus = [](const std::string& noise) {
    sim::InProcessBus bus, own;
    const auto loaded = sim::load_world_text(
        "shoal: 1\nphysics: {gravity_mps2: 0}\nbuses: [{name: own, lcm_url: \"udpm://239.255.76.67:7667\"}]\n"
        "vehicles:\n  - {name: r1, bus: own, model: {shoal: 1, vehicle: box, bodies: [{name: hull, parts: [{shape: "
        "box, size_m: [1, 1, 1], mass_kg: 1}]}], devices: [{name: modem, type: modem, range_m: 10}, {name: imu, type: "
        "imu, rate_hz: 10, latency_s: 0.03, gyro_noise: {gaussian_std: " +
            noise + "}}]}}\n",
        "worlds/test.yaml", test::LoadedTestWorld::with_messages({}));
    sim::World world(loaded.config, bus, {}, [&](const std::string&) -> sim::Bus& { return own; });
    while (world.now() < sim::from_seconds(0.5)) world.step();
    return of(world);
  };
  EXPECT_EQ(on_a_bus("0.1"), on_a_bus("0.1"));
  EXPECT_NE(on_a_bus("0.1").run, on_a_bus("0.2").run);
}

TEST(RunHash, GoesBackAndOnWithASnapshot) {
  test::TestWorld straight(sensed_world("false"));
  test::TestWorld test(sensed_world("false")), fresh(sensed_world("false"));
  straight.run_for(1);
  test.run_for(0.305);
  const sim::Bytes snapshot = test.world.state().snapshot();
  const Hashes then = of(test.world);
  test.world.editor().move_vehicle("r1", sim::make_pose({0, 0, 1}, {0, 0, 0}));
  ASSERT_EQ(test.change("r1/imu", "{rate_hz: 7}"), "");  // the world is built again to go back behind it
  test.run_for(0.2);
  for (sim::World* world : {&test.world, &fresh.world}) {
    world->state().restore(snapshot);
    EXPECT_EQ(of(*world), then);
    while (world->now() < sim::from_seconds(1)) world->step();
    EXPECT_EQ(of(*world), of(straight.world)) << (world == &fresh.world ? "in a fresh world" : "in the same");
  }
}

}  // namespace
