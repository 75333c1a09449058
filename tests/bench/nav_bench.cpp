// SPDX-License-Identifier: BSD-3-Clause
// One event of the algorithms of cooperative navigation.
#include <benchmark/benchmark.h>

#include <cmath>

#include "autonomy/cooperative/estimator/estimator_registry.hpp"

namespace {

using namespace navigation;

constexpr Time second = 1'000'000;

Setup setup_of(int vehicles, int own, bool all_errors) {
  Setup setup;
  Member member;
  if (all_errors)
    member.errors = {.heading_bias_rad = 0.05,
                     .slow_heading_rad = 0.02,
                     .slow_heading_time_s = 20,
                     .speed_scale = 0.03,
                     .clock_s = 0.005,
                     .clock_drift = 1e-6};
  setup.team.assign(static_cast<std::size_t>(vehicles), member);
  setup.own = own;
  setup.position_W << 300.0 * own, 0;
  setup.payload_bytes = 120;
  return setup;
}

/// A cycle of the centralized filter: each vehicle moves 5 times a second for 10 s, one of them sends, and the others
/// receive it.  Arguments: vehicles; whether they have all lasting errors, 7 states each, or 2.
void centralized(benchmark::State& state) {
  const int vehicles = static_cast<int>(state.range(0));
  const auto team = algorithm_named("cekf").make_team();
  for (int i = 0; i < vehicles; ++i) team->start(i, setup_of(vehicles, i, state.range(1) != 0));
  const Matrix2 q = 0.01 * Matrix2::Identity();
  Time now = 0;
  int sender = 0;
  std::int64_t events = 0;
  for (auto _ : state) {
    for (int step = 0; step < 50; ++step) {
      now += second / 5;
      for (int i = 0; i < vehicles; ++i) team->predict(i, now, {1.5, 0.1 * i}, q);
    }
    team->sent(sender, now);
    for (int i = 0; i < vehicles; ++i) {
      if (i == sender) continue;
      ReceivedRange received;
      received.toa = received.tol = received.payload_time = now;
      received.sender = sender;
      received.range_m = 300.0 * std::abs(i - sender);
      team->on_range(i, received);
    }
    sender = (sender + 1) % vehicles;
    events += 50 * vehicles + vehicles;
  }
  state.SetItemsProcessed(events);
}

/// A range received by one vehicle, and the 50 motions until the next one.
void own(benchmark::State& state, const char* name) {
  const auto receiver = algorithm_named(name).make(), sender = algorithm_named(name).make();
  receiver->start(setup_of(4, 0, true));
  sender->start(setup_of(4, 1, true));
  const Matrix2 q = 0.01 * Matrix2::Identity();
  Time now = 0;
  std::int64_t events = 0;
  for (auto _ : state) {
    for (int step = 0; step < 50; ++step) {
      now += second / 5;
      receiver->predict(now, {1.5, 0.1}, q);
      sender->predict(now, {1.5, 0.1}, q);
    }
    const Bytes payload = sender->make_payload(now, 120);
    ReceivedRange received;
    received.toa = received.tol = received.payload_time = now;
    received.sender = 1;
    received.range_m = 300;
    received.payload = payload;
    receiver->on_range(received);
    events += 102;
  }
  state.SetItemsProcessed(events);
}

BENCHMARK(centralized)->Args({5, 0})->Args({5, 1})->Args({20, 1})->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(own, naive, "naive");
BENCHMARK_CAPTURE(own, ci, "ci");
BENCHMARK_CAPTURE(own, sci, "sci");
BENCHMARK_CAPTURE(own, iu, "iu");
BENCHMARK_CAPTURE(own, osm, "osm");
BENCHMARK_CAPTURE(own, deif, "deif");
BENCHMARK_CAPTURE(own, fls, "fls");

}  // namespace

BENCHMARK_MAIN();
