// SPDX-License-Identifier: BSD-3-Clause
#include "motion/gait/leg.hpp"

#include <gmock/gmock.h>

#include "motion/analysis/motion_check.hpp"
#include "motion/gait/half_ellipse.hpp"
#include "motion/gait/leg_motion.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/motion/gait/ers7_gait.hpp"

namespace {

using namespace ers7_gait;

TEST(Leg, TheLengthsOfTheErs7AreThoseOfItsFile) {
  const std::vector<motion::Leg> legs = motion::legs_of(ers7());
  ASSERT_EQ(legs.size(), 4u);
  EXPECT_EQ(legs[0].name, "lf");
  EXPECT_TRUE(legs[0].hip.isApprox(sim::Vector3d(0.065, 0.0625, 0)));
  EXPECT_TRUE(legs[3].knee.isApprox(sim::Vector3d(-0.074, -0.0625, -0.0695)));
  // The knee's body, and the ball in it.
  EXPECT_TRUE(legs[0].foot.isApprox(sim::Vector3d(0.074 - 0.00503, 0.0625 + 0.0047, -0.0695 - 0.06524)));
  EXPECT_TRUE(legs[0].foot_at({}).isApprox(legs[0].foot));
  // The flap is narrowed to the narrowest row of the table of two joints: -1 and 0 degrees.
  EXPECT_NEAR(legs[0].flap_limits.low, -M_PI / 180, 1e-12);
  EXPECT_NEAR(legs[2].flap_limits.low, 0, 1e-12);
}

TEST(Leg, JointsTurnAsTheirAxesSay) {
  const std::vector<motion::Leg> legs = motion::legs_of(ers7());
  // Positive: front forward, rear backward, flap outwards (docs/models/ers7.md).
  EXPECT_GT(legs[0].foot_at({0.5, 0, 0}).x(), legs[0].foot.x());
  EXPECT_GT(legs[0].foot_at({0, 0, 0.5}).x(), legs[0].foot.x());
  EXPECT_LT(legs[2].foot_at({0.5, 0, 0}).x(), legs[2].foot.x());
  EXPECT_LT(legs[3].foot_at({0, 0, 0.5}).x(), legs[3].foot.x());
  EXPECT_GT(legs[0].foot_at({0, 0.5, 0}).y(), legs[0].foot.y());
  EXPECT_LT(legs[1].foot_at({0, 0.5, 0}).y(), legs[1].foot.y());
}

TEST(Leg, APostureThatWasForwardIsFoundBackward) {
  // The rear leg is straight at 0.33, and its knee turned in the positive direction above.
  for (const motion::Leg& leg : motion::legs_of(ers7()))
    for (const double swing : {-1.0, -0.2, 0.4, 1.1})
      for (const double flap : {-0.1, 0.0, 0.4, 1.0})
        for (const double knee : {0.5, 0.9, 1.7}) {
          const motion::LegPosture found = leg.posture_at(leg.foot_at({swing, flap, knee}));
          EXPECT_TRUE(found.reached);
          EXPECT_NEAR(found.swing, swing, 1e-9) << leg.name << swing << flap << knee;
          EXPECT_NEAR(found.flap, flap, 1e-9);
          EXPECT_NEAR(found.knee, knee, 1e-9);
        }
}

TEST(Leg, OutOfReachItIsStraightTowardsThePoint) {
  for (const motion::Leg& leg : motion::legs_of(ers7())) {
    const sim::Vector3d far = leg.hip + sim::Vector3d(0.1, leg.foot.y() - leg.hip.y(), -0.3);
    const motion::LegPosture posture = leg.posture_at(far);
    EXPECT_FALSE(posture.reached);
    const sim::Vector3d foot = leg.foot_at(posture) - leg.hip, desired = far - leg.hip;
    EXPECT_LT(foot.norm(), desired.norm());
    EXPECT_NEAR(foot.x() / foot.z(), desired.x() / desired.z(), 1e-9);
  }
}

TEST(Leg, AVehicleWithoutLegsIsRefusedWithWhatIsMissing) {
  sim::VehicleConfig vehicle = ers7();
  std::erase_if(vehicle.devices, [](const sim::DeviceConfig& one) { return one.name == "rh_flap"; });
  try {
    motion::legs_of(vehicle);
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_STREQ(error.what(), "vehicle 'ers7': no legs for a gait: it has no joint_servo 'rh_flap'");
  }
}

}  // namespace
