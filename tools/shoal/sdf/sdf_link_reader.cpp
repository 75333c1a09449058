// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <map>

#include "sim/config/message_text.hpp"
#include "tools/shoal/sdf/sdf_reader.hpp"
#include "tools/shoal/urdf/mass_of_shapes.hpp"
#include "tools/shoal/urdf/robot_shapes.hpp"

namespace tools {

namespace {

std::string read_sdf_color(const XmlElement& visual, std::vector<ImportNote>& notes) {
  if (const double hidden = visual.child_number("transparency").value_or(0); hidden != 0)
    notes.push_back({visual.child("transparency")->place(), visual.who() + ": its transparency is not imported"});
  const std::optional<XmlElement> material = visual.child("material");
  if (!material) return "";
  for (const char* kind : {"script", "pbr"})
    if (const auto found = material->child(kind))
      notes.push_back({found->place(), fmt::format("{}: <{}> of its <material> is not imported: textures are not",
                                                   visual.who(), kind)});
  for (const char* kind : {"diffuse", "ambient"})
    if (const auto color = material->child(kind))
      return color_of(*color, fmt::format("<{}>", kind), color->content(), color->any_content_numbers(), notes);
  return "";
}

double read_sdf_length(const XmlElement& shape, const char* name) {
  const double value = shape.required_child(name).content_numbers(1).front();
  check_length(shape, fmt::format("<{}>", name), value);
  return value;
}

void read_sdf_mesh(const XmlElement& mesh, RobotShape& shape) {
  shape.shape = sim::PartShape::mesh;
  shape.mesh = mesh.required_child("uri").content();
  if (shape.mesh.empty()) mesh.refuse("<uri> must not be empty");
  shape.scale = mesh.child_vector("scale", sim::Vector3d::Ones());
}

/// Reads the shape in a `<geometry>`; false: Shoal has none like it, or it is only a part of a mesh.
bool read_sdf_geometry(const XmlElement& geometry, RobotShape& shape, std::vector<ImportNote>& notes) {
  const std::vector<XmlElement> kinds = geometry.children();
  const auto leave_out = [&](const XmlElement& element, const std::string& text) {
    notes.push_back({element.place(), geometry.who() + ": " + text});
    return false;
  };
  if (kinds.empty()) return leave_out(geometry, "a <geometry> without a shape is not imported");
  const XmlElement& kind = kinds.front();
  const std::string name = sim::shortened(sim::printable(kind.name()));
  shape.place = kind.place();
  if (name == "box") {
    shape.shape = sim::PartShape::box;
    shape.size_m = kind.child_vector("size", sim::Vector3d::Ones());
    for (const double length : shape.size_m) check_length(kind, "<size>", length);
  } else if (name == "sphere") {
    shape.shape = sim::PartShape::sphere;
    shape.radius_m = read_sdf_length(kind, "radius");
  } else if (name == "cylinder" || name == "capsule") {
    shape.shape = name == "capsule" ? sim::PartShape::capsule : sim::PartShape::cylinder;
    shape.radius_m = read_sdf_length(kind, "radius");
    shape.length_m = read_sdf_length(kind, "length");
  } else if (name == "mesh") {
    if (const auto part = kind.child("submesh"))
      return leave_out(*part, "a <submesh> is not imported: the file would give the whole mesh");
    read_sdf_mesh(kind, shape);
  } else {
    return leave_out(kind, fmt::format("<{}> is not imported: a part of Shoal is a box, capsule, cylinder, mesh or "
                                       "sphere",
                                       name));
  }
  return true;
}

std::optional<RobotShape> read_sdf_shape(const XmlElement& element, const std::string& link, const SdfScope& scope,
                                         SdfModel& model) {
  std::vector<ImportNote>& notes = model.robot.notes;
  RobotShape shape;
  note_rest(element,
            {"pose", "geometry", "material", "transparency", "laser_retro", "max_contacts", "cast_shadows", "meta",
             "visibility_flags"},
            notes);
  shape.name = element.text("name", "");
  shape.X_LS = pose_in_link(element, link, scope, model);
  if (!read_sdf_geometry(element.required_child("geometry"), shape, notes)) return std::nullopt;
  shape.color = read_sdf_color(element, notes);
  if (has_volume(shape)) return shape;
  note_no_volume(shape, element.who(), notes);
  return std::nullopt;
}

/// Reads a `<fluid_added_mass>`: the upper half of a symmetric matrix, positive as mass.
void read_fluid_added_mass(const XmlElement& element, const std::string& link, SdfModel& model) {
  constexpr std::string_view axes = "xyzpqr";
  SdfAddedMass added{link, Eigen::Matrix<double, 6, 6>::Zero()};
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) {
      const std::string name{axes[static_cast<std::size_t>(i)], axes[static_cast<std::size_t>(j)]};
      added.matrix(i, j) = added.matrix(j, i) = element.child_number(name).value_or(0);
    }
  model.added_masses.push_back(added);
}

sim::Matrix3d read_inertia(const XmlElement& inertial, std::vector<ImportNote>& notes) {
  // The specification's defaults are 1 on the diagonal and 0 elsewhere.
  sim::Matrix3d inertia_kgm2 = sim::Matrix3d::Identity();
  const std::optional<XmlElement> inertia = inertial.child("inertia");
  const char* const names[3][3] = {{"ixx", "ixy", "ixz"}, {"", "iyy", "iyz"}, {"", "", "izz"}};
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) {
      const std::optional<double> value = inertia ? inertia->child_number(names[i][j]) : std::nullopt;
      if (value) inertia_kgm2(i, j) = inertia_kgm2(j, i) = *value;
      if (!value && i == j)
        notes.push_back({inertial.place(), fmt::format("{}: <{}> is missing: it is 1 kg m^2, the default of SDF",
                                                       inertial.who(), names[i][j])});
    }
  for (int i = 0; i < 3; ++i)
    if (inertia_kgm2(i, i) < 0)
      inertia->refuse("the moments of inertia must be >= 0 kg m^2, got " + sim::number_text(inertia_kgm2(i, i)));
  return inertia_kgm2;
}

