// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/start/start_files.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "sim/config/file_access.hpp"

namespace tools {
namespace {

constexpr const char* world_text = R"(# NAME: a world to begin with.
#   shoal check NAME.yaml                 every mistake, with line and column
#   shoal run NAME.yaml                   runs it; in a second terminal: shoal spy
#   shoal snap NAME.yaml --out NAME.png   an image of it
# Every key, with its default: shoal describe world.  Lengths in m, angles in degrees; x east, y north, z up.
shoal: 1
name: NAME
description: One vehicle on flat ground with a wall and a box.
run:
  duration_s: 60  # simulated time; forever: until `shoal control quit`
  speed: 1        # times real time; max: as fast as possible
  seed: 1         # of all noise: the same seed gives the same run
# physics: {step_s: 0.005}

objects:
  - {name: ground, fixed: true, parts: [{shape: plane}]}
  - name: wall
    fixed: true
    position_m: [5, 0, 0.5]
    parts: [{shape: box, size_m: [0.2, 6, 1], color: "#a0a0a0"}]
  # Without `fixed: true` it has a mass and can be pushed.
  - name: box
    position_m: [3, 2, 0.2]
    parts: [{shape: box, size_m: [0.4, 0.4, 0.4], mass_kg: 5, color: "#c08040"}]

vehicles:
  # Files are looked for beside this one, in ../vehicles and among the shipped ones (shoal list vehicles).
  - name: rover1
    file: VEHICLE
    position_m: [0, 0, 0]
    rpy_deg: [0, 0, 0]  # roll, pitch, yaw; yaw 0 looks east, 90 north
    # One value of the vehicle's file, here or by --set vehicles.rover1.devices.lidar.rate_hz=5:
    # overrides: {devices.lidar.rate_hz: 5}

# A first command without a program of your own: it drives off at 2 s, for 5 s.
events:
  - {name: go, at: 2, do: [{publish: {channel: rover1.drive.cmd, type: shoal.twist_command_t,
     value: {forward_mps: 0.5}}}]}
  - {name: halt, at: 7, do: [{publish: {channel: rover1.drive.cmd, type: shoal.twist_command_t,
     value: {forward_mps: 0}}}]}

# Metrics and the rules that they must meet (docs/guides/scoring.md).
metrics:
  - {name: distance, type: distance, vehicle: rover1}
  - {name: bumps, type: collisions, vehicle: rover1}
# pass:
#   - distance.travelled_m > 2

# Programs that --launch starts; one with a `client` name takes part in lockstep (docs/guides/attach_autonomy.md).
# processes:
#   - {name: pilot, client: pilot, command: [pilot/build/pilot]}  # as of `shoal new program pilot`
)";

constexpr const char* sea_text = R"(# NAME: a world under water to begin with.
#   shoal check NAME.yaml                 every mistake, with line and column
#   shoal run NAME.yaml                   runs it; in a second terminal: shoal spy
#   shoal medium NAME.yaml --profile      the water that it has
# Every key, with its default: shoal describe world.  Lengths in m, angles in degrees; x east, y north, z up.
shoal: 1
name: NAME
description: One AUV over a flat bottom in a current.
run:
  duration_s: 300  # simulated time; forever: until `shoal control quit`
  speed: 10        # times real time; max: as fast as possible
  seed: 1          # of all noise: the same seed gives the same run
physics: {step_s: 0.01}

# Water, current, waves and wind (docs/models/medium.md).
medium:
  water:
    profile:
      - {depth_m: 0, temperature_C: 16, salinity_psu: 34}
      - {depth_m: 30, temperature_C: 10, salinity_psu: 35}
  current: [{type: constant, velocity_mps: [0, 0.2, 0]}]

objects:
  - {name: bottom, fixed: true, position_m: [0, 0, -30], parts: [{shape: plane}]}

vehicles:
  # Files are looked for beside this one, in ../vehicles and among the shipped ones (shoal list vehicles).
  - name: auv1
    file: VEHICLE
    position_m: [0, 0, -5]
    rpy_deg: [0, 0, 0]  # roll, pitch, yaw; yaw 0 looks east, 90 north
    # Keys of the vehicle's file; what the autopilot can do is in docs/models/autopilots.md.
    overrides:
      devices.autopilot.waypoints:
        - {at_m: [100, 0], depth_m: 10, speed_mps: 1.5}
        - {at_m: [100, 60], depth_m: 10}
      devices.autopilot.at_end: circle

# Metrics and the rules that they must meet (docs/guides/scoring.md).
metrics:
  - {name: distance, type: distance, vehicle: auv1}
# pass:
#   - distance.travelled_m > 100

# Programs that --launch starts; one with a `client` name takes part in lockstep (docs/guides/attach_autonomy.md).
# processes:
#   - {name: pilot, client: pilot, command: [pilot/build/pilot]}  # as of `shoal new program pilot`
)";

