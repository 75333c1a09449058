// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

#include "shoal/actuator_command_t.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "tests/devices/world_fixture.hpp"

namespace test {

inline constexpr double rounding_N = 1e-9;
inline constexpr double degree = std::numbers::pi / 180;

/// A box of 10 kg without weight or drag, 50 m under water of 1000 kg/m^3, one step of 1 ms at a time: what its devices
/// do to it can be read off its velocity.  `devices`: lines indented by eight spaces.
class WetBox : public TestWorld {
 public:
  explicit WetBox(const std::string& devices,
                  const std::string& medium = "{water: {density_kgpm3: 1000, surface_m: 50}}", double gravity_mps2 = 0)
      : TestWorld(yaml(devices, medium, gravity_mps2)), body(world.vehicles()[0]->body("hull")) {}

  static std::string yaml(const std::string& devices, const std::string& medium, double gravity_mps2) {
    return "shoal: 1\nphysics: {step_s: 0.001, gravity_mps2: " + std::to_string(gravity_mps2) + "}\nmedium: " + medium +
           R"(
vehicles:
  - name: v
    model:
      shoal: 1
      vehicle: box
      bodies:
        - name: hull
          hydrodynamics: {model: none}
          parts: [{shape: box, size_m: [1, 1, 1], mass_kg: 10}]
      devices:
)" + devices;
  }

  void command(double value, const std::string& device = "d") {
    shoal::actuator_command_t message{};
    message.value = value;
    send("v." + device + ".cmd", message);
  }
  /// The force in the next step, in the world; rounding of velocities leaves 1e-9 N.
  sim::Vector3d force_W() {
    const sim::Vector3d before = body.v_WB_W();
    world.step();
    return (body.v_WB_W() - before) * 10 / 1e-3;
  }
  /// The torque in the next step, of a body that does not turn; the moment of inertia of the box is 10 / 6 kg m^2.
  sim::Vector3d torque_W() {
    const sim::Vector3d before = body.w_WB_W();
    world.step();
    return (body.w_WB_W() - before) * (10.0 / 6) / 1e-3;
  }
  void set_velocity(const sim::Vector3d& v_W, const sim::Vector3d& w_W = sim::Vector3d::Zero()) {
    body.set_velocity_W(v_W, w_W);
  }
  template <typename Model>
  const Model& device(const std::string& name = "d") const {
    return dynamic_cast<const Model&>(*world.vehicles()[0]->find_device(name)->actuator());
  }

  sim::Body& body;
};

inline std::string wet_device(const std::string& keys) {
  return "        - {name: d, " + keys + "}\n";
}

/// What is wrong with a device; empty: nothing.
inline std::string error_of_device(const std::string& keys) {
  return error_of_world(WetBox::yaml(wet_device(keys), "{water: {}}", 0));
}

}  // namespace test
