// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/servo_overload.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "devices/joint/joint_servo.hpp"
#include "sim/director/world_observer.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "tests/devices/joint/servo_fixture.hpp"

namespace {

using test::ServoRig;

/// Keeps what happened in a world, with its time.
class Happenings final : public sim::WorldObserver {
 public:
  explicit Happenings(sim::World& world) : world_(world) { world_.set_observer(this); }
  ~Happenings() override { world_.set_observer(nullptr); }
  Happenings(const Happenings&) = delete;
  Happenings& operator=(const Happenings&) = delete;
  void sound_sent(const sim::SoundSent&) override {}
  void sound_arrived(const sim::SoundArrived&) override {}
  void happened(const sim::Occurrence& occurrence) override {
    all.push_back(occurrence);
    times_s.push_back(sim::to_seconds(world_.now()));
  }
  std::vector<sim::Occurrence> all;
  std::vector<double> times_s;

 private:
  sim::World& world_;
};

const std::string protection = ", max_effort: 2, overload: {share: 0.78, window_s: 30}";
const std::string stiff_pid = ", control: pid, kp: 100, kd: 1";

TEST(JointServo, AnOverloadSwitchesItOffAfterAWholeWindow) {
  for (const std::string& control : {std::string(), stiff_pid})
    for (const std::string& gear : {std::string(), std::string(", stall_effort: 2, no_load_velocity: 6")})
      for (const double step_s : {0.001, 0.002, 0.004}) {
        ServoRig rig({.keys = protection + control + gear, .step_s = step_s});
        Happenings happenings(rig.world);
        rig.load(0.79 * 2);
        rig.run_for(31);
        ASSERT_EQ(happenings.all.size(), 1U) << control << gear << step_s;
        EXPECT_EQ(happenings.all[0].kind, sim::Occurrence::Kind::fault);
        EXPECT_EQ(happenings.all[0].who, "v1/servo");
        EXPECT_EQ(happenings.all[0].text,
                  "overload: its mean effort of 30 s is above 78 % of the largest one; it is off until its command "
                  "'reset'");
        EXPECT_NEAR(happenings.times_s[0], 30, 0.008) << control << gear << step_s;
        EXPECT_LT(rig.velocity(), -1);  // it coasts, and the load turns it
      }
}

TEST(JointServo, JustBelowTheOverloadItStaysOn) {
  for (const std::string& control : {std::string(), stiff_pid})
    for (const double step_s : {0.001, 0.002, 0.004}) {
      ServoRig rig({.keys = protection + control, .step_s = step_s});
      Happenings happenings(rig.world);
      rig.load(0.77 * 2);
      rig.run_for(65);  // two windows
      EXPECT_TRUE(happenings.all.empty()) << control << step_s;
    }
}

TEST(JointServo, AnOverloadIsAnAverageNotAPeak) {
  // 0.5 s of all its effort and 0.5 s of a share, in turn.
  const auto switches_off = [](double low_share) {
    ServoRig rig({.keys = protection, .step_s = 0.004});
    Happenings happenings(rig.world);
    for (int i = 0; i < 35; ++i) {
      rig.load(0.999 * 2);
      rig.run_for(0.5);
      rig.load(low_share * 2);
      rig.run_for(0.5);
    }
    return !happenings.all.empty();
  };
  EXPECT_TRUE(switches_off(0.58));   // mean 0.7895
  EXPECT_FALSE(switches_off(0.54));  // mean 0.7695
}

TEST(JointServo, AfterAnOverloadItObeysOnlyAReset) {
  ServoRig rig({.keys = ", max_effort: 2, max_velocity: 2, overload: {window_s: 0.5}"});
  rig.load(1.8);
  rig.run_for(0.6);
  rig.load(0);
  for (const int mode : {0, 1, 2, 3}) {
    rig.command(mode, 1);
    const double velocity = rig.velocity();
    ASSERT_LT(velocity, -1);
    rig.run_for(0.1);
    EXPECT_NEAR(rig.velocity(), velocity, 1e-9) << mode;
  }
  rig.command(4);
  rig.run_for(3);  // it brakes, and returns to where it was
  EXPECT_NEAR(rig.velocity(), 0, 1e-4);
  const double held = rig.position();
  rig.command(0, held + 0.5);
  rig.run_for(2);
  EXPECT_NEAR(rig.position(), held + 0.5, 1e-4);
}

TEST(JointServo, AResetStartsANewWindowOfItsOverload) {
  ServoRig rig({.keys = ", max_effort: 2, overload: {window_s: 0.5}"});
  Happenings happenings(rig.world);
  rig.load(1.8);
  rig.run_for(0.51);
  ASSERT_EQ(happenings.all.size(), 1U);
  rig.command(4);
  rig.run_for(0.49);
  EXPECT_EQ(happenings.all.size(), 1U);
  rig.run_for(0.02);
  EXPECT_EQ(happenings.all.size(), 2U);
}

TEST(JointServo, OnlyARemovalOfItsOverloadSwitchesItOnWithoutAReset) {
  ServoRig rig({.keys = ", max_effort: 2, overload: {window_s: 0.5}"});
  rig.load(1.8);
  rig.run_for(0.6);
  const auto& servo =
      dynamic_cast<const devices::JointServo&>(*rig.world.find_vehicle("v1")->find_device("servo")->actuator());
  EXPECT_TRUE(servo.is_off());
  ASSERT_EQ(rig.change("v1/servo", "{overload: {window_s: 100}}"), "");
  EXPECT_TRUE(servo.is_off());
  ASSERT_EQ(rig.change("v1/servo", "{overload: }"), "");
  EXPECT_FALSE(servo.is_off());
}

TEST(JointServo, SaysWhatIsWrongWithItsOverload) {
  EXPECT_THAT(test::error_of_world(ServoRig::yaml({.keys = ", overload: {share: 1.5}"})),
              testing::HasSubstr("device 'servo': overload: 'share' must be > 0 and <= 1, got 1.5"));
}

}  // namespace
