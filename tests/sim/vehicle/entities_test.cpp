// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/entities.hpp"

#include <gmock/gmock.h>

#include "sim/config/diagnostics.hpp"
#include "sim/state/state_archive.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

template <typename Work>
std::string error_of(const Work& work) {
  try {
    work();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "none";
}

TEST(Entities, AreNotThereByNamesThatNoOneHas) {
  const sim::Entities entities;
  EXPECT_EQ(entities.find_vehicle("r1"), nullptr);
  EXPECT_EQ(entities.find_object("crate"), nullptr);
  EXPECT_EQ(entities.find_device("r1/lidar"), nullptr);
  EXPECT_EQ(error_of([&] { entities.vehicle_named("r1"); }), "there is no vehicle 'r1'");
  EXPECT_EQ(error_of([&] { entities.object_named("crate"); }), "there is no object 'crate'");
  EXPECT_EQ(error_of([&] { entities.device_named("lidar"); }),
            "there is no device 'lidar'; devices are named VEHICLE/DEVICE");
}

TEST(Entities, OfAWorldAreFoundByTheirNames) {
  test::TestWorld test(
      test::box_world("        - {name: imu, type: imu}\n", "{step_s: 0.01}",
                      "objects: [{name: crate, position_m: [3, 0, 0], parts: [{shape: box, mass_kg: 1}]}]\n"));
  EXPECT_EQ(test.world.find_vehicle("r1")->name(), "r1");
  EXPECT_EQ(test.world.find_object("crate")->name, "crate");
  EXPECT_NE(test.world.find_vehicle("r1")->find_device("imu"), nullptr);
  EXPECT_EQ(test.world.find_vehicle("r1")->find_device("gps"), nullptr);
  EXPECT_EQ(test.world.find_vehicle("crate"), nullptr);
}

TEST(Entities, NumbersGoUpAndStartAgainWithTheWorld) {
  sim::Entities entities;
  EXPECT_EQ(entities.take_vehicle_number(), 0);
  EXPECT_EQ(entities.take_vehicle_number(), 1);
  entities.prescribe_object_number(7);
  EXPECT_EQ(entities.take_object_number(), 7);
  EXPECT_EQ(entities.next_object_number(), 8);
  entities.clear();
  EXPECT_EQ(entities.next_vehicle_number(), 0);
  EXPECT_EQ(entities.next_object_number(), 0);
}

TEST(Entities, ASnapshotBringsTheNumbersBack) {
  sim::Entities entities;
  entities.prescribe_vehicle_number(3);
  entities.prescribe_object_number(5);
  sim::StateArchive saved = sim::StateArchive::saver();
  entities.visit_state(saved);
  sim::Entities other;
  const std::vector<std::byte> bytes = saved.take_bytes();
  sim::StateArchive restored = sim::StateArchive::restorer(bytes);
  other.visit_state(restored);
  EXPECT_EQ(other.next_vehicle_number(), 3);
  EXPECT_EQ(other.next_object_number(), 5);
}

TEST(Entities, EveryChangeIsAnotherGeneration) {
  sim::Entities entities;
  const std::uint64_t before = entities.generation();
  entities.mark_changed();
  EXPECT_NE(entities.generation(), before);
}

}  // namespace
