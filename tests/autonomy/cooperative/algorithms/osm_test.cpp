// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "tests/autonomy/cooperative/algorithms/centralized_fixture.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"

namespace {

using namespace centralized_fixture;
using namespace navigation;

using test::nav_second;
using test::nav_setup;
using test::received_from;
using test::started;

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

}  // namespace
