// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/robots/balance.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "autonomy/missions/robots/balance_model.hpp"
#include "shoal/imu_t.hpp"
#include "shoal/inclination_t.hpp"
#include "shoal/joint_servo_command_t.hpp"
#include "shoal/wheel_encoder_t.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"

namespace {

using autonomy::Balance;

constexpr double degrees = 180 / std::numbers::pi;

/// A world of the Segway with the balance law in the same process, and without its latency.
struct Balanced : test::LoadedTestWorld {
  explicit Balanced(const Balance::Params& params, const std::string& physics_step_s = "0.005",
                    const std::string& latency_s = "0.02", const std::string& name = "segway")
      : LoadedTestWorld(sim::load_world(
            test_support::source_path("worlds/" + name + ".yaml"),
            with_messages({.sets = {"physics.step_s=" + physics_step_s,
                                    "vehicles.segway1.actuator_latency_s=" + latency_s, "metrics=[]", "pass=[]"}}))),
        law(params),
        inclination_(*this, "segway1.inclinometer"),
        encoder_(*this, "segway1.encoder"),
        imu_(*this, "segway1.imu") {}

  void balance_for(double time_s) {
    const sim::Time end = world.now() + sim::from_seconds(time_s);
    while (world.now() < end && !law.fallen()) {
      world.step();
      const auto tilts = inclination_.take_all();
      for (const auto& wheels : encoder_.take_all()) law.receive(wheels);
      for (const auto& tilt : tilts) law.receive(tilt);
      for (const auto& rates : imu_.take_all()) law.receive(rates);
      if (tilts.empty()) continue;
      const auto torques = law.step();
      if (!torques) continue;
      command("left", torques->left_Nm);
      command("right", torques->right_Nm);
    }
  }
  void command(const std::string& side, double torque_Nm) {
    shoal::joint_servo_command_t message{};
    message.mode = 2;
    message.effort = torque_Nm;
    send("segway1." + side + "_motor.cmd", message);
  }
  double x_m() const { return world.find_vehicle("segway1")->X_WV().translation().x(); }

  Balance law;

