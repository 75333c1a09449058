// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/world_state.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <string>

#include "shoal/joint_command_t.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/devices/state_fixture.hpp"
#include "tests/sim/world/busy_worlds.hpp"

namespace {

using namespace busy_worlds;

using test::SavedRun;
using test::TappedWorld;
using testing::HasSubstr;

TEST(WorldSnapshot, AWorldContinuesThoughThingsComeAndGo) {
  SavedRun(busy_world).expect_restored_worlds_go_on_alike({0, 1, 150, 399}, 300);
}

TEST(WorldSnapshot, GravityIsThatOfTheWorldItIsRestoredInUnlessItWasSet) {
  TappedWorld original(busy_world);
  original.world.step();
  const sim::Bytes as_configured = original.world.state().snapshot();
  original.world.physics().set_gravity(3);
  const sim::Bytes as_set = original.world.state().snapshot();
  TappedWorld moon(
      std::string(busy_world)
          .replace(std::string(busy_world).find("{step_s: 0.005}"), 15, "{step_s: 0.005, gravity_mps2: 1.6}"));
  moon.world.state().restore(as_configured);
  EXPECT_EQ(moon.world.physics().gravity_mps2(), 1.6);
  moon.world.state().restore(as_set);
  EXPECT_EQ(moon.world.physics().gravity_mps2(), 3);
  moon.world.state().restore(as_configured);
  EXPECT_EQ(moon.world.physics().gravity_mps2(), 1.6);
}

/// A mast that is joined to the world, and is put elsewhere.
TEST(WorldSnapshot, JointsToTheWorldThatWereMovedComeBack) {
  const std::string yaml = R"(
shoal: 1
physics: {step_s: 0.002}
vehicles:
  - name: mast
    model:
      shoal: 1
      vehicle: mast
      bodies:
        - {name: boom, position_m: [0.5, 0, 1], parts: [{shape: box, size_m: [1, 0.1, 0.1], mass_kg: 2}]}
        - {name: tip, position_m: [1.2, 0, 1], parts: [{shape: box, size_m: [0.4, 0.1, 0.1], mass_kg: 1}]}
      joints:
        - {name: foot, type: hinge, bodies: [boom, world], anchor_m: [0, 0, 1], axis: [0, 1, 0], low_stop: -1.4}
        - {name: wrist, type: hinge, bodies: [boom, tip], anchor_m: [1, 0, 1], axis: [0, 1, 0]}
      devices:
        - {name: foot, type: joint_state, joints: [foot, wrist], rate_hz: 100}
)";
  const auto move = [](TappedWorld& test, int step) {
    if (step == 100) test.world.editor().move_vehicle("mast", sim::make_pose({3, 4, 0}, {0, 0, 0.7}));
    if (step == 300) test.world.editor().move_vehicle("mast", sim::make_pose({-3, 1, 0.2}, {0.2, 0, 2}));
  };
  SavedRun(yaml, move).expect_restored_worlds_go_on_alike({50, 150, 350}, 300);
}

