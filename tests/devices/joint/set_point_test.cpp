// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/set_point.hpp"

#include <gmock/gmock.h>

#include "devices/joint/joint_servo.hpp"

namespace {

TEST(JointServo, SetPointReachesRestExactlyFromAnyDistance) {
  for (const double target : {1e-7, 1e-3, 0.1, -2.345, 50.0}) {
    devices::SetPoint point;
    double last = 0;
    for (int i = 0; i < 100000 && point.position != target; ++i) {
      point.approach(target, {1.5, 3}, 0.01);
      ASSERT_LE(std::abs(point.velocity - last), 0.03 + 1e-12) << target;
      ASSERT_LE(std::abs(point.velocity), 1.5) << target;
      ASSERT_LE(std::abs(point.position), std::abs(target) + 1e-12) << "beyond " << target;
      last = point.velocity;
    }
    EXPECT_EQ(point.position, target);
    point.approach(target, {1.5, 3}, 0.01);
    EXPECT_EQ(point.velocity, 0) << target;
  }
}

}  // namespace
