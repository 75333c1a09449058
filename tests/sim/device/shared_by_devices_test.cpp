// SPDX-License-Identifier: BSD-3-Clause
#include "sim/device/shared_by_devices.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

struct Network {
  int members = 0;
};
const sim::SharedKind<Network> networks, other_networks;
const sim::SharedKind<std::string> names;

TEST(SharedByDevices, HasOneThingOfEachKindFromTheStart) {
  sim::SharedByDevices shared;
  shared.of(networks).members = 3;
  shared.of(names) = "x";
  EXPECT_EQ(shared.of(networks).members, 3);
  EXPECT_EQ(shared.of(other_networks).members, 0) << "a kind is a constant, not a type";
  const sim::SharedByDevices& requested = shared;
  EXPECT_EQ(requested.of(names), "x");
}

TEST(SharedByDevices, AreNotSharedBetweenWorlds) {
  sim::SharedByDevices one, other;
  one.of(networks).members = 3;
  EXPECT_EQ(other.of(networks).members, 0);
  one = {};
  EXPECT_EQ(one.of(networks).members, 0) << "a world that is built again";
}

}  // namespace
