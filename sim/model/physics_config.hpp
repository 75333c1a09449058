// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/model/hydrodynamics_config.hpp"
#include "sim/model/joint_type.hpp"
#include "sim/model/part_shape.hpp"
#include "sim/scene/material.hpp"
#include "sim/scene/scene.hpp"
#include "sim/terrain/terrain_config.hpp"

namespace sim {

/// Section `physics:` of a world.
struct PhysicsConfig {
  /// Constraint solver of ODE: chosen by the size of an island, dWorldStep or dWorldQuickStep.
  enum class Solver { automatic, step, quick };
  static constexpr ChoiceWords<Solver> solver_words{
      {"auto", Solver::automatic}, {"step", Solver::step}, {"quick", Solver::quick}};
  /// Broad phase of collision detection (ODE space).
  enum class Space { sap, quadtree, hash, simple };
  static constexpr ChoiceWords<Space> space_words{
      {"sap", Space::sap}, {"quadtree", Space::quadtree}, {"hash", Space::hash}, {"simple", Space::simple}};

  double step_s = 0.01;           ///< a whole number of microseconds
  double gravity_mps2 = 9.80665;  ///< downwards (ISO 80000-3 standard gravity)
  Solver solver = Solver::automatic;
  int quick_above_rows = 100;  ///< auto: QuickStep for islands with more constraint rows
  int quick_iterations = 20;
  double erp = 0.2;
  double cfm = 1e-9;
  double contact_max_correcting_velocity_mps = 1.0;
  double contact_surface_layer_m = 0.0005;
  int max_contacts_per_pair = 8;
  Space space = Space::sap;  ///< broad phase of collision detection
  RayLibrary rays = RayLibrary::embree;
  double max_speed_mps = 1000;  ///< a faster body stops the run: the simulation has diverged
  double max_distance_m = 1e7;  ///< a body farther from the origin stops the run

  void read(ParamReader& in);
};

/// Contact parameters of a pair of materials.  `any` stands for every material.  An entry that names both materials
/// takes precedence over one with `any`; among equal entries the last one is used.
struct ContactConfig {
  std::vector<std::string> between = {"any", "any"};  ///< two names of materials, or `any`
  double friction = 0.8;                              ///< Coulomb friction coefficient (ODE's dContactApprox1)
  double restitution = 0;                             ///< coefficient of restitution, 0 to 1
  double restitution_velocity_mps = 0.1;              ///< minimum impact speed for a bounce
  std::optional<double> soft_erp;                     ///< unset: erp of the world
  std::optional<double> soft_cfm;                     ///< unset: cfm of the world
  double rolling_friction_m = 0;                      ///< rolling resistance as a lever, m (ODE's rho)
  double spinning_friction_m = 0;                     ///< resistance to spinning about the normal (ODE's rhoN)
  double slip = 0;                                    ///< force dependent slip, (m/s)/N (ODE's slip1 and slip2)

  void read(ParamReader& in);
  bool operator==(const ContactConfig&) const = default;
};

/// Part of a body: shape, mass, material, and pose in the body frame.
struct PartConfig {
  std::string name;
  PartShape shape = PartShape::box;    ///< the normal of a plane is +z of its frame
  Vector3d size_m = Vector3d::Ones();  ///< box: x, y, z
  double radius_m = 0.5;               ///< sphere, capsule, cylinder
  double length_m = 1.0;               ///< length along z: capsule without its caps, cylinder
  std::string mesh;                    ///< mesh: STL or OBJ file, relative to the YAML file
  double scale = 1.0;                  ///< mesh: factor from coordinates in the file to m
  std::optional<TerrainConfig> terrain;
  Vector3d position_m = Vector3d::Zero();
  Vector3d rpy_rad = Vector3d::Zero();
  std::optional<double> mass_kg;
  std::optional<double> density_kgpm3;  ///< instead of mass_kg
  std::string material = "default";
  std::string category = "solid";
  std::vector<std::string> collides_with;  ///< categories; empty: all
  std::string color;                       ///< `#rrggbb`, in images and viewers; empty: color of the material
  // Parameters in water, for a free body without hydrodynamic coefficients.
  bool displaces = true;                 ///< buoyancy and drag act on the part
  bool displaces_was_given = false;      ///< the key `displaces` is in the file
  std::vector<double> drag_coefficient;  ///< one, or three along x, y and z of the part; empty: default of the shape
  double added_mass_coefficient = 0.5;   ///< added mass over displaced mass of water; 0.5: sphere

  SourcePlace place;      ///< position in the YAML file, for errors while building
  std::string directory;  ///< directory of the YAML file, for relative paths of mesh files

  void read(ParamReader& in);

 private:
  void read_water_keys(ParamReader& in);
  void read_drag_coefficient(ParamReader& in);
};

/// Rigid body: parts that move together.
struct BodyConfig {
  std::string name;
  Vector3d position_m = Vector3d::Zero();  ///< origin of the body frame B in the vehicle frame V
  Vector3d rpy_rad = Vector3d::Zero();
  std::vector<PartConfig> parts;
  bool kinematic = false;                            ///< moved by a device, not by forces
  std::optional<HydrodynamicsConfig> hydrodynamics;  ///< its mass replaces the mass of the parts
  bool has_coefficients() const {
    return hydrodynamics && hydrodynamics->model == HydrodynamicsConfig::Model::coefficients;
  }
  SourcePlace place;  ///< position in the YAML file, for errors while building

  void read(ParamReader& in);
};

/// Returns what is wrong with a finite stop of a joint's axis; empty: nothing.
std::string error_of_stop(JointType type, double stop);

/// Parameters of one axis of a joint.
struct JointAxisConfig {
  Vector3d axis = Vector3d::UnitZ();  ///< in the vehicle frame
  std::optional<double> low_stop;     ///< rad, or m for a slider
  std::optional<double> high_stop;
  double motor_velocity = 0;   ///< rad/s, or m/s of a slider
  double motor_max_force = 0;  ///< N m, or N of a slider; 0: no motor
  double damping = 0;          ///< N m s/rad, or N s/m for a slider
  std::optional<double> restitution, cfm, stop_erp, stop_cfm, fudge_factor, suspension_erp, suspension_cfm, erp;

  void read(ParamReader& in);
};

/// Joint between two bodies, or between a body and the world.
struct JointConfig {
  std::string name;
  JointType type = JointType::hinge;
  std::vector<std::string> bodies;       ///< two names; the second may be `world`
  Vector3d anchor_m = Vector3d::Zero();  ///< in the vehicle frame
  bool anchored = false;                 ///< true: `anchor_m` is in the file; false: origin of the second body
  JointAxisConfig axis1;                 ///< ball with a motor: applies to all axes
  JointAxisConfig axis2;                 ///< hinge2 and universal
  bool motor = false;                    ///< ball: has a motor about x, y and z of the vehicle frame
  SourcePlace place;                     ///< position in the YAML file, for warnings while building

  void read(ParamReader& in);
  /// Sets the anchor to the origin of the second body, or of the first when the second is the world.
  void anchor_at_body(const std::vector<BodyConfig>& of_vehicle);
};

}  // namespace sim
