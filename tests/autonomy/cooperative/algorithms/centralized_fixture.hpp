// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <string>

#include "sim/random/random.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"

namespace centralized_fixture {

using namespace navigation;

/// A server and a client for 20 minutes: the client receives the server every 10 s, except for some losses, and the
/// server has a satellite fix every 5 minutes.  `compare` is called after each reception with the estimate of the
/// client and that of the centralized filter.  `server_q`: white noise of the server's displacement, m^2/s.
inline void converse(const std::string& algorithm, const std::function<bool(int)>& is_lost, std::size_t max_bytes,
                     const std::function<void(const Estimate&, const Estimate&)>& compare, double server_q = 1e-3) {
  sim::Random random(1, "converse");
  const Setup server_setup = test::nav_setup(2, 0, {300, 0}, 1), client_setup = test::nav_setup(2, 1, {0, 0}, 1);
  const auto server = test::started(algorithm, server_setup), client = test::started(algorithm, client_setup);
  const auto team = algorithm_named("cekf").make_team();
  team->start(0, server_setup);
  team->start(1, client_setup);
  Vector2 true_server(300.5, -0.4), true_client(0.8, 0.3);
  for (int step = 1; step <= 1200; ++step) {
    const Time now = step * test::nav_second;
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
    client->on_range(test::received_from(0, payload, range_m, 1, now));
    team->on_range(1, test::received_from(0, {}, range_m, 1, now));
    compare(client->now(now), team->now(1, now));
  }
}

}  // namespace centralized_fixture
