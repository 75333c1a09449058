// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <tuple>

#include "shoal/joint_command_t.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/devices/state_fixture.hpp"

namespace {

using test::SavedRun;
using test::TappedWorld;
using testing::HasSubstr;

/// Boxes that fall onto each other, objects of two bodies, rovers, an actor, events: things that come and go while it
/// runs.
const char* const busy_world = R"(
shoal: 1
physics: {step_s: 0.005}
materials: [{name: rubber}]
contacts: [{between: [rubber, any], friction: 0.8}]
run: {seed: 5}
medium: {wind: {speed_mps: 3, gusts: {}}}
objects:
  - {name: ground, fixed: true, parts: [{shape: plane}]}
  - {name: gate, position_m: [6, 0, 0.5], parts: [{shape: box, size_m: [0.2, 2, 1]}]}
  - {name: crate, position_m: [0, 4, 0.3], count: 5, placement: {pattern: line, spacing_m: 0.3},
     parts: [{shape: box, size_m: [0.4, 0.4, 0.4], mass_kg: 2}]}
  - {name: late, present: false, position_m: [2, 3, 1], parts: [{shape: sphere, radius_m: 0.2, mass_kg: 1}]}
  - name: swing
    position_m: [-6, 4, 0]
    bodies:
      - {name: rope, position_m: [0.5, 0, 2], parts: [{shape: box, size_m: [1, 0.1, 0.1], mass_kg: 2}]}
      - {name: seat, position_m: [1.2, 0, 2], parts: [{shape: box, size_m: [0.4, 0.1, 0.1], mass_kg: 1}]}
    joints:
      - {name: top, type: hinge, bodies: [rope, world], anchor_m: [0, 0, 2], axis: [0, 1, 0], damping: 0.1}
      - {name: knee, type: hinge, bodies: [rope, seat], anchor_m: [1, 0, 2], axis: [0, 1, 0], low_stop: -0.5}
  - name: late_swing
    present: false
    position_m: [-6, -4, 0]
    bodies: [{name: rope, position_m: [0.5, 0, 2], parts: [{shape: box, size_m: [1, 0.1, 0.1], mass_kg: 2}]}]
    joints: [{name: top, type: hinge, bodies: [rope, world], anchor_m: [0, 0, 2], axis: [0, 1, 0]}]
actors: [{name: porter, object: gate, points: [[6, 0, 0.5], [6, 3, 0.5]], ends: reverse, speed_mps: 0.7}]
zones: [{name: dock, shape: box, position_m: [0, 0, 0], size_m: [3, 3, 3], finish: true, speed_limit_mps: 0.1}]
vehicles:
  - name: rover
    count: 2
    position_m: [0, -2, 0]
    placement: {pattern: line, spacing_m: 2}
    model: &model
      shoal: 1
      vehicle: cart
      clock: {preset: tcxo, update_s: 0.1}
      bodies:
        - {name: hull, position_m: [0, 0, 0.2], parts: [{shape: box, size_m: [0.6, 0.4, 0.2], mass_kg: 5}]}
        - {name: left, position_m: [0, 0.3, 0.1], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 0.5, material: rubber}]}
        - {name: right, position_m: [0, -0.3, 0.1], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 0.5, material: rubber}]}
      joints:
        - {name: left, type: hinge, bodies: [hull, left], anchor_m: [0, 0.3, 0.1], axis: [0, 1, 0],
           motor_velocity: 4, motor_max_force: 3}
        - {name: right, type: hinge, bodies: [hull, right], anchor_m: [0, -0.3, 0.1], axis: [0, 1, 0],
           motor_velocity: 3, motor_max_force: 3}
      devices:
        - {name: imu, type: imu, rate_hz: 50, gyro_noise: {gaussian_std: 0.01, random_walk_std: 0.01}, latency_s: 0.02,
           jitter_s: 0.01}
        - {name: lidar, type: lidar, rate_hz: 10, beams: 20, range_std_m: 0.01}
        - {name: bumper, type: bumper, rate_hz: 20}
