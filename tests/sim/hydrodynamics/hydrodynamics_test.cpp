// SPDX-License-Identifier: BSD-3-Clause
// Where all actuators act alone, water, actuators and forces are computed vehicle by vehicle; with one that does not
// act alone, stage by stage.  Both give the same bits.
#include <gtest/gtest.h>

#include <string>

#include "shoal/actuator_command_t.hpp"
#include "sim/physics/body.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/hydrodynamics/marine_worlds.hpp"
#include "tests/state_hash_of.hpp"

namespace {

/// Two vehicles with a thruster each; `more`: another vehicle.
std::string thruster_world(const std::string& more) {
  const std::string vehicle =
      "    model: {shoal: 1, vehicle: test, bodies: [{name: hull, parts: [{shape: sphere, radius_m: 0.1}], "
      "hydrodynamics: {mass_kg: 20, buoyancy_N: 190, inertia_kgm2: [1, 2, 3], added_mass: [2, 9, 9, 0.1, 1, 1], "
      "linear_damping: [2, 8, 8, 1, 2, 2], center_of_mass_m: [0, 0, -0.03]}}], "
      "devices: [{name: thruster, type: thruster, position_m: [-0.5, 0.1, 0]}]}\n";
  return "shoal: 1\nphysics: {step_s: 0.01}\nmedium: {water: {}, current: [{velocity_mps: [0.2, 0.1, 0]}]}\n"
         "vehicles:\n  - name: first\n    position_m: [0, 0, -20]\n" +
         vehicle + "  - name: second\n    position_m: [50, 0, -30]\n" + vehicle + more;
}

std::uint64_t motion_after(const std::string& more, int threads) {
  test::TestWorld test(thruster_world(more));
  test.world.use_threads(threads);
  test.send("first.thruster.cmd", shoal::actuator_command_t{0, 0.7});
  test.send("second.thruster.cmd", shoal::actuator_command_t{0, -0.4});
  test.run_for(3);
  const auto hash_of = [&](const char* name) { return test::state_hash_of(test.world.find_vehicle(name)->base()); };
  return hash_of("first") ^ hash_of("second");
}

TEST(Groups, OneByOneGiveTheMotionOfAllTogether) {
  const std::string loud =
      "  - name: loud\n    position_m: [900, 0, -10]\n"
      "    model: {shoal: 1, vehicle: loud, bodies: [{name: hull, kinematic: true, parts: []}], "
      "devices: [{name: noise, type: noise_source, level_dB: 120}]}\n";
  EXPECT_EQ(motion_after("", 1), motion_after(loud, 1));
  EXPECT_EQ(motion_after("", 2), motion_after(loud, 1));
}

}  // namespace
