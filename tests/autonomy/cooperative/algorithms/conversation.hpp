// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/cooperative/estimator/payload.hpp"

namespace test {

inline constexpr navigation::Time nav_second = 1'000'000;
/// So far away that points of equal range are a straight line.
inline constexpr double far_m = 5e4;

inline navigation::Setup nav_setup(int vehicles, int own, const navigation::Vector2& position_W, double std_m) {
  navigation::Setup setup;
  for (int i = 0; i < vehicles; ++i) setup.team.push_back({"v" + std::to_string(i), {}});
  setup.own = own;
  setup.position_W = position_W;
  setup.position_std_m = std_m;
  setup.payload_bytes = 200;
  return setup;
}

inline std::unique_ptr<navigation::Estimator> started(const std::string& algorithm, const navigation::Setup& setup) {
  auto estimator = navigation::algorithm_named(algorithm).make();
  estimator->start(setup);
  return estimator;
}

inline navigation::ReceivedRange received_from(int sender, const navigation::Bytes& payload, double range_m,
                                               double std_m = 1, navigation::Time time = 0) {
  navigation::ReceivedRange received;
  received.toa = received.tol = received.payload_time = time;
  received.sender = sender;
  received.range_m = range_m;
  received.std_m = std_m;
  received.payload = payload;
  return received;
}

}  // namespace test
