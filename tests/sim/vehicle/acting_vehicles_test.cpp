// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/acting_vehicles.hpp"

#include <gtest/gtest.h>

#include "sim/vehicle/step_clock.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

/// A free body with a wrench, which acts alone.
std::string pushed_world() {
  return test::box_world(
      "        - {name: push, type: body_wrench, force_max_N: [9, 9, 9], torque_max_Nm: [9, 9, 9]}\n",
      "{step_s: 0.01, gravity_mps2: 0}");
}

TEST(ActingVehicles, InItsFirstStepAVehicleActsInTurn) {
  test::TestWorld test(pushed_world());
  sim::ActingVehicles acting;
  acting.add(*test.world.find_vehicle("r1"));
  EXPECT_FALSE(acting.begin_by_groups());
  sim::StepClock clock{sim::Time(10'000)};
  acting.act(clock, 0.01, nullptr);
  EXPECT_TRUE(acting.begin_by_groups());
}

TEST(ActingVehicles, WithoutActuatorsItActsAlone) {
  test::TestWorld test(test::box_world("        - {name: imu, type: imu}\n"));
  sim::ActingVehicles acting;
  acting.add(*test.world.find_vehicle("r1"));
  EXPECT_TRUE(acting.begin_by_groups());
}

TEST(ActingVehicles, OneThatIsRemovedActsNoMore) {
  test::TestWorld test(pushed_world());
  sim::ActingVehicles acting;
  const sim::Vehicle& vehicle = *test.world.find_vehicle("r1");
  acting.add(vehicle);
  acting.remove(vehicle);
  acting.remove(vehicle);  // a second time does nothing
  EXPECT_TRUE(acting.begin_by_groups());
}

TEST(ActingVehicles, AGroupWithoutActuatorsDoesNothing) {
  sim::ActingVehicles acting;
  ASSERT_TRUE(acting.begin_by_groups());
  acting.act_of(5, sim::StepClock{}, 0.01);
  acting.act_rest(sim::StepClock{}, 0.01, nullptr);
}

}  // namespace
