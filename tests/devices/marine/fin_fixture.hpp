// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/world/world_editor.hpp"
#include "tests/devices/marine/marine_fixture.hpp"

namespace fin_fixture {

/// Force on a fin that is at its angle, at this velocity.
inline sim::Vector3d force(const std::string& keys, double angle_rad, const sim::Vector3d& v_W) {
  test::WetBox box(test::wet_device("type: fin, " + keys));
  box.command(angle_rad);
  box.set_velocity(v_W);
  return box.force_W();
}

}  // namespace fin_fixture
