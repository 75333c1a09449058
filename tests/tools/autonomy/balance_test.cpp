#include "tools/autonomy/balance.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "shoal/inclination_t.hpp"
#include "shoal/joint_servo_command_t.hpp"
#include "shoal/wheel_encoder_t.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tools/autonomy/balance_model.hpp"

namespace {

using autonomy::Balance;

constexpr double degrees = 180 / std::numbers::pi;

/// worlds/segway.yaml with the balance law in the same process, and without its latency.
struct Balanced : test::LoadedTestWorld {
  explicit Balanced(const Balance::Params& params, const std::string& physics_step_s = "0.005",
                    const std::string& latency_s = "0.02")
      : LoadedTestWorld(sim::load_world(
            SHOAL_SOURCE_DIR "/worlds/segway.yaml",
            with_messages({.sets = {"physics.step_s=" + physics_step_s,
                                    "vehicles.segway1.actuator_latency_s=" + latency_s, "metrics=[]", "pass=[]"}}))),
        law(params),
        inclination_(*this, "segway1.inclinometer"),
        encoder_(*this, "segway1.encoder") {}

  void balance_for(double time_s) {
    const sim::Time end = world.now() + sim::from_seconds(time_s);
    while (world.now() < end && !law.fallen()) {
      world.step();
      const auto leans = inclination_.take_all();
      for (const auto& wheels : encoder_.take_all()) law.receive(wheels);
      for (const auto& lean : leans) law.receive(lean);
      if (leans.empty()) continue;
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
};

TEST(Balance, TenMinutesStanding) {
  Balanced test({});
  test.balance_for(600);
  EXPECT_FALSE(test.law.fallen());
  EXPECT_NEAR(test.law.lean_rad() * degrees, -9.93, 0.1);
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
  test.balance_for(1);
  const double before = yaw();
  test.balance_for(4);
  EXPECT_NEAR(yaw() - before, 1.2, 0.12);
  EXPECT_FALSE(test.law.fallen());
}

/// The highest latency, in ms, at which it stands for 20 s; its step is 1 ms.
int highest_latency_ms(const Balance::Params& params) {
  int stands = 20, falls = 200;
  while (falls - stands > 1) {
    const int middle = (stands + falls) / 2;
    Balanced test(params, "0.001", std::to_string(middle * 1e-3));
    test.balance_for(20);
    (test.law.fallen() ? falls : stands) = middle;
  }
  return stands;
}

TEST(Balance, FallsAtTheLatencyThatTheLinearModelAllows) {
  for (const double kd : {60.0, 80.0}) {
    Balance::Params params;
    params.kd_Nms_per_rad = kd;
    const double limit_ms = 1e3 * autonomy::delay_margin(params).delay_s;
    std::printf("kd %g: model %.1f ms, simulated %d ms\n", kd, limit_ms, highest_latency_ms(params));
  }
}

}  // namespace