/// Mass, center and inertia of the collisions, for `<inertial auto="true">`.
RobotInertial inertial_of_shapes(const XmlElement& inertial, const RobotLink& link) {
  const double density = inertial.child_number("density").value_or(usual_density_kgpm3);
  if (!(density > 0)) inertial.refuse("<density> must be > 0, got " + sim::number_text(density));
  RobotInertial read;
  sim::Vector3d moment = sim::Vector3d::Zero();
  sim::Matrix3d about_origin = sim::Matrix3d::Zero();
  const auto of_point = [](const sim::Vector3d& c) -> sim::Matrix3d {
    return c.squaredNorm() * sim::Matrix3d::Identity() - c * c.transpose();
  };
  for (const RobotShape& shape : link.collisions) {
    const std::optional<sim::MeshSolid> solid = solid_of_shape(shape);
    if (!solid) inertial.refuse("an inertia that is computed (auto) must not be that of a mesh: give its numbers");
    const sim::Matrix3d& R = shape.X_LS.linear();
    const sim::Vector3d c = shape.X_LS * solid->centroid_m;
    read.mass_kg += density * solid->volume_m3;
    moment += density * solid->volume_m3 * c;
    about_origin += density * (R * solid->inertia * R.transpose() + solid->volume_m3 * of_point(c));
  }
  if (!(read.mass_kg > 0)) inertial.refuse("an inertia that is computed (auto) needs a <collision> with a volume");
  read.X_LC.translation() = moment / read.mass_kg;
  read.inertia_kgm2 = about_origin - read.mass_kg * of_point(read.X_LC.translation());
  return read;
}

RobotInertial read_sdf_inertial(const XmlElement& inertial, const RobotLink& link, const SdfScope& scope,
                                SdfModel& model) {
  if (const auto added = inertial.child("fluid_added_mass")) read_fluid_added_mass(*added, link.name, model);
  const std::string automatic = inertial.text("auto", "false");
  if (automatic == "true" || automatic == "1") return inertial_of_shapes(inertial, link);
  note_rest(inertial, {"pose", "mass", "inertia", "fluid_added_mass"}, model.robot.notes);
  RobotInertial read;
  read.X_LC = pose_in_link(inertial, link.name, scope, model);
  read.mass_kg = inertial.child_number("mass").value_or(1);
  if (read.mass_kg < 0) inertial.refuse("the mass must be >= 0 kg, got " + sim::number_text(read.mass_kg));
  read.inertia_kgm2 = read_inertia(inertial, model.robot.notes);
  return read;
}

void note_motion(const XmlElement& element, std::vector<ImportNote>& notes) {
  const auto note = [&](const char* name, const std::string& why) {
    notes.push_back(
        {element.child(name)->place(), fmt::format("{}: <{}> is not imported: {}", element.who(), name, why)});
  };
  if (!element.child_flag("gravity", true)) note("gravity", "all bodies have weight");
  if (element.child_flag("kinematic", false)) note("kinematic", "the body moves by the forces on it");
  for (const XmlElement& decay : element.children("velocity_decay"))
    if (decay.child_number("linear").value_or(0) != 0 || decay.child_number("angular").value_or(0) != 0)
      notes.push_back(
          {decay.place(), element.who() + ": <velocity_decay> is not imported: give the body drag in water"});
}

}  // namespace

sim::Pose pose_in_link(const XmlElement& element, const std::string& link, const SdfScope& scope, SdfModel& model) {
  const SdfPose pose = read_sdf_pose(element);
  if (pose.relative_to.empty()) return pose.X;
  return model.frames.X_V(link, element.place()).inverse() *
         model.frames.X_V(scope.full(pose.relative_to), element.place()) * pose.X;
}

RobotLink read_sdf_link(const XmlElement& element, const SdfScope& scope, SdfModel& model) {
  RobotLink link;
  link.name = scope.full(element.text("name"));
  link.place = element.place();
  note_rest(element,
            {"pose", "inertial", "collision", "visual", "sensor", "gravity", "kinematic", "self_collide", "enable_wind",
             "velocity_decay", "must_be_base_link"},
            model.robot.notes);
  note_motion(element, model.robot.notes);
  for (const XmlElement& shape : element.children("collision"))
    if (auto read = read_sdf_shape(shape, link.name, scope, model)) link.collisions.push_back(std::move(*read));
  for (const XmlElement& shape : element.children("visual")) {
    const auto read = [&] { return read_sdf_shape(shape, link.name, scope, model); };
    if (auto visual = read_or_note(shape, read, model.robot.notes)) link.visuals.push_back(std::move(*visual));
  }
  if (const auto inertial = element.child("inertial")) link.inertial = read_sdf_inertial(*inertial, link, scope, model);
  for (const XmlElement& sensor : element.children("sensor"))
    model.sensors.push_back({sensor, link.name, "", pose_in_link(sensor, link.name, scope, model)});
  return link;
}

}  // namespace tools
