// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/marine/ranger.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/base/math.hpp"
#include "tests/autonomy/second.hpp"

namespace {

using autonomy::Ranger;
using autonomy::Vector2d;
using std::numbers::pi;
using test::second;

Ranger::Params mission() {
  Ranger::Params params;
  params.name = "ranger";
  params.surface_W = {{40, 0}, {40, 30}};
  params.dive_W = {{40, 100}};
  params.rise_W = {{80, 100}};
  params.walls_W = {{{-50, 140}, {150, 140}}};
  return params;
}

/// A vehicle that follows the commands at once; its gyro starts at 0 where it points.
class Voyage {
 public:
  bool has_gps = true, has_imu = true, has_sonar = true;
  Vector2d current_W{0.05, 0.03};
  Ranger ranger{mission()};
  Vector2d p_W{0, 0};
  double yaw_rad = 0.1, depth_m = 0;
  int last_fixes = 0;

  void run_for(double duration_s) {
    for (const std::int64_t end = utime_ + static_cast<std::int64_t>(duration_s * second); utime_ < end;) step();
  }

 private:
  void step() {
    constexpr double dt_s = 0.1;
    utime_ += second / 10;
    const double turn_radps =
        std::isfinite(heading_rad_) ? std::clamp(sim::wrap_angle(heading_rad_ - yaw_rad) / 1.0, -0.2, 0.2) : 0;
    yaw_rad += turn_radps * dt_s;
    speed_mps_ += (command_mps_ - speed_mps_) * dt_s / 4;
    const Vector2d v_W = autonomy::turned({speed_mps_, 0}, yaw_rad) + current_W;
    p_W += v_W * dt_s;
    depth_m += std::clamp(desired_depth_m_ - depth_m, -0.02, 0.02);
    if (has_imu) ranger.receive(shoal::imu_t{utime_, {0, 0, turn_radps}, {0, 0, 9.81}});
    if (++steps_ % 5 != 0) return;
    ranger.receive(shoal::pressure_t{utime_, 0, depth_m, 0});
    if (has_gps && depth_m < 0.3 && steps_ % 10 == 0) {
      shoal::gps_data_t fix{};
      fix.utime = utime_;
      fix.gps_lock = 1;
      fix.horizontal_accuracy = 0.5;
      fix.xyz_pos[0] = p_W.x();
      fix.xyz_pos[1] = p_W.y();
      fix.speed = v_W.norm();
      fix.heading = pi / 2 - std::atan2(v_W.y(), v_W.x());
      ranger.receive(fix);
    }
    if (has_sonar) ranger.receive(ping());
    const Ranger::Decision decision = ranger.step();
    if (decision.before_last_fix) ++last_fixes;
    if (!decision.helm) return;
    command_mps_ = decision.helm->speed_mps;
    if (std::isfinite(decision.helm->heading_rad)) heading_rad_ = decision.helm->heading_rad;
    desired_depth_m_ = decision.helm->depth_m;
  }

  shoal::multibeam_t ping() const {
    shoal::multibeam_t ping{};
    ping.utime = utime_;
    ping.count = 9;
    for (int i = 0; i < 9; ++i) {
      const double beam_rad = (i - 4) * pi / 12;
      const Vector2d sonar_W = p_W + autonomy::turned({0.7, 0}, yaw_rad);
      const auto hit = autonomy::first_wall(mission().walls_W, sonar_W, yaw_rad + beam_rad, 0);
      ping.angles_rad.push_back(static_cast<float>(beam_rad));
      ping.ranges_m.push_back(hit ? static_cast<float>(hit->range_m) : 100.0f);
      ping.strengths_dB.push_back(0);
      ping.valid.push_back(hit ? 1 : 0);
    }
    return ping;
  }

  std::int64_t utime_ = 100 * second;
  int steps_ = 0;
  double speed_mps_ = 0, command_mps_ = 0, heading_rad_ = autonomy::unknown, desired_depth_m_ = 0;
};

TEST(Ranger, TakesFixesDivesFollowsTheWallAndTakesALastFix) {
  Voyage voyage;
  voyage.run_for(70);
  EXPECT_EQ(voyage.ranger.phase(), Ranger::Phase::dived);
  voyage.run_for(45);
  EXPECT_EQ(voyage.ranger.phase(), Ranger::Phase::dived);
  // The wall bounds the error across it.
  EXPECT_NEAR(voyage.ranger.filter()->p_W().y(), voyage.p_W.y(), 0.3);
  EXPECT_GT(voyage.ranger.counts().ranges, 50);
  voyage.run_for(150);
  EXPECT_EQ(voyage.ranger.phase(), Ranger::Phase::done);
  EXPECT_EQ(voyage.last_fixes, 1);
}

TEST(Ranger, StaysWhereItIsWithoutAFix) {
  Voyage voyage;
  voyage.has_gps = false;
  voyage.current_W.setZero();
  voyage.run_for(100);
  EXPECT_EQ(voyage.ranger.phase(), Ranger::Phase::waiting_for_fix);
  EXPECT_LT(voyage.p_W.norm(), 1e-9);
}

TEST(Ranger, StaysWhereItIsWithoutImuAndIsLostWhenItFails) {
  Voyage never;
  never.has_imu = false;
  never.run_for(60);
  EXPECT_EQ(never.ranger.phase(), Ranger::Phase::waiting_for_fix);
  Voyage late;
  late.run_for(60);
  late.has_imu = false;
  late.run_for(10);
  EXPECT_EQ(late.ranger.phase(), Ranger::Phase::lost);
}

TEST(Ranger, DriftsWithoutItsSonar) {
  // A current that is new under water: the fixes at the surface know nothing of it.
  Voyage with, without;
  without.has_sonar = false;
  for (Voyage* voyage : {&with, &without}) {
    voyage->run_for(70);
    voyage->current_W = {0.05, -0.07};
    voyage->run_for(50);
  }
  EXPECT_LT(std::abs(with.ranger.filter()->p_W().y() - with.p_W.y()), 1);
  EXPECT_GT(std::abs(without.ranger.filter()->p_W().y() - without.p_W.y()), 3);  // 0.1 m/s for 50 s, less the dive
}

TEST(Ranger, IsCopiedWithItsState) {
  Voyage voyage;
  voyage.run_for(80);
  Ranger copy = voyage.ranger;
  const auto first = voyage.ranger.step();
  const auto second_decision = copy.step();
  EXPECT_EQ(first.helm->heading_rad, second_decision.helm->heading_rad);
  EXPECT_EQ(first.estimate->position_m[0], second_decision.estimate->position_m[0]);
}

TEST(Ranger, NeedsRoutes) {
  Ranger::Params params = mission();
  params.dive_W.clear();
  EXPECT_THROW(const Ranger refused(params), std::invalid_argument);
}

}  // namespace
