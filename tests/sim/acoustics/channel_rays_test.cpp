// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/acoustics/channel.hpp"
#include "tests/sim/acoustics/sea_of_hydrophones.hpp"

// Refraction: the figures of a mixed layer over a thermocline, by BELLHOP.

namespace {

using namespace std::chrono_literals;
using sim::SignalLoss;
using sim::Vector3d;
using test::message;
using test::phone;
using test::TestWorld;
using test::vehicle;

constexpr double degree = std::numbers::pi / 180;

/// Linear in layers, as in the reference: 18 C down to 20 m, 8 C from 40 m on.
std::string thermocline(const std::string& acoustics, const std::string& vehicles, const std::string& objects = "") {
  return "shoal: 1\nname: sea\nphysics: {step_s: 0.01}\nmedium: {water: {profile: [\n"
         "  {depth_m: 0, sound_speed_mps: 1515.80}, {depth_m: 20, sound_speed_mps: 1516.12},\n"
         "  {depth_m: 40, sound_speed_mps: 1483.07}, {depth_m: 200, sound_speed_mps: 1485.68}]}}\nacoustics: " +
         acoustics + "\n" + objects + "vehicles:\n" + vehicles;
}

std::string two_at(double range_m, double receiver_m = 50, const std::string& keys = "") {
  return vehicle("a", "[0, 0, -1]") +
         vehicle("b", "[" + std::to_string(range_m) + ", 0, " + std::to_string(-receiver_m) + "]", keys);
}

/// What one receiver got of one message.
struct Arrived {
  bool any = false;
  double travel_time_s = 0;
  Vector3d apparent_W = Vector3d::Zero(), p_sent_W = Vector3d::Zero(), p_started_W = Vector3d::Zero();
  double level_dB = 0, closing_mps = 0;
  SignalLoss loss = SignalLoss::none;
};

Arrived send_one(TestWorld& test, sim::Time at = 0ms) {
  Arrived received;
  phone(test, "b").answer = [&](const sim::Reception& r) {
    received = {true, r.travel_time_s, r.apparent_W, r.p_sent_W, r.p_started_W, r.level.dB(), r.closing_mps, r.loss};
  };
  phone(test, "a").transducer().transmit(message(), at);
  test.run_for(8);
  phone(test, "b").answer = {};
  return received;
}

TEST(AcousticRays, TravelTimesAreThoseOfBellhop) {
  // Level range and travel time in ms.
  for (const auto& [range_m, time_ms] :
       {std::pair{100.0, 74.10549}, {500.0, 333.46289}, {1000.0, 663.03492}, {2000.0, 1322.57724}}) {
    TestWorld test(thermocline("{}", two_at(range_m)));
    const Arrived received = send_one(test);
    ASSERT_TRUE(received.any) << range_m;
    EXPECT_EQ(received.loss, SignalLoss::none) << range_m;
    EXPECT_NEAR(received.travel_time_s * 1e3, time_ms, 2e-4) << range_m;
  }
}

TEST(AcousticRays, LevelsAreThoseOfTheRayTube) {
  for (const auto& [range_m, loss_dB] : {std::pair{100.0, 41.05}, {500.0, 58.22}, {1000.0, 69.26}}) {
    TestWorld test(thermocline("{absorption: {model: constant, dBpkm: 0}}", two_at(range_m)));
    EXPECT_NEAR(send_one(test).level_dB, 185 - loss_dB, 0.03) << range_m;
  }
}

TEST(AcousticRays, TheSenderAppearsWhereTheSoundComesFrom) {
  TestWorld bent(thermocline("{}", two_at(1000)));
  const Arrived received = send_one(bent);
  EXPECT_NEAR(std::asin(received.apparent_W.z() / received.apparent_W.norm()) / degree, 12.011, 0.01);
  EXPECT_NEAR(received.apparent_W.norm(), std::hypot(1000, 49), 1e-9);
  TestWorld straight(thermocline("{propagation: straight}", two_at(1000)));
  EXPECT_EQ(send_one(straight).apparent_W, Vector3d(-1000, 0, 49));
}

TEST(AcousticRays, AreTheDefaultWhereTheWaterHasAProfileOnly) {
  const auto bends = [](const std::string& text) { return TestWorld(text).world.acoustics().propagation().bends(); };
  EXPECT_TRUE(bends(thermocline("{}", two_at(10))));
  EXPECT_FALSE(bends(thermocline("{propagation: straight}", two_at(10))));
  EXPECT_FALSE(bends(test::sea("{}", two_at(10))));
  EXPECT_TRUE(bends(test::sea("{propagation: rays}", two_at(10))));
}

TEST(AcousticRays, InWaterOfOneSpeedNothingChanges) {
  TestWorld straight(test::sea("{spreading: {factor: 2}}", two_at(700))),
      rays(test::sea("{propagation: rays}", two_at(700)));
  const Arrived one = send_one(straight), other = send_one(rays);
  EXPECT_NEAR(one.travel_time_s, other.travel_time_s, 1e-9);
  EXPECT_NEAR(one.level_dB, other.level_dB, 1e-6);
  EXPECT_LT((one.apparent_W - other.apparent_W).norm(), 1e-4);
}

TEST(AcousticRays, AShadowTakesWhatTheStraightLineWouldDeliver) {
  // The last ray from 1 m to 50 m grazes the bottom of the mixed layer.
  TestWorld inside(thermocline("{}", two_at(1900)));
  EXPECT_EQ(send_one(inside).loss, SignalLoss::none);
  TestWorld beyond(thermocline("{}", two_at(2300)));
  EXPECT_EQ(send_one(beyond).loss, SignalLoss::shadow);
  TestWorld straight(thermocline("{propagation: straight}", two_at(2300)));
  EXPECT_EQ(send_one(straight).loss, SignalLoss::none);
}

TEST(AcousticRays, AWaveReachesTheEdgeOfAShadow) {
  // Both ends at the depth of the highest speed, from which all rays bend away.  The ray that leaves level is 5 cm
  // above at 100 m and 21 m at 2 km; half of sqrt(wavelength x range) is 1.2 m and 5.5 m at 25 kHz.
  const auto both_at_20_m = [](double range_m) {
    return vehicle("a", "[0, 0, -20]") + vehicle("b", "[" + std::to_string(range_m) + ", 0, -20]");
  };
  TestWorld near(thermocline("{}", both_at_20_m(100))),
      straight(thermocline("{propagation: straight, spreading: {factor: 2}}", both_at_20_m(100)));
  const Arrived near_one = send_one(near);
  EXPECT_EQ(near_one.loss, SignalLoss::none);
  EXPECT_NEAR(near_one.level_dB, send_one(straight).level_dB - 6, 1e-6);
  TestWorld far(thermocline("{}", both_at_20_m(2000)));
  EXPECT_EQ(send_one(far).loss, SignalLoss::shadow);
}

TEST(AcousticRays, SoundLeaksIntoAShadowWithTheLossOfItsKey) {
  TestWorld straight(thermocline("{propagation: straight, spreading: {factor: 2}}", two_at(2300)));
  TestWorld leaks(thermocline("{shadow_loss_dB: 25}", two_at(2300)));
  const Arrived full = send_one(straight), leaked = send_one(leaks);
  EXPECT_EQ(leaked.loss, SignalLoss::none);
  EXPECT_NEAR(leaked.level_dB, full.level_dB - 25, 1e-6);
  EXPECT_NEAR(leaked.travel_time_s, full.travel_time_s, 1e-9);
}

TEST(AcousticRays, AnEchoOfTheBottomReachesAShadowLater) {
  TestWorld test(thermocline("{multipath: {water_depth_m: 80, window_s: 0.05, bottom: {loss_dB: 3}}}", two_at(2500)));
  TestWorld straight(thermocline("{propagation: straight}", two_at(2500)));
  const Arrived echo = send_one(test), direct = send_one(straight);
  EXPECT_EQ(echo.loss, SignalLoss::none);
  // The first arrival at 2.5 km in water of 80 m: 5.5 m longer.
  EXPECT_NEAR((echo.travel_time_s - direct.travel_time_s) * 1500, 5.5, 0.5);
}

TEST(AcousticRays, MeetAMovingReceiver) {
  TestWorld test(thermocline("{}", vehicle("a", "[0, 0, -1]", "", 2, 90) + vehicle("b", "[900, 0, -50]", "", 3, 0)));
  test.run_for(10);
  const Arrived received = send_one(test, 10s);
  ASSERT_EQ(received.loss, SignalLoss::none);
  const auto first = test.world.acoustics().propagation().first_arrival(received.p_sent_W, received.p_started_W, 25000);
  EXPECT_NEAR(received.travel_time_s, first.travel_time_s, 1e-8);
  EXPECT_NEAR(received.p_started_W.x(), 900 + 3 * (10 + received.travel_time_s), 2e-6)
      << "started is in whole microseconds";
  EXPECT_NEAR(received.closing_mps, first.leaves_W.dot(Vector3d(0, 2, 0)) - first.arrives_W.dot(Vector3d(3, 0, 0)),
              1e-6);
}

TEST(AcousticRays, AReceiverTakesAnEchoForTheFirstArrivalAtItsRate) {
  // The echo of the surface comes 89 us later, less than the 250 us that a band of 4 kHz resolves.
  const std::string keys =
      "echo_lock: {probability: 1, margin_dB: 60}, multipath: {water_depth_m: 60, window_s: 0.1, "
      "max_bounces: 1, surface_loss_dB: 0, bottom: {loss_dB: 0}, phases: geometric}";
  for (const char* paths : {"straight", "rays"}) {
    TestWorld test(test::sea("{propagation: " + std::string(paths) + ", " + keys + "}", two_at(300, 20)));
    int late = 0, taken = 0;
    double snr_dB = 0, latest_s = 0;
    phone(test, "b").answer = [&](const sim::Reception& r) {
      ++taken;
      snr_dB = r.snr.dB();
      latest_s = std::max(latest_s, r.travel_time_s);
      if (r.travel_time_s > std::hypot(300, 19) / 1500 + 1e-6) ++late;
    };
    sim::Signal ping = message(165);
    ping.duration = 20ms;
    ping.bits = 0;
    constexpr int pings = 400;
    for (int i = 0; i < pings; ++i) {
      phone(test, "a").transducer().transmit(ping, test.world.now());
      test.run_for(0.5);
    }
    ASSERT_EQ(taken, pings);
    // The echo of the bottom is longer by 5 %, which costs 0.4 dB.
    const double rate = std::exp(-(snr_dB - 6) / 60) * 0.91;
    EXPECT_NEAR(static_cast<double>(late) / pings, rate, 0.2 * rate) << snr_dB;
    EXPECT_NEAR(latest_s, std::hypot(300, 60 + 60 - 1 - 20) / 1500, 1e-6);
  }
}

}  // namespace