events:
  - {name: wind, every: 0.6, do: [{move: {name: swing, position_m: [-6, 4, 0.5], area_m: [1, 1, 0], random_yaw: true}}]}
  - {name: rain, every: 0.4, jitter_s: 0.1, probability: 0.7,
     do: [{add: {object: late, position_m: [0, 0, 2], area_m: [4, 4, 0]}}, {add: late_swing},
       {move: {name: late_swing, position_m: [-6, -4, 0.3]}}, {move: {name: crate1, position_m: [0, 0, 1], area_m: [2, 2, 1]}}]}
  - {name: sun, when: event rain fires, delay_s: 0.25, do: [{remove: late}, {remove: late_swing}]}
  - {name: knock, when: any touches crate2, do: [{log: knock}]}
)";

sim::VehicleInstance visitor(const sim::World& world, const std::string& name, double x_m) {
  const std::string yaml = "{name: " + name + ", position_m: [" + std::to_string(x_m) + R"(, -6, 0], model: {shoal: 1,
    vehicle: guest, materials: [{name: felt}], contacts: [{between: [felt, any], friction: 0.2}],
    bodies: [{name: hull, position_m: [0, 0, 0.2], parts: [{shape: box, size_m: [0.3, 0.3, 0.3], mass_kg: 1, material: felt}]}],
    devices: [{name: imu, type: imu, rate_hz: 20, accel_noise: {bias_std: 0.1, gaussian_std: 0.1}},
              {name: pose, type: inclinometer, rate_hz: 10}]}})";
  return sim::read_spawn_request(world.config(), yaml).vehicle;
}

std::string error_of(sim::World& world, std::span<const std::byte> snapshot) {
  try {
    world.state().restore(snapshot);
    return {};
  } catch (const sim::SnapshotError& error) {
    return error.what();
  }
}

TEST(WorldSnapshot, AWorldContinuesThoughThingsComeAndGo) {
  SavedRun(busy_world).expect_restored_worlds_go_on_alike({0, 1, 150, 399}, 300);
}

