// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/filters/chi_square.hpp"
#include "sim/random/random.hpp"

namespace test {

/// Monte Carlo runs of cooperative navigation without a simulator: three AUVs in a lawnmower of legs 400 m x 60 m, 300
/// m apart, and a craft on a circle of 250 m, all at 1.5 m/s for an hour.  Dead reckoning has white noise, each vehicle
/// starts with 1 m; one of the four sends every 10 s, and 20 % of the packets are lost.  Ranges have 1 m.
struct TeamDive {
  double along_mprts = 0.03, across_mprts = 0.12;  ///< noise of dead reckoning in the first second
  bool server_is_better = false;                   ///< AUV 0 has 0.01 and 0.02, and is the only sender
  double craft_silent_after_s = 1e9;
  bool only_first_hears_the_craft = false;
  double duration_s = 3600, scored_from_s = 600;
  double loss = 0.2, range_std_m = 1;
  std::size_t payload_bytes = 120;
};

/// Figures over AUVs, seeds and time.
struct DiveScore {
  double squares_m2 = 0, nees = 0;
  int samples = 0, inside = 0;

  double rms_m() const { return std::sqrt(squares_m2 / samples); }
  double nees_mean() const { return nees / samples; }
  double inside_95() const { return static_cast<double>(inside) / samples; }
};

/// Runs an algorithm on some seeds; `squares_by_seed`, if given, receives the mean square error of each.
inline DiveScore run_dive(const TeamDive& dive, const std::string& algorithm, int seeds) {
  using namespace navigation;
  constexpr int auvs = 3, craft = 3;
  const navigation::Algorithm& entry = algorithm_named(algorithm);
  DiveScore score;
  for (int seed = 1; seed <= seeds; ++seed) {
    sim::Random random(static_cast<std::uint64_t>(seed), "team_dive");
    const int vehicles = dive.server_is_better ? auvs : auvs + 1;
    std::array<Vector2, 4> truth;
    std::vector<std::unique_ptr<Estimator>> own;
    std::unique_ptr<TeamEstimator> team;
    if (entry.make_team) team = entry.make_team();
    const auto leg_of = [&](int vehicle, double t_s) -> Vector2 {
      if (vehicle == craft) return {-1.5 * std::sin(1.5 * t_s / 250), 1.5 * std::cos(1.5 * t_s / 250)};
      const double distance_m = std::fmod(1.5 * t_s, 920);
      if (distance_m < 400) return {1.5, 0};
      if (distance_m < 460) return {0, 1.5};
      return distance_m < 860 ? Vector2(-1.5, 0) : Vector2(0, 1.5);
    };
    for (int i = 0; i < vehicles; ++i) {
      truth[static_cast<std::size_t>(i)] = i == craft ? Vector2(450, 300) : Vector2(0, 300.0 * i);
      Setup setup;
      for (int k = 0; k < vehicles; ++k) setup.team.push_back({"v" + std::to_string(k), {}});
      setup.own = i;
      setup.payload_bytes = dive.payload_bytes;
      setup.position_std_m = 1;
      setup.position_W = truth[static_cast<std::size_t>(i)] + Vector2(random.gaussian(), random.gaussian());
      if (team) {
        team->start(i, setup);
      } else {
        own.push_back(entry.make());
        own.back()->start(setup);
      }
    }
    const int steps = static_cast<int>(dive.duration_s);
    for (int step = 1; step <= steps; ++step) {
      const Time now = step * Time{1'000'000};
      for (int i = 0; i < vehicles; ++i) {
        Vector2& p = truth[static_cast<std::size_t>(i)];
        const Vector2 v = leg_of(i, step - 1);
        const Vector2 ahead = v.normalized();
        const Vector2 left(-ahead.y(), ahead.x());
        const bool better = dive.server_is_better && i == 0;
        const double along = better ? 0.01 : dive.along_mprts, across = better ? 0.02 : dive.across_mprts;
        const Vector2 measured = v + along * random.gaussian() * ahead + across * random.gaussian() * left;
        Matrix2 q = along * along * ahead * ahead.transpose() + across * across * left * left.transpose();
        p += v;
        if (i == craft) q = 100 * Matrix2::Identity();  // its position is that of the last fix
        team ? team->predict(i, now, measured, q) : own[static_cast<std::size_t>(i)]->predict(now, measured, q);
        if (i != craft) continue;
        const Vector2 fix = p + Vector2(random.gaussian(), random.gaussian());
        team ? team->fix(i, now, fix, 1) : own[static_cast<std::size_t>(i)]->fix(now, fix, 1);
      }
      if (step % 10 == 0) {
        const int sender = step / 10 % 4;
        if (sender < (dive.server_is_better ? 1 : vehicles) && !(sender == craft && step > dive.craft_silent_after_s)) {
          Bytes payload;
          if (team)
            team->sent(sender, now);
          else
            payload = own[static_cast<std::size_t>(sender)]->make_payload(now, dive.payload_bytes);
          for (int i = 0; i < auvs; ++i) {
            const bool lost = random.uniform() < dive.loss;
            const double noise_m = dive.range_std_m * random.gaussian();
            if (i == sender || lost || (sender == craft && dive.only_first_hears_the_craft && i > 0)) continue;
            ReceivedRange received;
            received.toa = received.tol = received.payload_time = now;
            received.sender = sender;
            received.range_m =
                (truth[static_cast<std::size_t>(i)] - truth[static_cast<std::size_t>(sender)]).norm() + noise_m;
            received.std_m = dive.range_std_m;
            received.payload = payload;
            team ? team->on_range(i, received) : own[static_cast<std::size_t>(i)]->on_range(received);
          }
        }
      }
      if (step < dive.scored_from_s || step % 10 != 5) continue;
      for (int i = dive.server_is_better ? 1 : 0; i < auvs; ++i) {
        const Estimate estimate = team ? team->now(i, now) : own[static_cast<std::size_t>(i)]->now(now);
        const Vector2 error = estimate.p_W - truth[static_cast<std::size_t>(i)];
        const double nees = error.dot(estimate.P.inverse() * error);
        score.squares_m2 += error.squaredNorm();
        score.nees += nees;
        score.inside += nees < autonomy::chi_square_95_2 ? 1 : 0;
        ++score.samples;
      }
    }
  }
  return score;
}

}  // namespace test
