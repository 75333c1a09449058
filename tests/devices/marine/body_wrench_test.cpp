// SPDX-License-Identifier: BSD-3-Clause
#include "devices/marine/body_wrench.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "shoal/wrench_t.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/marine/marine_fixture.hpp"

namespace {

using test::wet_device;
using test::WetBox;
using testing::HasSubstr;

using test::rounding_N;

void push(WetBox& box, const sim::Vector3d& force, const sim::Vector3d& torque = sim::Vector3d::Zero()) {
  shoal::wrench_t message{};
  for (int i = 0; i < 3; ++i) {
    message.force_N[i] = force[i];
    message.torque_Nm[i] = torque[i];
  }
  box.send("v.d.cmd", message);
}

TEST(BodyWrench, AcceleratesABoxByForceOverMassInAirToo) {
  for (const std::string medium : {"{}", "{water: {}}"}) {
    WetBox box(wet_device("type: body_wrench"), medium);
    push(box, {3, -4, 5});
    box.run_for(1);
    EXPECT_NEAR((box.body.v_WB_W() - sim::Vector3d(0.3, -0.4, 0.5)).norm(), 0, 1e-12);
  }
}

TEST(BodyWrench, ItsFrameIsThatOfTheDevice) {
  WetBox box(wet_device("type: body_wrench, position_m: [0, 2, 0], rpy_deg: [0, 0, 90]"));
  push(box, {0, -6, 0}, {0, 0, 1});
  EXPECT_NEAR((box.torque_W() - sim::Vector3d(0, 0, 1 - 2 * 6)).norm(), 0, rounding_N);  // along x, 2 m to the left
  EXPECT_NEAR(box.body.v_WB_W().x(), 6 * 1e-3 / 10, 1e-15);
}

TEST(BodyWrench, CutsEachAxisToItsLimitAndLags) {
  WetBox box(wet_device("type: body_wrench, force_max_N: [10, 20, 0], torque_max_Nm: [1, 1, 1], lag_s: 0.05"));
  push(box, {100, -100, 100});
  box.run_for(0.049);
  // What acts in the step that begins at 0.049 s is the force half-way.
  EXPECT_NEAR((box.force_W() - (1 - std::exp(-0.0495 / 0.05)) * sim::Vector3d(10, -20, 0)).norm(), 0, rounding_N);
}

TEST(BodyWrench, StopsWhenItsCommandsAreStaleAndDeadGivesNoForce) {
  WetBox box(wet_device("type: body_wrench, watchdog_s: 0.05"));
  push(box, {10, 0, 0});
  box.run_for(0.02);
  EXPECT_NEAR(box.force_W().x(), 10, rounding_N);
  box.world.editor().set_fault("v/d", {.kind = sim::FaultKind::dead});
  EXPECT_EQ(box.force_W().x(), 0);
  box.world.editor().clear_faults("v/d");
  EXPECT_NEAR(box.force_W().x(), 10, rounding_N);
  box.run_for(0.05);
  EXPECT_EQ(box.force_W().x(), 0);
}

TEST(BodyWrench, RefusesALimitBelowZero) {
  EXPECT_THAT(test::error_of_device("type: body_wrench, force_max_N: [1, -1, 1]"), HasSubstr("'force_max_N'"));
  EXPECT_EQ(test::error_of_device("type: body_wrench, force_max_N: [1, 1, 1]"), "");
}

}  // namespace
