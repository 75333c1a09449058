// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <numbers>

#include "sim/random/random.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"

namespace {

using namespace navigation;
using test::nav_second;
using test::nav_setup;
using test::received_from;
using test::started;

/// A server and a client for 20 minutes: the client receives the server every 10 s, except for some losses, and the
/// server has a satellite fix every 5 minutes.  `compare` is called after each reception with the estimate of the
/// client and that of the centralized filter.  `server_q`: white noise of the server's displacement, m^2/s.
void converse(const std::string& algorithm, const std::function<bool(int)>& is_lost, std::size_t max_bytes,
              const std::function<void(const Estimate&, const Estimate&)>& compare, double server_q = 1e-3) {
  sim::Random random(1, "converse");
  const Setup server_setup = nav_setup(2, 0, {300, 0}, 1), client_setup = nav_setup(2, 1, {0, 0}, 1);
  const auto server = started(algorithm, server_setup), client = started(algorithm, client_setup);
  const auto team = algorithm_named("cekf").make_team();
  team->start(0, server_setup);
  team->start(1, client_setup);
  Vector2 true_server(300.5, -0.4), true_client(0.8, 0.3);
  for (int step = 1; step <= 1200; ++step) {
    const Time now = step * nav_second;
    const Vector2 v_server(1, 0.3), v_client(1.2 * std::cos(0.01 * step), 1.2 * std::sin(0.01 * step));
    true_server += v_server;
    true_client += v_client;
    const Matrix2 q_server = server_q * Matrix2::Identity(), q_client = 1e-2 * Matrix2::Identity();
    const Vector2 by_server = v_server + std::sqrt(server_q) * Vector2(random.gaussian(), random.gaussian());
    const Vector2 by_client = v_client + std::sqrt(1e-2) * Vector2(random.gaussian(), random.gaussian());
    server->predict(now, by_server, q_server);
    client->predict(now, by_client, q_client);
    team->predict(0, now, by_server, q_server);
    team->predict(1, now, by_client, q_client);
    if (step % 300 == 157) {
      const Vector2 fix = true_server + 3 * Vector2(random.gaussian(), random.gaussian());
      server->fix(now, fix, 3);
      team->fix(0, now, fix, 3);
    }
    if (step % 10 != 0) continue;
    const Bytes payload = server->make_payload(now, max_bytes);
    const double range_m = (true_server - true_client).norm() + random.gaussian();
    team->sent(0, now);
    if (is_lost(step / 10)) continue;
    client->on_range(received_from(0, payload, range_m, 1, now));
    team->on_range(1, received_from(0, {}, range_m, 1, now));
    compare(client->now(now), team->now(1, now));
  }
}

TEST(OriginStateMethod, IsTheCentralizedFilterAtEachReceptionWhateverIsLost) {
  for (const int kept_of : {1, 2, 5}) {
    int receptions = 0;
    converse(
        "osm", [&](int packet) { return packet % kept_of != 0; }, 118,
        [&](const Estimate& own, const Estimate& team) {
          ++receptions;
          EXPECT_LT((own.p_W - team.p_W).norm(), 1e-6) << kept_of << ", " << receptions;
          EXPECT_LT((own.P - team.P).norm(), 1e-6);
        });
    EXPECT_EQ(receptions, 120 / kept_of);
  }
}

TEST(OriginStateMethod, IsSoToCentimetersInFramesOfHalfTheSize) {
  // Numbers of 4 bytes: positions to 1e-4 m, and covariances to 1e-7 of their value, whose differences are used.
  converse(
      "osm", [](int packet) { return packet % 3 == 1; }, 57,
      [](const Estimate& own, const Estimate& team) { EXPECT_LT((own.p_W - team.p_W).norm(), 0.05); });
}

TEST(OriginStateMethod, LinksToAPacketThatWasSentBeforeTheSenderMoved) {
  for (const std::size_t max_bytes : {118U, 57U}) {
    const navigation::Setup server_setup = nav_setup(2, 0, {300, 0}, 1), client_setup = nav_setup(2, 1, {0, 0}, 1);
    const auto server = started("osm", server_setup), client = started("osm", client_setup);
    const auto team = algorithm_named("cekf").make_team();
    team->start(0, server_setup);
    team->start(1, client_setup);
    for (int second = 0; second <= 60; second += 20) {
      const Time now = second * nav_second;
      const Vector2 v_server(0, 1), v_client(1, 0);
      server->predict(now, v_server, 1e-2 * Matrix2::Identity());
      client->predict(now, v_client, 1e-2 * Matrix2::Identity());
      team->predict(0, now, v_server, 1e-2 * Matrix2::Identity());
      team->predict(1, now, v_client, 1e-2 * Matrix2::Identity());
      const double range_m = std::hypot(300 - second, second) + 0.5;
      team->sent(0, now);
      client->on_range(received_from(0, server->make_payload(now, max_bytes), range_m, 1, now));
      team->on_range(1, received_from(0, {}, range_m, 1, now));
      // Numbers of 8 bytes, or 4: as in the tests above.
      EXPECT_LT((client->now(now).p_W - team->now(1, now).p_W).norm(), max_bytes > 57 ? 1e-6 : 0.05) << second;
    }
    // The first range alone leaves 1 - 1 / (1 + 1 + 1) = 0.67 m^2 along the line, and 0.6 m^2 come by the motion.
    EXPECT_LT(client->now(60 * nav_second).P(0, 0), 1.2);
  }
}

TEST(OriginStateMethod, SaysItsPositionAloneWhenFixesReplacedWhatItSaid) {
  const auto server = started("osm", nav_setup(2, 0, {0, 0}, 100));
  const auto fix_at = [&](int second) {
    server->predict(second * nav_second, {0, 0}, 100 * Matrix2::Identity());
    server->fix(second * nav_second, {0, 0}, 1);
  };
  for (int second = 1; second <= 5; ++second) fix_at(second);
  // The first packet links what follows below to what it knew at the surface.
  EXPECT_EQ(server->make_payload(5 * nav_second, 57).size(), 57U);
  for (int second = 6; second <= 10; ++second) fix_at(second);
  EXPECT_EQ(server->make_payload(10 * nav_second, 57).size(), 13U);
  EXPECT_EQ(server->make_payload(10 * nav_second, 57).size(), 57U);
}

TEST(DecentralizedInformationFilter, IsTheCentralizedFilterWithoutLosses) {
  // Numbers of 4 bytes.
  converse(
      "deif", [](int) { return false; }, 67,
      [](const Estimate& own, const Estimate& team) {
        EXPECT_LT((own.p_W - team.p_W).norm(), 0.01);
        EXPECT_LT((own.P - team.P).norm(), 0.01);
      });
}

TEST(DecentralizedInformationFilter, ToleratesAsManyLossesInARowAsItRepeatsLinks) {
  converse(
      "deif", [](int packet) { return packet % 3 != 0; }, 3 + 3 * 64,
      [](const Estimate& own, const Estimate& team) { EXPECT_LT((own.p_W - team.p_W).norm(), 0.01); });
}

TEST(DecentralizedInformationFilter, IsLessSureAfterTheChainBroke) {
  double max_excess = 0, min_excess = 0;
  converse(
      "deif", [](int packet) { return packet == 60; }, 67,
      [&](const Estimate& own, const Estimate& team) {
        max_excess = std::max(max_excess, own.P.trace() - team.P.trace());
        min_excess = std::min(min_excess, own.P.trace() - team.P.trace());
      });
  EXPECT_GT(max_excess, 0.5);
  EXPECT_GT(min_excess, -0.01);
}

TEST(DecentralizedInformationFilter, KnowsNothingByRoundingAfterTheChainBroke) {
  // The numbers of a link are 1e5 1/m^2 and more with 3 mm of noise in 10 s, rounded to 0.01 1/m^2, of what the link
  // says of its earlier position.
  for (const double server_q : {1e-6, 1e-7, 1e-8})
    for (const int kept_of : {2, 3, 6, 11})
      converse(
          "deif", [&](int packet) { return packet % kept_of != 0; }, 67,
          [&](const Estimate& own, const Estimate& team) {
            const Vector2 off = own.p_W - team.p_W;
            EXPECT_LT(off.dot(own.P.inverse() * off), 13.8) << server_q << ", " << kept_of;  // 99.9 %
          },
          server_q);
}

class RangeOfATeam : public testing::TestWithParam<const char*> {};

TEST_P(RangeOfATeam, RefersToTheTransmissionAndReachesTheSenderToo) {
  const auto team = algorithm_named(GetParam()).make_team();
  team->start(0, nav_setup(2, 0, {0, 0}, 1));
  team->start(1, nav_setup(2, 1, {test::far_m, 0}, 2));
  team->sent(0, nav_second);
  team->predict(0, 5 * nav_second, {1, 0}, Matrix2::Zero());
  team->on_range(1, received_from(0, {}, test::far_m + 10, std::sqrt(5), nav_second));
  // S = 1 + 4 + 5: the copy of the sender moves by -1 m, and it with the copy.
  EXPECT_NEAR(team->now(0, 5 * nav_second).p_W.x(), 5 - 1, 1e-4);
  EXPECT_NEAR(team->now(1, 5 * nav_second).p_W.x(), test::far_m + 4, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(, RangeOfATeam, testing::Values("cekf", "luft"));

TEST(PairwiseCommunication, KeepsACovarianceWhenFixesOpenThePosition) {
  const auto luft = algorithm_named("luft").make_team();
  for (const int vehicle : {0, 1}) {
    navigation::Setup setup = nav_setup(2, vehicle, {20.0 * vehicle, 0}, 1);
    setup.gate = 10.83;
    luft->start(vehicle, setup);
  }
  Relative seen{.time = nav_second, .other = 1, .range_m = 20, .range_std_m = 0.1, .bearing_std_rad = 0.005};
  luft->on_bearing(0, seen);
  // Five fixes that are 100 m off, of which the last is used.
  for (int i = 2; i < 7; ++i) luft->fix(0, i * nav_second, {100, 0}, 3);
  EXPECT_NEAR(luft->now(0, 7 * nav_second).p_W.x(), 100, 1);
  // The vehicle is uncertain by 3 m, and correlated with the other one less than fully: both stay so after a relative
  // measurement that fits.
  seen.time = 7 * nav_second;
  seen.bearing_rad = std::numbers::pi;
  seen.range_m = 80;
  luft->on_bearing(0, seen);
  for (const int vehicle : {0, 1}) {
    const Matrix2 P = luft->now(vehicle, 7 * nav_second).P;
    EXPECT_GT(P(0, 0), 0) << vehicle;
    EXPECT_GT(P.determinant(), 0) << vehicle;
    EXPECT_LT(P.trace(), 18) << vehicle;
  }
}

TEST(PairwiseCommunication, IsTheCentralizedFilterForTwo) {
  // The approximations concern third vehicles, and own measurements after a meeting.
  const auto luft = algorithm_named("luft").make_team(), team = algorithm_named("cekf").make_team();
  for (TeamEstimator* each : {luft.get(), team.get()}) {
    each->start(0, nav_setup(2, 0, {0, 0}, 1));
    each->start(1, nav_setup(2, 1, {20, 0}, 2));
    for (int i = 1; i <= 10; ++i) {
      const Time now = i * nav_second;
      each->predict(0, now, {1, 0}, 0.1 * Matrix2::Identity());
      each->predict(1, now, {0, 1}, 0.2 * Matrix2::Identity());
      if (i == 1) each->fix(0, now, {1.5, 0.2}, 0.5);
      if (i % 2 != 0) continue;
      each->on_bearing(
          0,
          {.time = now, .other = 1, .range_m = 21, .bearing_rad = 0.2, .range_std_m = 0.15, .bearing_std_rad = 0.05});
    }
  }
  for (const int vehicle : {0, 1}) {
    const Estimate a = luft->now(vehicle, 10 * nav_second), b = team->now(vehicle, 10 * nav_second);
    EXPECT_LT((a.p_W - b.p_W).norm(), 1e-9);
    EXPECT_LT((a.P - b.P).norm(), 1e-9);
  }
}

}  // namespace