/// A winch turns beyond half a turn to a stop and back, and an arm leaves its stop.
TEST(WorldSnapshot, JointsAtTheirStopsComeBack) {
  const std::string yaml = R"(
shoal: 1
physics: {step_s: 0.01}
vehicles:
  - name: crane
    model:
      shoal: 1
      vehicle: crane
      bodies:
        - {name: drum, position_m: [0, 0, 1], parts: [{shape: box, size_m: [0.3, 0.1, 0.1], mass_kg: 2}]}
        - {name: boom, position_m: [1, 0, 1], parts: [{shape: box, size_m: [1, 0.1, 0.1], mass_kg: 1}]}
      joints:
        - {name: winch, type: hinge, bodies: [drum, world], axis: [0, 0, 1], low_stop: -7, high_stop: 9}
        - {name: foot, type: hinge, bodies: [boom, world], anchor_m: [0.5, 0, 1], axis: [0, 1, 0], high_stop: 0}
      devices:
        - {name: winch, type: joint_motor, joint: winch, max_velocity: 8, max_force: 5}
        - {name: foot, type: joint_motor, joint: foot, max_force: 50}
        - {name: joints, type: joint_state, rate_hz: 100}
)";
  const auto drive = [](TappedWorld& test, int step) {
    shoal::joint_command_t command{};
    command.velocity = step < 200 ? 8 : -8;
    if (step % 200 == 0) test.send("crane.winch.cmd", command);
    command.velocity = -0.5;
    if (step == 150) test.send("crane.foot.cmd", command);
  };
  TappedWorld turned(yaml);
  for (int step = 0; step < 200; ++step) {
    drive(turned, step);
    turned.world.step();
    const double position = turned.world.find_vehicle("crane")->joint("winch").position();
    if (step == 80) {
      ASSERT_GT(position, 5);
      ASSERT_LT(position, 9);
    }
    if (step > 150) {
      ASSERT_NEAR(position, 9, 1e-3);
    }
  }
  SavedRun(yaml, drive).expect_restored_worlds_go_on_alike({80, 150, 151, 201}, 250);
}

/// What the world sends in its last step waits in mailboxes when the snapshot is taken.
TEST(WorldSnapshot, InputsOnTheirWayWithinTheWorldAreKept) {
  const std::string yaml = R"(
shoal: 1
physics: {step_s: 0.01}
objects: [{name: ball, position_m: [0, 0, 100], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1}]}]
events:
  - {name: ask, every: 0.05, do: [{publish: {channel: bell, type: shoal.twist_command_t, value: {}}}]}
  - {name: receive, when: message on bell, do: [{move: {name: ball, position_m: [0, 0, 10], area_m: [4, 4, 4]}}]}
)";
  std::vector<int> each;
  for (int step = 20; step < 30; ++step) each.push_back(step);
  SavedRun(yaml).expect_restored_worlds_go_on_alike(each, 20);
}

TEST_F(DamagedSnapshot, LeavesTheWorldAsItWasWhenItIsCutOff) {
  const std::uint64_t before = world().state().hash();
  sim::Random random(1, "cut");
  random.begin_step(0);
  for (int i = 0; i < 60; ++i) {
    const std::size_t size = random.integer_below(static_cast<std::uint32_t>(good.size()));
    EXPECT_NE(error_of(world(), std::span(good).first(size)), "") << size << " of " << good.size();
    ASSERT_EQ(world().state().hash(), before) << size << " of " << good.size();
  }
  EXPECT_EQ(error_of(world(), good), "");
}

TEST_F(DamagedSnapshot, IsRefusedOrTheWorldContinuesWhenBitsAreFlipped) {
  sim::Random random(1, "flip");
  random.begin_step(0);
  int refused = 0;
  for (int i = 0; i < 60; ++i) {
    sim::Bytes bad = good;
    bad[random.integer_below(static_cast<std::uint32_t>(bad.size()))] ^=
        static_cast<std::byte>(1 << random.integer_below(8));
    refused += !error_of(world(), bad).empty();
    try {
      for (int step = 0; step < 3; ++step) world().step();
    } catch (const sim::PhysicsFault&) {  // a number that was made huge
    }
    ASSERT_EQ(error_of(world(), good), "");
    ASSERT_EQ(world().state().snapshot(), good);
  }
  EXPECT_GT(refused, 0);
}

TEST_F(DamagedSnapshot, OfAnotherWorldIsRefused) {
  std::string other = busy_world;
  other.replace(other.find("seed: 5"), 7, "seed: 6");
  TappedWorld of_other_seed(other);
  EXPECT_THAT(error_of(of_other_seed.world, good), HasSubstr("it is of another world: seed 5, step 5000 us"));
  other = busy_world;
  other.replace(other.find("name: bumper, type: bumper"), 12, "name: buffer");
  TappedWorld of_other_devices(other);
  const std::uint64_t before = of_other_devices.world.state().hash();
  EXPECT_EQ(error_of(of_other_devices.world, good),
            "the snapshot has 'rover1/bumper' where this world has 'rover1/buffer'");
  EXPECT_EQ(of_other_devices.world.state().hash(), before);
}