TEST(WorldSnapshot, VisitorsFaultsMovesAndChangesComeBack) {
  const auto meddle = [](TappedWorld& test, int step) {
    sim::World& world = test.world;
    const auto change = [&](const std::string& device, const std::string& values) {
      sim::Diagnostics diagnostics;
      ASSERT_TRUE(
          world.editor().change_device(device, sim::parse_config_text(values, "change", diagnostics), diagnostics));
    };
    if (step == 20) world.editor().add_vehicle(visitor(world, "guest", 0));
    if (step == 40) world.editor().add_vehicle(visitor(world, "other", 1));
    if (step == 50) {
      EXPECT_THROW(world.editor().add_vehicle(visitor(world, "taken", 1)), sim::ConfigError);
    }
    if (step == 60) change("rover1/imu", "{rate_hz: 25, gyro_noise: {gaussian_std: 0.5}}");
    if (step == 80) world.editor().remove_vehicle("guest");
    if (step == 90) world.editor().add_vehicle(visitor(world, "third", -1));
    if (step == 100) world.editor().move_vehicle("rover2", sim::make_pose({3, -3, 0.5}, {0, 0, 1}));
    sim::FaultConfig fault;
    fault.kind = sim::FaultKind::stuck;
    if (step == 110) world.editor().set_fault("rover1/lidar", fault);
    if (step == 120) world.editor().remove_vehicle("rover1");
    if (step == 130) change("third/pose", "{rate_hz: 40}");
    if (step == 140) world.physics().set_gravity(1.6);
  };
  SavedRun(busy_world, meddle).expect_restored_worlds_go_on_alike({10, 45, 55, 75, 95, 115, 125, 145, 170}, 100);
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

/// Each is added and removed often, alone or while others are there; values are changed again and again.
TEST(WorldSnapshot, WhatLeavesNoTraceIsNotKept) {
  TappedWorld test(busy_world);
  const auto bytes_after = [&](int rounds) {
    for (int i = 0; i < rounds; ++i) {
      test.world.editor().add_vehicle(visitor(test.world, "guest", 0));
      test.world.step();
      test.world.editor().add_vehicle(visitor(test.world, "other", 2));
      test.world.step();
      EXPECT_THROW(test.world.editor().add_vehicle(visitor(test.world, "taken", 2)), sim::ConfigError);
      sim::Diagnostics diagnostics;
      const std::string values = "{rate_hz: " + std::to_string(10 + i % 2) + "}";
      test.world.editor().change_device("rover1/imu", sim::parse_config_text(values, "change", diagnostics),
                                        diagnostics);
      test.world.editor().remove_vehicle("other");
      test.world.editor().remove_vehicle("guest");
      test.world.editor().remove_object("crate3");
      test.world.editor().add_object(test.world.config().objects[2], "crate3", sim::make_pose({9, 9, 1}, {0, 0, 0}));
      test.world.step();
    }
    return test.world.state().snapshot().size();
  };
  const auto few = static_cast<double>(bytes_after(2));
  // Reports under way and contacts come and go.
  EXPECT_NEAR(static_cast<double>(bytes_after(20)), few, 2000);
  TappedWorld fresh(busy_world);
  const sim::Bytes snapshot = test.world.state().snapshot();
  fresh.world.state().restore(snapshot);
  EXPECT_EQ(fresh.world.state().snapshot(), snapshot);
  for (int i = 0; i < 100; ++i) {
    if (i == 10) {  // numbers of devices are those of the original
      test.world.editor().add_vehicle(visitor(test.world, "last", 0));
      fresh.world.editor().add_vehicle(visitor(fresh.world, "last", 0));
    }
    test.world.step();
    fresh.world.step();
    ASSERT_EQ(fresh.world.state().hash(), test.world.state().hash()) << i;
  }
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

class DamagedSnapshot : public testing::Test {
 protected:
  DamagedSnapshot() {
    for (int i = 0; i < 30; ++i) world().step();
    world().editor().add_vehicle(visitor(world(), "guest", 0));
    for (int i = 0; i < 30; ++i) world().step();
    good = world().state().snapshot();
  }
  sim::World& world() { return test.world; }

  TappedWorld test{busy_world};
  sim::Bytes good;
};

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

TEST(WorldSnapshot, PartsHaveHashesInAnOrderThatStays) {
  TappedWorld test(busy_world);
  std::vector<std::string> names;
  for (const sim::PartHash& part : test.world.state().part_hashes()) names.push_back(part.part);
  EXPECT_EQ(names, (std::vector<std::string>{"world", "medium", "rover1", "rover1/imu", "rover1/lidar", "rover1/bumper",
                                             "rover2", "rover2/imu", "rover2/lidar", "rover2/bumper", "objects",
                                             "events", "acoustics", "script"}));
}

TEST(WorldSnapshot, ThePartThatDiffersIsNotifiedByItsHash) {
  TappedWorld one(busy_world), other(busy_world);
  sim::FaultConfig fault;
  fault.kind = sim::FaultKind::silent;
  other.world.editor().set_fault("rover2/lidar", fault);
  const auto a = one.world.state().part_hashes(), b = other.world.state().part_hashes();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i] == b[i], a[i].part != "rover2/lidar") << a[i].part;
  EXPECT_NE(one.world.state().hash(), other.world.state().hash());
}

