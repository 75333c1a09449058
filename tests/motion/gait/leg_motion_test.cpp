// SPDX-License-Identifier: BSD-3-Clause
#include "motion/gait/leg_motion.hpp"

#include <gmock/gmock.h>

#include "motion/analysis/motion_check.hpp"
#include "motion/gait/half_ellipse.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/motion/gait/ers7_gait.hpp"

namespace {

using namespace ers7_gait;

using motion::HalfEllipse;

TEST(HalfEllipse, TheMotionPutsTheFeetOnTheLocus) {
  const HalfEllipse gait(ers7());
  std::vector<double> values = start_of(gait);
  values[HalfEllipse::length] = 0.03;  // slow enough for the servos, and within all ranges
  values[HalfEllipse::front_height] = values[HalfEllipse::rear_height] = 0.01;
  values[HalfEllipse::period] = 1;
  const sim::JointMotion motion = gait.motion(values);
  const int frames = gait.frames(values);
  const motion::Leg& leg = gait.legs()[0];
  for (int i = 0; i < frames; ++i) {
    const auto& joints = motion.keys[static_cast<std::size_t>(i)].joints;  // lf is the first leg
    const sim::Vector3d foot = leg.foot_at({joints[0].second, joints[1].second, joints[2].second});
    EXPECT_LT((foot - HalfEllipse::foot_at(values, leg, static_cast<double>(i) / frames)).norm(), 1e-9) << i;
  }
}

TEST(HalfEllipse, StepsOfACourseAreLimitedWithoutDelay) {
  // A jump of 4 in steps of 1 begins before it and ends after it, in equal parts.
  const std::vector<double> limited = motion::with_limited_steps({0, 0, 0, 0, 4, 4, 4, 4}, 1);
  EXPECT_EQ(limited, (std::vector<double>{1.5, 1, 1, 1.5, 2.5, 3, 3, 2.5}));
  EXPECT_EQ(motion::with_limited_steps({0, 1, 2, 1}, 1), (std::vector<double>{0, 1, 2, 1}));
}

}  // namespace