TEST(WorldSnapshot, AWorldWhosePhysicsBrokeDownGoesBack) {
  TappedWorld test(busy_world);
  for (int i = 0; i < 20; ++i) test.world.step();
  const sim::Bytes good = test.world.state().snapshot();
  const std::uint64_t hash = test.world.state().hash();
  test.world.vehicles().front()->body("hull").set_velocity_W({1e5, 0, 0}, {0, 0, 0});
  EXPECT_THROW(for (int i = 0; i < 3; ++i) test.world.step(), sim::PhysicsFault);
  EXPECT_THROW(test.world.state().snapshot(), sim::SnapshotError);
  test.world.state().restore(good);
  EXPECT_EQ(test.world.state().hash(), hash);
  for (int i = 0; i < 20; ++i) test.world.step();
}

TEST(WorldSnapshot, WithAnEventThatIsLateIsRefused) {
  TappedWorld test("shoal: 1\nphysics: {step_s: 0.01}\nevents: [{name: tick, every: 1, do: [{log: tick}]}]\n");
  for (int i = 0; i < 150; ++i) test.world.step();
  sim::Bytes snapshot = test.world.state().snapshot();
  EXPECT_EQ(error_of(test.world, snapshot), "");
  std::array<std::byte, 1 + sizeof(std::int64_t)> next{std::byte{1}};  // it is there: at 2 s
  const std::int64_t next_us = 2'000'000, long_ago_us = 1'000'000;
  std::memcpy(&next[1], &next_us, sizeof next_us);
  const auto at = std::search(snapshot.begin(), snapshot.end(), next.begin(), next.end());
  ASSERT_NE(at, snapshot.end());
  std::memcpy(&*at + 1, &long_ago_us, sizeof long_ago_us);
  EXPECT_THAT(error_of(test.world, snapshot), HasSubstr("an event that is overdue"));
}

/// The next sample was looked for step by step from wherever a snapshot said, for years.
TEST(WorldSnapshot, WithANextSampleFarAwayIsRefused) {
  TappedWorld test(
      "shoal: 1\nphysics: {step_s: 0.01}\nvehicles: [{name: v, model: {shoal: 1, bodies: [{name: b, kinematic: true, "
      "parts: [{shape: sphere, mass_kg: 1}]}], devices: [{name: imu, type: imu, rate_hz: 10, phase_s: 0.05}]}}]\n");
  for (int i = 0; i < 100; ++i) test.world.step();
  const sim::Bytes good = test.world.state().snapshot();
  // Sample k is at 0.05 s + k / 10 Hz: 10 were taken by step 100, the next is number 10, at step 105.
  const std::array<std::int64_t, 2> planned{11, 105};
  const auto key = std::as_bytes(std::span(planned));
  const auto found = std::search(good.begin(), good.end(), key.begin(), key.end());
  ASSERT_NE(found, good.end());
  const auto at = static_cast<std::size_t>(found - good.begin());
  constexpr std::int64_t far = std::int64_t{1} << 62;
  for (const auto& [samples, next] : {std::pair<std::int64_t, std::int64_t>{11, far},
                                      {far, 105},
                                      {far, far},
                                      {-far, 105},
                                      {0, 105},
                                      {11, 106},
                                      {11, -far}}) {
    sim::Bytes bad = good;
    std::memcpy(&bad[at], &samples, sizeof samples);
    std::memcpy(&bad[at + 8], &next, sizeof next);
    EXPECT_THAT(error_of(test.world, bad), HasSubstr("v/imu: the snapshot has an invalid value: a next sample"))
        << samples << " " << next;
    EXPECT_EQ(test.world.state().snapshot(), good);
  }
}

}  // namespace