/// The journal keeps what is possible only together, and each value once.
TEST(WorldSnapshot, ValuesThatAreOnlyPossibleTogetherComeBack) {
  const auto change = [](TappedWorld& test, int step) {
    const std::map<int, std::string> values{{10, "{range_max_m: 100}"},
                                            {20, "{range_min_m: 50}"},
                                            {30, "{range_max_m: 80}"},
                                            {40, "{range_min_m: 1, rate_hz: 20}"},
                                            {50, "{range_max_m: 7}"}};
    if (!values.contains(step)) return;
    sim::Diagnostics diagnostics;
    EXPECT_TRUE(test.world.editor().change_device(
        "rover1/lidar", sim::parse_config_text(values.at(step), "change", diagnostics), diagnostics));
  };
  SavedRun(busy_world, change).expect_restored_worlds_go_on_alike({15, 25, 35, 45, 55}, 60);
}

/// Each with other YAML, some refused: none of it may stay.
TEST(WorldSnapshot, TextsThatLeaveNoTraceAreNotKept) {
  TappedWorld test(busy_world);
  int number = 0;
  const auto guest = [&](const std::string& position_m) {
    const std::string text = "{name: guest, position_m: [" + position_m + R"(], model: {shoal: 1, vehicle: guest)" +
                             std::to_string(++number) + R"(, bodies: [{name: hull, position_m: [0, 0, 0.2],
      parts: [{shape: box, size_m: [0.3, 0.3, 0.3], mass_kg: 1}]}]}})";
    return sim::read_spawn_request(test.world.config(), text).vehicle;
  };
  const auto bytes_after = [&](int rounds) {
    for (int i = 0; i < rounds; ++i) {
      test.world.editor().add_vehicle(guest("0, -6, 0"));
      test.world.editor().remove_vehicle("guest");
      EXPECT_THROW(test.world.editor().add_vehicle(guest("0, 4, 0.1")), sim::ConfigError);  // where crates lie
    }
    return static_cast<std::int64_t>(test.world.state().snapshot().size());
  };
  const std::int64_t few = bytes_after(2);
  EXPECT_NEAR(static_cast<double>(bytes_after(40)), static_cast<double>(few), 100);
  TappedWorld fresh(busy_world);
  const sim::Bytes snapshot = test.world.state().snapshot();
  fresh.world.state().restore(snapshot);
  EXPECT_EQ(fresh.world.state().snapshot(), snapshot);
  for (int i = 0; i < 50; ++i) {
    test.world.step();
    fresh.world.step();
    ASSERT_EQ(fresh.world.state().hash(), test.world.state().hash()) << i;
  }
}

TEST(WorldSnapshot, AJournalThatGrewTooLargeIsRefusedAndLetGo) {
  TappedWorld test(busy_world);
  const sim::Bytes start = test.world.state().snapshot();
  std::string error;
  for (int i = 0; i < 40 && error.empty(); ++i) {  // of 0.5 MiB each; the limit is 16
    const std::string name = "g" + std::to_string(i);
    test.world.editor().add_vehicle(
        sim::read_spawn_request(test.world.config(),
                                "{name: " + name + ", position_m: [" + std::to_string(2 * i) +
                                    ", 30, 9], model: {shoal: 1, vehicle: " + std::string(500'000, 'x') + name +
                                    ", bodies: [{name: hull, parts: [{shape: box, mass_kg: 1}]}]}}")
            .vehicle);
    try {
      test.world.state().snapshot();
    } catch (const sim::SnapshotError& refused) {
      error = refused.what();
    }
  }
  EXPECT_EQ(error, "this world cannot be saved: the change journal exceeds 16 MiB");
  EXPECT_EQ(error_of(test.world, start), "");
  EXPECT_EQ(test.world.state().snapshot(), start);  // back there it can be saved again
}

/// A snapshot in which a number was changed.
class ForgedSnapshot : public DamagedSnapshot {
 protected:
  /// The place behind `before`, which must be there.
  template <typename Before>
  static std::size_t behind(const sim::Bytes& bytes, const Before& before) {
    const auto key = std::as_bytes(std::span(before));
    const auto found = std::search(bytes.begin(), bytes.end(), key.begin(), key.end());
    EXPECT_NE(found, bytes.end());
    return static_cast<std::size_t>(found - bytes.begin()) + key.size();
  }
  template <typename Number>
  static void put(sim::Bytes& bytes, std::size_t at, Number number) {
    std::memcpy(bytes.data() + at, &number, sizeof number);
  }
};

TEST_F(ForgedSnapshot, WithBodiesWhereNoneCanBeIsRefused) {
  const sim::Vector3d p_W = world().find_object("crate3")->base().X_WB().translation();  // its center of mass
  const std::size_t p = behind(good, std::array{p_W.x(), p_W.y(), p_W.z()}) - 3 * sizeof(double);
  const std::size_t q = p + 3 * sizeof(double), R = q + 4 * sizeof(double), v = R + 12 * sizeof(double);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [at, number, error] : {std::tuple(p, nan, "pose"),
                                          {p, 1e200, "pose"},
                                          {q, 3.0, "pose"},
                                          {q, nan, "pose"},
                                          {R, 7.0, "pose"},
                                          {v, nan, "velocity"},
                                          {v, -1e200, "velocity"}}) {
    sim::Bytes bad = good;
    put(bad, at, number);
    EXPECT_THAT(error_of(world(), bad), HasSubstr(error)) << at - p << " " << number;
    EXPECT_EQ(world().state().snapshot(), good);
  }
}

