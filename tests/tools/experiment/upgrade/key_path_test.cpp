// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/key_path.hpp"

#include <gmock/gmock.h>

namespace {

using testing::ElementsAre;
using tools::FileKind;
using tools::KeyPath;

TEST(KeyPath, IsTheWayFromTheTop) {
  const KeyPath path = KeyPath(FileKind::world).value_of("events").item().value_of("times");
  EXPECT_TRUE(path.is(FileKind::world, "events.*.times"));
  EXPECT_FALSE(path.is(FileKind::world, "events.*"));
  EXPECT_FALSE(path.is(FileKind::world, "events.*.times.*"));
  EXPECT_FALSE(path.is(FileKind::vehicle, "events.*.times"));
}

TEST(KeyPath, OfAModelIsThatOfAVehicle) {
  const KeyPath entry = KeyPath(FileKind::world).value_of("vehicles").item();
  EXPECT_TRUE(entry.value_of("model").value_of("devices").item().value_of("rate_hz").is(FileKind::vehicle,
                                                                                        "devices.*.rate_hz"));
  EXPECT_TRUE(entry.value_of("name").is(FileKind::world, "vehicles.*.name"));
}

TEST(KeyPath, OfAnOverrideIsThatOfAVehicle) {
  const KeyPath overrides = KeyPath(FileKind::world).value_of("vehicles").item().value_of("overrides");
  EXPECT_TRUE(overrides.has_dotted_keys());
  EXPECT_TRUE(overrides.value_of("devices.lidar.rate_hz").is(FileKind::vehicle, "devices.*.rate_hz"));
  EXPECT_TRUE(overrides.value_of("rover7/devices.lidar.rate_hz").is(FileKind::vehicle, "devices.*.rate_hz"));
  EXPECT_TRUE(overrides.value_of("devices.lidar").value_of("rate_hz").is(FileKind::vehicle, "devices.*.rate_hz"));
}

TEST(KeyPath, OfACaseIsThatOfAWorldOrOfAVehicleInIt) {
  const KeyPath set = KeyPath(FileKind::study).value_of("cases").item().value_of("set");
  EXPECT_TRUE(set.value_of("run.speed").is(FileKind::world, "run.speed"));
  EXPECT_TRUE(set.value_of("run").value_of("speed").is(FileKind::world, "run.speed"));
  EXPECT_TRUE(set.value_of("vehicles.auv.devices.dvl.rate_hz").is(FileKind::vehicle, "devices.*.rate_hz"));
  EXPECT_TRUE(set.value_of("vehicles.auv.overrides")
                  .value_of("devices.dvl.rate_hz")
                  .is(FileKind::vehicle, "devices.*.rate_hz"));
  EXPECT_TRUE(set.value_of("vehicles.auv.count").is(FileKind::world, "vehicles.*.count"));
}

TEST(KeyPath, OfAnActionIsThatOfThePresentFormat) {
  const KeyPath action = KeyPath(FileKind::world).value_of("events").item().value_of("do").item();
  EXPECT_TRUE(action.is_action());
  EXPECT_TRUE(action.value_of_action("type", "publish").is(FileKind::world, "events.*.do.*.publish.type"));
  EXPECT_TRUE(action.value_of_action("publish", "publish").is(FileKind::world, "events.*.do.*.publish.channel"));
  EXPECT_TRUE(action.value_of("publish").value_of("type").is(FileKind::world, "events.*.do.*.publish.type"));
}

TEST(KeyPath, OfActionsInActionsIsThatOfActions) {
  const KeyPath action = KeyPath(FileKind::world).value_of("events").item().value_of("do").item();
  EXPECT_TRUE(action.value_of("one_of").item().item().is_action());
  EXPECT_TRUE(action.value_of("one_of").value_of("choices").item().item().is_action());
  EXPECT_TRUE(action.value_of_action("one_of", "one_of").item().item().is_action());
  EXPECT_FALSE(action.value_of_action("weights", "one_of").item().is_action());
}

TEST(KeyPath, OfValuesThatAreSetIsThatOfADevice) {
  const KeyPath action = KeyPath(FileKind::world).value_of("events").item().value_of("do").item();
  EXPECT_TRUE(
      action.value_of_action("values", "set").value_of("noise.bias").is(FileKind::vehicle, "devices.*.noise.bias"));
}

}  // namespace
