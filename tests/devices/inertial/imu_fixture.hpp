// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "shoal/imu_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace imu_fixture {

inline std::string imu(const std::string& more = "") {
  return "        - {name: imu, type: imu, rate_hz: 100, phase_s: 0, truth: true" + more + "}\n";
}

inline sim::Vector3d gyro_of(const shoal::imu_t& report) {
  return sim::Vector3d(report.angular_velocity_radps);
}

inline sim::Vector3d accel_of(const shoal::imu_t& report) {
  return sim::Vector3d(report.linear_acceleration_mps2);
}

inline sim::Body& hull(test::TestWorld& test) {
  return test.world.vehicles()[0]->body("hull");
}

}  // namespace imu_fixture
