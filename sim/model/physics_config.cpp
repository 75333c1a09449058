// SPDX-License-Identifier: BSD-3-Clause
#include "sim/model/physics_config.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "sim/config/message_text.hpp"

namespace sim {

void PhysicsConfig::read(ParamReader& in) {
  // Time step and gravity.
  in.read("step_s", step_s, above_to(0, 1), "time of one step; a whole number of microseconds");
  if (std::abs(step_s * 1e6 - std::round(step_s * 1e6)) > 1e-6 || step_s < 1e-6)
    in.error("step_s", "'step_s' must be a whole number of microseconds, got " + number_text(step_s) + " s");
  in.read("gravity_mps2", gravity_mps2, any_number(), "gravity, downwards");
  // Constraint solver.
  in.read_choice("solver", solver, solver_words,
                 "step: exact; quick: iterative; auto: quick for large islands, step for the others");
  in.read("quick_above_rows", quick_above_rows, at_least(0),
          "auto: islands with more constraint rows are stepped as crowds or by quick");
  in.read("quick_iterations", quick_iterations, between(1, 10000), "iterations of the quick solver");
  in.read("erp", erp, between(0, 1),
          "error reduction parameter: fraction of the joint or contact error corrected per step");
  in.read("cfm", cfm, between(0, 1), "softness of joints and contacts, (m/s)/N s");
  // Contacts.
  in.read("contact_max_correcting_velocity_mps", contact_max_correcting_velocity_mps, above(0),
          "maximum speed at which overlapping parts are separated");
  in.read("contact_surface_layer_m", contact_surface_layer_m, between(0, 1),
          "penetration of parts at rest, which keeps contacts from flickering");
  in.read("max_contacts_per_pair", max_contacts_per_pair, between(1, 256), "contact points of two parts");
  // Collision detection and ray casting.
  in.read_choice("space", space, space_words, "broad phase of collision detection");
  in.read_choice("rays", rays, ray_library_words,
                 "library for ray casting: embree is fast; ode casts one ray at a time, for comparison");
  // Limits that detect divergence.
  in.read("max_speed_mps", max_speed_mps, above(0), "a body faster than this stops the run");
  in.read("max_distance_m", max_distance_m, above(0), "a body farther from the origin than this stops the run");
}

void ContactConfig::read(ParamReader& in) {
  in.require("between");
  // Worlds name these two without declaring them.
  in.declare("material", "any");
  in.read_references("between", between, "material", "two materials; any stands for every one");
  if (between.size() != 2) {
    in.error("between", "'between' must name two materials, got " + std::to_string(between.size()));
    between = {"any", "any"};
  }
  in.read("friction", friction, at_least(0), "Coulomb's coefficient of friction");
  in.read("restitution", restitution, sim::between(0, 1), "coefficient of restitution");
  in.read("restitution_velocity_mps", restitution_velocity_mps, at_least(0), "minimum impact speed for a bounce");
  in.read("soft_erp", soft_erp, sim::between(0, 1), "erp of these contacts, instead of the world's");
  in.read("soft_cfm", soft_cfm, sim::between(0, 1), "cfm of these contacts, instead of the world's");
  in.read("rolling_friction_m", rolling_friction_m, at_least(0), "lever of rolling resistance");
  in.read("spinning_friction_m", spinning_friction_m, at_least(0), "lever of resistance to spinning on the spot");
  in.read("slip", slip, at_least(0), "speed of slip by force, (m/s)/N");
}

namespace {

/// Limits of lengths of parts.  Ray casting starts in single precision, where squared lengths must not overflow.
Rule part_length() {
  return between(1e-6, 1e7);
}

/// Reports keys of other shapes, which would have no effect.
void check_keys_of_shape(ParamReader& in, PartShape shape) {
  const std::string word(word_of(part_shape_words, shape));
  for (const char* key : keys_of_some_shapes())
    if (in.has(key) && !has_key(shape, key))
      in.error(key, std::string("'") + key + "' does not apply to shape " + word);
}

}  // namespace

void PartConfig::read(ParamReader& in) {
  if (!in.describing()) {
    place = in.node()->place;
    if (place.file) directory = std::filesystem::path(*place.file).parent_path().string();
  }
  // Shape and dimensions.
  in.read("name", name, "name of the part");
  in.read_choice("shape", shape, part_shape_words, "shape of the part");
  in.read("size_m", size_m, part_length(), "box: lengths along x, y and z");
  in.read("radius_m", radius_m, part_length(), "sphere, capsule, cylinder");
  in.read("length_m", length_m, part_length(), "capsule (without its caps) and cylinder: length along z");
  in.read_path("mesh", mesh, PathUse::read, "mesh: an STL or OBJ file, relative to this file");
  in.read("scale", scale, above(0), "mesh: its numbers times this are meters");
  in.read("terrain", terrain, "terrain: its heights; see docs/models/terrain.md");
  // Pose, mass and material.
  in.read("position_m", position_m, any_place(), "center of the part in the frame of the body");
  in.read_deg("rpy_deg", rpy_rad, "roll, pitch and yaw of the part in the frame of the body");
  in.read("mass_kg", mass_kg, between(1e-9, 1e12), "mass; a part with neither mass nor density weighs nothing");
  in.read("density_kgpm3", density_kgpm3, between(1e-6, 1e9), "density, instead of a mass");
  in.read_reference("material", material, "material",
                    "material, which determines friction and restitution, see contacts of the world");
  in.read_reference("category", category, "category", "categories of the part, for collisions and ray filters");
  in.read_references("collides_with", collides_with, "category",
                     "categories with which it collides, if they also collide with its own; none: all");
  in.read("color", color, "color in images and viewers, #rrggbb; none: the material's");
  read_water_keys(in);
  if (in.describing()) return;
  // Check combinations of keys.
  check_keys_of_shape(in, shape);
  if (mass_kg && density_kgpm3) in.error("density_kgpm3", "give 'mass_kg' or 'density_kgpm3', not both");
  if (shape == PartShape::mesh && mesh.empty()) in.error("a part of shape mesh needs the key 'mesh'");
  if (shape == PartShape::terrain && !terrain) in.error("a part of shape terrain needs the key 'terrain'");
  if (!color.empty() && !parse_color(color)) in.error("color", "'color' must look like #rrggbb, got '" + color + "'");
}

void PartConfig::read_water_keys(ParamReader& in) {
  if (!in.describing()) displaces_was_given = in.has("displaces");
  in.read("displaces", displaces, "buoyancy and drag act on the part; false: hollow, or only visual");
  read_drag_coefficient(in);
  in.read("added_mass_coefficient", added_mass_coefficient, between(0, 100),
          "in water: added mass over the mass of the water displaced; 0.5 is that of a sphere");
}

void PartConfig::read_drag_coefficient(ParamReader& in) {
  const char* key = "drag_coefficient";
  const char* meaning =
      "in water, by projected area: one number, or three along x, y and z of the part; none: that of the shape";
  // Describe the key, which accepts two types.
  if (in.describing()) {
    ParamInfo info;
    info.key = key;
    info.type = "number or " + type_text(ParamKind::numbers);
    info.rule = at_least(0).text();
    info.initial = "[]";
    info.meaning = meaning;
    return in.describe(std::move(info));
  }
  // Accept a single number or a list.
  if (in.has(key) && in.node()->find(key)->kind == ConfigNode::Kind::scalar) {
    drag_coefficient.resize(1);
    in.read(key, drag_coefficient[0], at_least(0), meaning);
  } else {
    in.read(key, drag_coefficient, at_least(0), meaning);
  }
  const std::size_t count = drag_coefficient.size();
  if (count > 3 || count == 2)
    in.error(key, "'drag_coefficient' must be one number or three, got " + std::to_string(count));
}

void BodyConfig::read(ParamReader& in) {
  if (!in.describing()) place = in.node()->place;
  in.require("name");
  in.read_name("name", name, "name of the body");
  in.read("position_m", position_m, any_place(), "origin of the body's frame in the frame of the vehicle or object");
  in.read_deg("rpy_deg", rpy_rad, "roll, pitch and yaw of the body's frame in that frame");
  in.read_list("parts", parts, "part", "shapes of the rigid body");
  in.read("kinematic", kinematic,
          "kinematic: a device such as naive_drive moves it; it pushes others and is not affected by forces");
  in.read("hydrodynamics", hydrodynamics,
          "mass and forces in water by published coefficients, see docs/models/marine.md");
}

std::string error_of_stop(JointType type, double stop) {
  const double max_stop = joint_info(type).max_stop, pi = std::numbers::pi;
  if (std::abs(stop) <= max_stop) return "";
  const std::string bound = max_stop == pi ? "pi" : number_text(max_stop / pi) + " pi";
  return "stops of a rotational axis are in rad and must lie between -" + bound + " and " + bound + ", got " +
         number_text(stop);
}

void JointAxisConfig::read(ParamReader& in) {
  in.read("axis", axis, any_number(), "direction in the frame of the vehicle or object, of any length");
  if (axis.norm() < 1e-9) {
    in.error("axis", "'axis' must not be zero");
    // The axis is normalized later, so after the error any valid direction will do.
    axis = Vector3d::UnitZ();
  }
  in.read("low_stop", low_stop, any_number(), "lowest angle in rad, or position of a slider in m");
  in.read("high_stop", high_stop, any_number(), "highest angle in rad, or position of a slider in m");
  if (low_stop && high_stop && *low_stop > *high_stop)
    in.error("low_stop", "'low_stop' must not be above 'high_stop', got " + number_text(*low_stop) + " and " +
                             number_text(*high_stop));
  in.read("motor_velocity", motor_velocity, any_number(), "speed of the motor at the start, rad/s or m/s");
  in.read("motor_max_force", motor_max_force, at_least(0), "N m, or N of a slider; 0: no motor until a device sets it");
  in.read("damping", damping, at_least(0), "effort against the velocity, N m s/rad, or N s/m for a slider");
  in.read("restitution", restitution, between(0, 1), "restitution at the stops");
  in.read("erp", erp, between(0, 1), "fixed, ball: error reduction of the joint, instead of the world's");
  in.read("cfm", cfm, between(0, 1), "softness of the motor");
  in.read("stop_erp", stop_erp, between(0, 1), "error reduction at the stops");
  in.read("stop_cfm", stop_cfm, between(0, 1), "softness of the stops");
  in.read("fudge_factor", fudge_factor, between(0, 1), "part of the motor's force that may push away from a stop");
  in.read("suspension_erp", suspension_erp, between(0, 1), "hinge2: spring of the suspension");
  in.read("suspension_cfm", suspension_cfm, between(0, 1), "hinge2: damping of the suspension");
}

namespace {

void check_axes(ParamReader& in, const JointConfig& joint) {
  const JointInfo info = joint_info(joint.type);
  const std::string word(word_of(joint_type_words, joint.type));
  if (info.second_axis &&
      joint.axis1.axis.cross(joint.axis2.axis).norm() < 1e-6 * joint.axis1.axis.norm() * joint.axis2.axis.norm())
    in.error("axis2", "the axes of a " + word + " must not be parallel");
  if (!info.second_axis && in.has("axis2")) in.error("axis2", "a " + word + " has no second axis");
  for (const auto& stop : {joint.axis1.low_stop, joint.axis1.high_stop, joint.axis2.low_stop, joint.axis2.high_stop})
    if (const std::string error = error_of_stop(joint.type, stop.value_or(0)); !error.empty()) in.error(error);
}

}  // namespace

void JointConfig::read(ParamReader& in) {
  if (!in.describing()) place = in.node()->place;
  in.require("name");
  in.read_name("name", name, "name of the joint");
  in.read_choice("type", type, joint_type_words, "kind of joint");
  // Bodies.
  in.require("bodies");
  in.read_references("bodies", bodies, "body",
                     "two bodies, or a body and world; the joint counts how the second moves on the first");
  if (!in.describing() && bodies.size() != 2)
    in.error("bodies", "'bodies' must name two bodies, got " + std::to_string(bodies.size()));
  else if (bodies.size() == 2 && bodies[0] == bodies[1])
    in.error("bodies", "a joint needs two different bodies");
  else if (bodies.size() == 2 && (bodies[0] == "world" || (type == JointType::hinge2 && bodies[1] == "world")))
    in.error("bodies", bodies[0] == "world" ? "'world' can only be the second body" : "a hinge2 cannot join the world");
  // Anchor and axes.
  std::optional<Vector3d> anchor;
  in.read("anchor_m", anchor, any_number(),
          "point of the joint in the frame of the vehicle or object; unset: the origin of the second body, or of the "
          "first when "
          "the second is world");
  anchored = anchor.has_value();
  if (anchor) anchor_m = *anchor;
  axis1.read(in);
  in.read("axis2", axis2, "second axis of hinge2 (the wheel's) and universal: the same keys");
  in.read("motor", motor, "ball: it has motor and stops about x, y and z of the vehicle's frame; others have theirs");
  // Check the motor and the axes.
  if (!in.describing() && motor && type != JointType::ball)
    in.error("motor", "'motor' is for a ball; the axes of a " + std::string(word_of(joint_type_words, type)) +
                          " have theirs without it");
  if (!in.describing()) check_axes(in, *this);
}

void JointConfig::anchor_at_body(const std::vector<BodyConfig>& of_vehicle) {
  if (bodies.size() != 2) return;  // already reported
  const std::string& at = bodies[1] == "world" ? bodies[0] : bodies[1];
  for (const BodyConfig& body : of_vehicle)
    if (body.name == at) anchor_m = body.position_m;
}

}  // namespace sim
