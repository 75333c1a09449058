// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "shoal/twist_command_t.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/medium/log_capture.hpp"

namespace test {

inline shoal::twist_command_t twist(double forward_mps, double turn_radps) {
  shoal::twist_command_t command{};
  command.forward_mps = forward_mps;
  command.turn_radps = turn_radps;
  return command;
}

/// What is warned of when a world is built.
inline std::string warnings_of(const std::string& yaml) {
  const test_support::LogCapture log;
  TestWorld built(yaml);
  return log.text();
}

}  // namespace test