/// What is late would be made up for in small steps, as many as a forger likes.
TEST_F(ForgedSnapshot, WithAClockThatIsLateIsRefused) {
  // 60 steps of 5 ms; a node of the clock's wander every 0.1 s up to 2 s after that, each a time and a number, of which
  // the first are 0.
  const std::array<std::int64_t, 5> clock{300'000, 2 * 25, 0, 0, 100'000};
  const std::size_t at = behind(good, clock) - sizeof clock;
  put(good, at, std::int64_t{200'000});
  EXPECT_THAT(error_of(world(), good), HasSubstr("a clock whose time does not match that of the world"));
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

TEST_F(ForgedSnapshot, WithEventsOfNoOneIsRefused) {
  const std::pair<int, const char*> forged[] = {{999, "an event of a device that does not exist"},
                                                {-1, "events: an event without a device"},
                                                {-2, "a signal that does not exist"}};
  // Behind the length of the part come the slice that was reached, the next number, how many events there are, and of
  // the first one when it is due, the device and the kind.
  const std::size_t count = behind(good, std::string("events")) + 3 * 8;
  std::uint64_t events = 0;
  std::memcpy(&events, good.data() + count, sizeof events);
  ASSERT_GT(events, 0u);
  for (const auto& [device, error] : forged) {
    sim::Bytes bad = good;
    put(bad, count + 2 * 8, device);
    put(bad, count + 2 * 8 + sizeof(int), 2);
    EXPECT_THAT(error_of(world(), bad), HasSubstr(error)) << device;
  }
}

TEST_F(ForgedSnapshot, WithAnEventThatFiredLessThanNeverIsRefused) {
  sim::Bytes bad = good;
  // Behind the length of the part come the actor (two of 8 bytes, 4, 1, a pose) and how often the event has fired.
  const std::size_t script = behind(bad, std::string("script")) + 8;
  put(bad, script + 2 * 8 + 4 + 1 + 16 * 8 + 8, std::int64_t{-1});
  EXPECT_THAT(error_of(world(), bad), HasSubstr("script: the snapshot has an invalid value: a count of firings"));
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

TEST_F(ForgedSnapshot, WithAHistoryAfterItsEndIsRefused) {
  sim::Bytes bad = good;
  // Behind the length of the part come version, seed and the length of a step.
  put(bad, behind(bad, std::string("make")) + 8 + 4 + 8 + 8, std::int64_t{1});
  TappedWorld fresh(busy_world);
  EXPECT_THAT(error_of(fresh.world, bad), HasSubstr("changes in an invalid order"));
  EXPECT_THAT(error_of(world(), bad), HasSubstr("its step is not the one with which it starts"));
}

}  // namespace