constexpr const char* vehicle_text = R"(# NAME: a vehicle to begin with, a rover with two driven wheels and a lidar.
#   shoal check NAME.yaml                              every mistake, with line and column
#   shoal new world yard --vehicle NAME.yaml           a world with it
# Every key, with its default: shoal describe vehicle, shoal list devices, shoal describe lidar.
# The vehicle frame lies on the ground between the wheels: x forward, y left, z up.
shoal: 1
vehicle: NAME
description: Rover with two driven wheels and a lidar.

# `slick` is for the casters: they slide and need no wheels of their own.
materials:
  - {name: slick}
contacts:
  - {between: [slick, any], friction: 0}

# Bodies are made of parts; mass and inertia follow from the parts.
bodies:
  - name: base
    parts:
      # 1 cm to the rear, so that it tilts on the rear caster.
      - {name: chassis, shape: box, size_m: [0.5, 0.4, 0.12], position_m: [-0.01, 0, 0.14], mass_kg: 17,
         color: "#3070c0"}
      # Half a millimeter above the ground, so that the wheels carry the weight.
      - {name: front_caster, shape: sphere, radius_m: 0.04, position_m: [0.2, 0, 0.0405], material: slick}
      - {name: rear_caster, shape: sphere, radius_m: 0.04, position_m: [-0.2, 0, 0.0405], material: slick}
  # Spheres as wheels have one contact with the ground, at the exact place.
  - name: left_wheel
    position_m: [0, 0.2, 0.1]
    parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1.5, color: "#303030"}]
  - name: right_wheel
    position_m: [0, -0.2, 0.1]
    parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1.5, color: "#303030"}]

# The axis points left: a wheel that turns positively about it rolls forward.
joints:
  - {name: left, type: hinge, bodies: [base, left_wheel], axis: [0, 1, 0]}
  - {name: right, type: hinge, bodies: [base, right_wheel], axis: [0, 1, 0]}

# Devices report on VEHICLE.DEVICE and take commands on VEHICLE.DEVICE.cmd.
devices:
  # Takes shoal.twist_command_t.
  - name: drive
    type: differential_drive
    left_joint: left
    right_joint: right
    wheel_radius_m: 0.1
    track_m: 0.4  # between the wheels
    max_speed_mps: 1.2
    watchdog_s: 10  # without a command for so long it stops
  # `noise` is the error of each range; without the key the sensor is ideal.
  - name: lidar
    type: lidar
    position_m: [0, 0, 0.3]
    rate_hz: 10
    beams: 180
    fov_deg: 180
    range_max_m: 20
    noise: {gaussian_std: 0.01}
  - {name: odometry, type: odometry, left_joint: left, right_joint: right, wheel_radius_m: 0.1, track_m: 0.4,
     rate_hz: 20}
  # - {name: gps, type: gps, position_m: [0, 0, 0.3], rate_hz: 1}
)";

constexpr const char* auv_text =
    R"(# NAME: a vehicle to begin with, the shipped REMUS 100 with an autopilot and instruments.
#   shoal check NAME.yaml                              every mistake, with line and column
#   shoal new world bay --under-water --vehicle NAME.yaml    a world with it
# Every key, with its default: shoal describe vehicle, shoal list devices, shoal describe dvl.
# The vehicle frame: x forward, y left, z up, its origin at the center of buoyancy.
# Hull, fins and propeller are those of the included file.  For a hull of your own remove `include:` and write `bodies:`
# with `hydrodynamics:` and the devices `thruster` and `fin`, as that file does: docs/models/coefficients.md.
include: remus100.yaml
shoal: 1
vehicle: NAME
description: AUV with an autopilot, a DVL, an AHRS, GPS and an acoustic modem.