 private:
  test::Listener<shoal::inclination_t> inclination_;
  test::Listener<shoal::wheel_encoder_t> encoder_;
  test::Listener<shoal::imu_t> imu_;
};

TEST(Balance, TenMinutesStanding) {
  Balanced test({});
  test.balance_for(600);
  EXPECT_FALSE(test.law.fallen());
  EXPECT_NEAR(test.law.tilt_rad() * degrees, -9.93, 0.1);
  EXPECT_NEAR(test.law.speed_mps(), 0, 0.01);
}

TEST(Balance, DrivesForwardAndBackAndStops) {
  Balanced test({});
  test.law.drive(0.8, 0);
  test.balance_for(20);
  EXPECT_NEAR(test.law.speed_mps(), 0.8, 0.05);
  const double out_m = test.x_m();
  EXPECT_GT(out_m, 10);
  test.law.drive(-0.8, 0);
  test.balance_for(20);
  EXPECT_NEAR(test.law.speed_mps(), -0.8, 0.05);
  EXPECT_LT(test.x_m(), out_m);
  test.law.drive(0, 0);
  test.balance_for(30);
  EXPECT_NEAR(test.law.speed_mps(), 0, 0.02);
  EXPECT_FALSE(test.law.fallen());
}

TEST(Balance, TurnsOnTheSpot) {
  Balanced test({});
  test.balance_for(2);
  const auto yaw = [&] { return sim::yaw_of(test.world.find_vehicle("segway1")->X_WV().linear()); };
  test.law.drive(0, 0.3);
  test.balance_for(6);
  const double before = yaw();
  test.balance_for(4);
  EXPECT_NEAR(sim::wrap_angle(yaw() - before), 1.2, 0.03);  // slip of the wide wheels
  EXPECT_FALSE(test.law.fallen());
}

/// How far it swings after a push: a command to drive.
struct Swing {
  double first_deg = 0;  ///< from 5 s to 10 s
  double last_deg = 0;   ///< from 25 s to 30 s
  bool fell = false;
};

Swing swing_at(const Balance::Params& params, double latency_ms) {
  Balanced test(params, "0.001", std::to_string(latency_ms * 1e-3));
  Swing swing;
  const auto highest = [&](double time_s) {
    double low = 100, high = -100;
    for (double t = 0; t < time_s - 1e-9; t += 0.01) {
      test.balance_for(0.01);
      low = std::min(low, test.law.tilt_rad() * degrees);
      high = std::max(high, test.law.tilt_rad() * degrees);
    }
    return high - low;
  };
  test.balance_for(1);
  test.law.drive(0.1, 0);
  test.balance_for(0.3);
  test.law.drive(0, 0);
  test.balance_for(3.7);
  swing.first_deg = highest(5);
  test.balance_for(15);
  swing.last_deg = highest(5);
  swing.fell = test.law.fallen();
  return swing;
}

TEST(Balance, SwingsFromTheLatencyOnThatTheLinearModelAllows) {
  for (const double kd : {60.0, 80.0}) {
    Balance::Params params;
    params.kd_Nms_per_rad = kd;
    const double limit_ms = 1e3 * autonomy::delay_margin(params).delay_s;
    EXPECT_NEAR(limit_ms, kd == 60 ? 87.7 : 70.0, 0.1);
    // The growth per second near the limit is small, so it is looked for on both sides of it: 4 % of the delay.
    const Swing below = swing_at(params, std::floor(0.96 * limit_ms)),
                above = swing_at(params, std::ceil(1.04 * limit_ms));
    EXPECT_LT(below.last_deg, 0.05) << kd << ": dies away to the ticks of the encoders";
    EXPECT_GT(above.last_deg, 5) << kd << ": grows to what the motors can give";
    EXPECT_FALSE(above.fell) << kd;
  }
}

TEST(Balance, FallsWhenItIsMuchLater) {
  EXPECT_FALSE(swing_at({}, 120).fell);
  EXPECT_TRUE(swing_at({}, 150).fell);
}

TEST(Balance, StandsByGyroAndInclinometerAndFallsByTheInclinometerAlone) {
  Balanced by_both({.filter_s = 3}, "0.005", "0.02", "segway_imu");
  by_both.balance_for(60);
  EXPECT_FALSE(by_both.law.fallen());
  EXPECT_NEAR(by_both.law.speed_mps(), 0, 0.05);
  Balanced by_one({}, "0.005", "0.02", "segway_imu");
  by_one.balance_for(60);
  EXPECT_TRUE(by_one.law.fallen());
}

TEST(Balance, TiltsAsCommandedAndNoFasterThanItsLimit) {
  EXPECT_NEAR(Balance::Params{}.tilt_torque_Nm_per_rad, autonomy::BalanceModel{}.hold_torque(), 0.05);
  const double balanced_rad = Balance::Params{}.balanced_tilt_rad, tilt_rad = 4 / degrees;
  for (const double sign : {1.0, -1.0}) {
    Balanced test({});
    test.balance_for(5);
    test.law.command_tilt(sign * tilt_rad);
    test.balance_for(2);
    // It swings in: within a tenth of the tilt.
    EXPECT_NEAR(sign * (test.law.tilt_rad() - balanced_rad), tilt_rad, 0.1 * tilt_rad);
    // x'' = hold torque / (r (M + m)) = 3.81 m/s^2 per rad, so 0.27 m/s^2.
    const double before_mps = test.law.speed_mps();
    test.balance_for(1);
    EXPECT_NEAR(sign * (test.law.speed_mps() - before_mps), 3.81 * tilt_rad, 0.03);
    test.balance_for(30);
    EXPECT_NEAR(sign * test.law.speed_mps(), 1.5, 0.05);
    test.law.drive(0, 0);
    test.balance_for(20);
    EXPECT_NEAR(test.law.speed_mps(), 0, 0.02);
    EXPECT_FALSE(test.law.fallen());
  }
}

/// Long accelerations to both sides, as by the keys of a driver, mislead an inclinometer, and so the filter.
TEST(Balance, StandsByGyroAndInclinometerWhileADriverTiltsItToAndFro) {
  Balanced test({.filter_s = 3}, "0.005", "0.02", "segway_imu");
  test.balance_for(10);
  for (const double tilt_deg : {4.0, 0.0, -4.0, 0.0, 4.0, -4.0, 4.0}) {
    if (tilt_deg == 0)
      test.law.drive(0, 0);
    else
      test.law.command_tilt(tilt_deg / degrees);
    test.balance_for(4.5);
    ASSERT_FALSE(test.law.fallen()) << "at " << tilt_deg << " deg";
  }
  test.law.drive(0, 0.5);
  test.balance_for(5);
  test.law.drive(0, 0);
  test.balance_for(20);
  EXPECT_FALSE(test.law.fallen());
  EXPECT_NEAR(test.law.speed_mps(), 0, 0.05);
}

TEST(Balance, LimitsATiltThatIsTooLarge) {
  Balanced test({});
  test.balance_for(5);
  test.law.command_tilt(1);
  double largest_rad = 0;
  for (int i = 0; i < 1000; ++i) {
    test.balance_for(0.01);
    largest_rad = std::max(largest_rad, test.law.tilt_rad() - Balance::Params{}.balanced_tilt_rad);
  }
  EXPECT_FALSE(test.law.fallen());
  EXPECT_GT(largest_rad, 0.1);
  EXPECT_LT(largest_rad, 0.3);  // max_tilt_rad, 0.2, and what it swings over
}

TEST(Balance, TorqueIsThatOfThePdLaw) {
  Balance::Params params;
  params.kv_rad_per_mps = params.ki_rad_per_m = params.rate_filter_s = 0;
  Balance law(params);
  EXPECT_FALSE(law.step());  // nothing is known yet
  shoal::wheel_encoder_t wheels{};
  wheels.rate_radps = {0, 0};
  law.receive(wheels);
  shoal::inclination_t tilt{};
  tilt.utime = 1'000'000;
  tilt.pitch_rad = params.balanced_tilt_rad + 0.02;
  law.receive(tilt);
  EXPECT_NEAR(law.step()->left_Nm, 300 * 0.02 / 2, 1e-9);
  tilt.utime += 10'000;
  tilt.pitch_rad += 0.001;
  law.receive(tilt);
  law.receive(tilt);  // twice the same: the second is not new
  const auto torques = law.step();
  EXPECT_NEAR(torques->left_Nm, (300 * 0.021 + 60 * 0.1) / 2, 1e-9);
  EXPECT_EQ(torques->left_Nm, torques->right_Nm);
  tilt.utime += 10'000;
  tilt.pitch_rad += 1;
  law.receive(tilt);
  EXPECT_EQ(law.step()->left_Nm, 0);
  EXPECT_TRUE(law.fallen());
}

TEST(Balance, AMessageOfAnotherTimeDoesNotMakeItDeaf) {
  constexpr std::int64_t latest = std::numeric_limits<std::int64_t>::max(), first = -latest - 1;
  for (const std::int64_t strange : {latest, first, std::int64_t{3'000'000}, std::int64_t{1}}) {
    Balance law({});
    shoal::inclination_t tilt{};
    for (int i = 0; i < 100; ++i) {
      tilt.utime = 2'000'000 + 10'000 * i;
      tilt.pitch_rad = 0.001 * i;
      law.receive(tilt);
      shoal::inclination_t other = tilt;
      other.utime = strange;
      if (i == 50) law.receive(other);
    }
    EXPECT_EQ(law.tilt_rad(), tilt.pitch_rad) << strange;
    EXPECT_NEAR(law.rate_radps(), 0.1, 1e-6) << strange;  // the low pass has seen 0.49 s of it since
  }
}

TEST(Balance, RefusesWheelsThatAreNotTwo) {
  Balance law({});
  shoal::wheel_encoder_t wheels{};
  wheels.rate_radps = {0, 0, 0};
  EXPECT_THROW(law.receive(wheels), shoal::MessageError);
  Balance::Params bad;
  bad.period_s = 0;
  EXPECT_THROW(Balance{bad}, std::invalid_argument);
}

TEST(Balance, TimesOfSpeedsMustGrow) {
  EXPECT_NO_THROW(autonomy::check_speeds({}));
  EXPECT_NO_THROW(autonomy::check_speeds({{10, 0.5, 0}, {20, -0.5, 0.1}}));
  EXPECT_THROW(autonomy::check_speeds({{1, 2, 0}, {1, 3, 0}}), std::invalid_argument);
}

}  // namespace
