// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/step_hash.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <string>

#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/devices/state_fixture.hpp"
#include "tests/sim/world/busy_worlds.hpp"

namespace {

using namespace busy_worlds;

using test::TappedWorld;

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

}  // namespace