# Devices report on VEHICLE.DEVICE and take commands on VEHICLE.DEVICE.cmd.
devices:
  # Takes shoal.helm_command_t (speed, heading, depth) and shoal.route_command_t (waypoints).
  - {name: autopilot, type: autopilot, thrusters: [propeller], fins: [rudder, stern_planes]}
  # Velocity over the bottom.  `..._noise` is the error of a quantity; without the key a sensor is ideal.
  - {name: dvl, type: dvl, position_m: [0.3, 0, -0.095], rate_hz: 5, beam_std_mps: 0.003}
  - {name: ahrs, type: ahrs, rate_hz: 10, heading_noise: {gaussian_std: 0.02}}
  - {name: pressure, type: pressure, rate_hz: 10, pressure_noise: {gaussian_std: 100}}
  # Only at the surface.
  - {name: gps, type: gps, position_m: [0, 0, 0.12], rate_hz: 1, horizontal_noise: {gaussian_std: 1}}
  - {name: modem, type: acoustic_modem, position_m: [0, 0, -0.1]}
  # - {name: altimeter, type: altimeter, position_m: [0.4, 0, -0.095], rate_hz: 10}
)";

std::string filled(std::string text, const std::string& word, const std::string& with) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + with.size()))
    text.replace(at, word.size(), with);
  return text;
}

/// Returns the line by which an editor with a YAML language server finds the schema.
std::string schema_line(const std::string& schema) {
  return schema.empty() ? "" : "# yaml-language-server: $schema=" + schema + "\n";
}

}  // namespace

std::string start_world(const std::string& name, const std::string& vehicle_file, const std::string& schema) {
  return schema_line(schema) + filled(filled(world_text, "VEHICLE", vehicle_file), "NAME", name);
}

std::string start_sea(const std::string& name, const std::string& vehicle_file, const std::string& schema) {
  return schema_line(schema) + filled(filled(sea_text, "VEHICLE", vehicle_file), "NAME", name);
}

std::string start_vehicle(const std::string& name, bool under_water, const std::string& schema) {
  // The comment about channels contains VEHICLE.DEVICE, which is not replaced.
  return schema_line(schema) + filled(under_water ? auv_text : vehicle_text, "NAME", name);
}

namespace {

namespace fs = std::filesystem;

/// Returns an example without its license line, for a program and a vehicle with other names.
std::string adapted(const fs::path& file, const std::string& name, const std::string& vehicle) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read; the installation is incomplete");
  std::string text((std::istreambuf_iterator<char>(in)), {});
  if (text.substr(0, text.find('\n')).find("SPDX") != std::string::npos) text.erase(0, text.find('\n') + 1);
  text = replaced(std::move(text), " of worlds/minimal.yaml", "");
  // The vehicle last, because its name may contain the word.
  return replaced(replaced(std::move(text), "pilot", name), "rover1", vehicle);
}

fs::path shipped() {
  const std::string folder = sim::shipped_folder();
  if (folder.empty())
    throw std::runtime_error(
        "this program finds no shipped examples: there is neither share/shoal beside its folder nor a checkout that it "
        "was built from");
  return folder;
}

/// Returns the folder of the Python package of this installation or build folder.
fs::path package_folder() {
  std::error_code error;
  const fs::path prefix = fs::read_symlink("/proc/self/exe", error).parent_path().parent_path();
  // A build folder has the part in Python before its module is built.
  for (const char* folder : {"lib/python3/dist-packages", "lib/python"})
    for (const fs::directory_entry& file : fs::directory_iterator(prefix / folder / "shoal", error))
      if (file.path().extension() == ".so") return prefix / folder;
  throw std::runtime_error(
      "there is no Python package beside this program: `tools/build programs` in the checkout builds "
      "it, `cmake --install` installs it");
}

}  // namespace

std::string replaced(std::string text, const std::string& word, const std::string& with) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + with.size()))
    text.replace(at, word.size(), with);
  return text;
}

StartFiles start_cpp_program(const std::string& name, const std::string& vehicle) {
  const fs::path example = shipped() / "examples/client";
  return {{name + "/" + name + ".cpp", adapted(example / "pilot.cpp", name, vehicle)},
          {name + "/CMakeLists.txt", adapted(example / "CMakeLists.txt", name, vehicle)}};
}

StartFiles start_python_program(const std::string& name, const std::string& vehicle) {
  const std::string folder = package_folder().string();
  const std::string text = adapted(shipped() / "examples/python/pilot.py", name, vehicle);
  if (folder.starts_with("/usr/lib/")) return {{name + ".py", text}};  // python3 looks there
  const std::string path = "\nimport sys\n\nsys.path.insert(0, \"" + folder + "\")  # the Python package\n";
  return {{name + ".py", replaced(text, "\nimport sys\n", path)}};
}

}  // namespace tools
