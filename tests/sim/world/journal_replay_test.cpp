// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/journal_replay.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <tuple>

#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/devices/state_fixture.hpp"
#include "tests/sim/world/busy_worlds.hpp"

namespace {

using namespace busy_worlds;

using test::SavedRun;
using test::TappedWorld;
using testing::HasSubstr;

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

TEST_F(ForgedSnapshot, WithAHistoryAfterItsEndIsRefused) {
  sim::Bytes bad = good;
  // Behind the length of the part come version, seed and the length of a step.
  put(bad, behind(bad, std::string("make")) + 8 + 4 + 8 + 8, std::int64_t{1});
  TappedWorld fresh(busy_world);
  EXPECT_THAT(error_of(fresh.world, bad), HasSubstr("changes in an invalid order"));
  EXPECT_THAT(error_of(world(), bad), HasSubstr("its step is not the one with which it starts"));
}

}  // namespace
