// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "tests/devices/joint/servo_fixture.hpp"

namespace {

using test::ServoRig;

// A line of 1 N m at standstill and 6 rad/s without load; setpoints and efforts beyond it.
const std::string line = ", stall_effort: 1, no_load_velocity: 6, max_effort: 5, max_velocity: 20";

const std::vector<std::string> controls = {test::velocity_control, test::pid_control};

TEST(JointServo, SlowsUnderLoadByItsTorqueSpeedLine) {
  for (const std::string& control : controls)
    for (const double step_s : {0.001, 0.002, 0.004})
      // step stall / (inertia no_load) is from 24 to 0.017.
      for (const double inertia_kgm2 : {1e-5 / 0.36, 1e-4, 1e-2})
        for (const double load_Nm : {0.0, 0.25, 0.5, 0.75})
          for (const int mode : {1, 2}) {
            ServoRig rig({.keys = line + control, .step_s = step_s, .inertia_kgm2 = inertia_kgm2});
            rig.load(load_Nm);
            rig.command(mode, 20);
            rig.run_for(2);  // 33 time constants of the largest inertia: inertia no_load / stall = 0.06 s
            // The motor's limit is that of the end of the step: no error but rounding.
            ASSERT_NEAR(rig.velocity(), 6 * (1 - load_Nm), 1e-5)
                << control << " step " << step_s << " inertia " << inertia_kgm2 << " mode " << mode;
          }
}

TEST(JointServo, StartsAsTheImplicitStepOfItsLineDoes) {
  for (const std::string& control : controls) {
    ServoRig rig({.keys = line + control, .step_s = 0.002});
    rig.command(1, 20);
    // inertia dw/dt = stall (1 - w / no_load): w_n = no_load (1 - (1 + g)^-n), g = step stall / (no_load inertia).
    const double gain = 0.002 * 1 / (6 * 0.01);
    for (int n = 1; n <= 100; ++n) {
      rig.world.step();
      ASSERT_NEAR(rig.velocity(), 6 * (1 - std::pow(1 + gain, -n)), 1e-5) << control << n;
    }
  }
}

TEST(JointServo, BelowItsLineItKeepsTheCommandedVelocity) {
  ServoRig rig({.keys = line, .step_s = 0.002, .inertia_kgm2 = 1e-4});
  rig.load(0.5);
  rig.command(1, 2.9);  // the line allows 3
  rig.run_for(1);       // it catches up with its setpoint in some times 1 / kp = 0.05 s
  EXPECT_NEAR(rig.velocity(), 2.9, 1e-5);
}

TEST(JointServo, AnEffortBelowTheLineActsAsCommanded) {
  ServoRig rig({.keys = line});
  rig.command(2, 0.3);
  rig.run_for(0.1);
  EXPECT_NEAR(rig.velocity(), 0.3 / 0.01 * 0.1, 1e-6);  // the line still allows 0.5 N m at 3 rad/s
}

TEST(JointServo, FrictionLowersTheSpeedOnTheLine) {
  for (const std::string& control : controls) {
    ServoRig rig({.keys = line + ", friction: 0.25" + control, .step_s = 0.002, .inertia_kgm2 = 1e-4});
    rig.load(0.25);
    rig.command(1, 20);
    rig.run_for(1);
    EXPECT_NEAR(rig.velocity(), 6 * (1 - 0.5), 1e-4) << control;
  }
}

}  // namespace
