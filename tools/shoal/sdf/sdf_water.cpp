// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "sim/config/message_text.hpp"
#include "sim/model/hydrodynamics_config.hpp"
#include "tools/shoal/sdf/sdf_plugins.hpp"
#include "tools/shoal/sdf/sdf_reader.hpp"
#include "tools/shoal/urdf/mass_of_shapes.hpp"
#include "tools/shoal/urdf/vehicle_text.hpp"

namespace tools {

namespace {

constexpr std::string_view sdf_rows = "xyzkmn", sdf_states = "UVWPQR";

/// Coefficients of a body about the origin of its link in the axes of the link, forward-left-up: positive added mass
/// and damping, derivatives as forces.
struct Water {
  sim::Matrix6d added = sim::Matrix6d::Zero();
  sim::Vector6d linear = sim::Vector6d::Zero(), quadratic = sim::Vector6d::Zero();
  std::map<std::string, double> derivatives;  ///< in the notation of `derivatives`
  bool has_coriolis = true;
  std::optional<double> volume_m3, height_m;
  std::optional<sim::Vector3d> center_of_buoyancy_m;
};

/// Collects the numbers of one plugin.
class WaterReading {
 public:
  WaterReading(const SdfPlugin& plugin, ImportedVehicle& vehicle) : element_(plugin.element), vehicle_(vehicle) {
    const std::string name = element_.text("name", "");
    element_.set_who("plugin '" + sim::shortened(sim::printable(name)) + "'");
  }

  /// gz-sim's Hydrodynamics: forces of derivatives in Fossen's signs, in which damping and added mass are negative.
  Water of_derivatives() {
    read_added_mass();
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        add_linear(i, j);
        for (int k = 0; k < 6; ++k) add_quadratic(i, j, k);
      }
    water_.has_coriolis =
        !element_.child_flag("disable_coriolis", false) && element_.child_flag("enable_coriolis", true);
    if (element_.child_flag("disable_added_mass", false)) water_.added.setZero();
    note_current();
    return water_;
  }
  /// SimpleHydrodynamics of VRX: positive coefficients of the diagonal with defaults, no Coriolis forces.
  Water of_positive_numbers() {
    constexpr std::array<double, 6> added{5, 5, 0.1, 0.1, 0.1, 1};
    constexpr double linear = 20;
    for (int i = 0; i < 6; ++i) {
      water_.added(i, i) = not_negative(name_of(i, "Dot", i), added[static_cast<std::size_t>(i)]);
      water_.linear[i] = not_negative(name_of(i, "", i), linear);
      water_.quadratic[i] = not_negative(name_of(i, "", i) + sdf_states[static_cast<std::size_t>(i)], 0);
    }
    water_.has_coriolis = false;
    return water_;
  }
  /// Fossen's model of uuv_simulator: forward-right-down axes, positive added mass, negative damping.
  Water of_uuv() {
    const std::optional<XmlElement> link = element_.child("link");
    const std::optional<XmlElement> model = link ? link->child("hydrodynamic_model") : std::nullopt;
    if (!model) return water_;
    if (const std::string type = model->child_text("type"); type != "fossen")
      note(*model, "its <hydrodynamic_model> is not imported: that of type 'fossen' is");
    const sim::Matrix6d P = (sim::Vector6d() << 1, -1, -1, 1, -1, -1).finished().asDiagonal();
    water_.added = symmetric(*model, P * matrix_of(*model, "added_mass") * P);
    const sim::Matrix6d linear = P * matrix_of(*model, "linear_damping") * P;
    const sim::Matrix6d quadratic = matrix_of(*model, "quadratic_damping");
    for (int i = 0; i < 6; ++i) {
      set_damping(*model, water_.linear[i], -linear(i, i), "linear_damping");
      set_damping(*model, water_.quadratic[i], -quadratic(i, i), "quadratic_damping");
      for (int j = 0; j < 6; ++j)
        if (i != j && linear(i, j) != 0) water_.derivatives[term_name(i, j)] = linear(i, j);
    }
    if (const auto ahead = model->child("linear_damping_forward_speed");
        ahead && matrix_of(*model, "linear_damping_forward_speed") != sim::Matrix6d::Zero())
      note(*ahead, "<linear_damping_forward_speed> is not imported: add `derivatives` such as Y_uv");
    read_volume(*link);
    return water_;
  }

 private:
  void note(const XmlElement& at, const std::string& text) {
    vehicle_.notes.push_back({at.place(), element_.who() + ": " + text});
  }
  static std::string name_of(int row, const std::string& middle, int state) {
    return sdf_rows[static_cast<std::size_t>(row)] + middle + sdf_states[static_cast<std::size_t>(state)];
  }
  static std::string term_name(int row, int state) {
    return std::string{sim::derivative_rows[static_cast<std::size_t>(row)], '_',
                       sim::derivative_states[static_cast<std::size_t>(state)]};
  }
  double number(const std::string& name) const { return element_.child_number(name).value_or(0); }
  double not_negative(const std::string& name, double initial) {
    const double value = element_.child_number(name).value_or(initial);
    if (value >= 0) return value;
    note(*element_.child(name), fmt::format("<{}> is not imported: this plugin has positive numbers", name));
    return 0;
  }
  void set_damping(const XmlElement& at, double& damping, double value, const std::string& name) {
    if (value >= 0)
      damping = value;
    else
      note(at, fmt::format("<{}> is not imported: with this sign it would push the vehicle on", name));
  }
  /// The symmetric part of a matrix; without what couples motions when it is not positive semi-definite.
  sim::Matrix6d symmetric(const XmlElement& at, const sim::Matrix6d& matrix) {
    sim::Matrix6d mean = (matrix + matrix.transpose()) / 2;
    const double scale = matrix.cwiseAbs().maxCoeff();
    if ((matrix - mean).cwiseAbs().maxCoeff() > 1e-9 * scale)
      note(at, "the added mass is not symmetric: the means of both halves are imported");
    for (int i = 0; i < 6; ++i) {
      if (mean(i, i) >= 0) continue;
      note(at, fmt::format("the added mass of {} is not imported: it has the other sign than the rest",
                           sim::derivative_states[static_cast<std::size_t>(i)]));
      mean.row(i).setZero();
      mean.col(i).setZero();
    }
    if (sim::smallest_eigenvalue(mean) >= -1e-9 * scale) return mean;
    note(at, "the couplings of the added mass are not imported: the matrix is not positive semi-definite");
    return mean.diagonal().asDiagonal();
  }
  void read_added_mass() {
    sim::Matrix6d derivatives = sim::Matrix6d::Zero();
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) derivatives(i, j) = number(name_of(i, "Dot", j));
    // Gazebo before 6.12 took positive numbers as mass.
    const bool is_positive = derivatives.trace() > 0;
    if (is_positive) note(element_, "its positive added mass is taken as mass, as in Gazebo before 6.12");
    water_.added = symmetric(element_, is_positive ? derivatives : sim::Matrix6d(-derivatives));
  }
  void add_linear(int i, int j) {
    const std::string name = name_of(i, "", j);
    const double value = number(name);
    if (value == 0) return;
    if (i == j)
      set_damping(*element_.child(name), water_.linear[i], -value, name);
    else
      water_.derivatives[term_name(i, j)] += value;
  }
  /// `xUabsV` is a force per u |v|, `xUV` one per u v.
  void add_quadratic(int i, int j, int k) {
    const char second = sdf_states[static_cast<std::size_t>(k)];
    const std::string of_abs = name_of(i, "", j) + "abs" + second, plain = name_of(i, "", j) + second;
    const char state = sim::derivative_states[static_cast<std::size_t>(k)];
    if (const double value = number(of_abs); value != 0) {
      if (i == j && j == k)
        set_damping(*element_.child(of_abs), water_.quadratic[i], -value, of_abs);
      else
        water_.derivatives[term_name(i, j) + '|' + state + '|'] += value;
    }
    const double value = number(plain);
    if (value == 0) return;
    if (j != k) {
      water_.derivatives[term_name(i, j) + state] += value;
      return;
    }
    note(*element_.child(plain), fmt::format("<{}> is taken as <{}>", plain, of_abs));
    if (i == j)
      set_damping(*element_.child(plain), water_.quadratic[i], water_.quadratic[i] - value, plain);
    else
      water_.derivatives[term_name(i, j) + '|' + state + '|'] += value;
  }
  void note_current() {
    for (const char* name : {"default_current", "lookup_current_x", "lookup_current_y", "lookup_current_z"})
      if (const auto current = element_.child(name))
        note(*current, fmt::format("<{}> is not imported: `medium: water` has the current of the world", name));
  }
  static sim::Matrix6d matrix_of(const XmlElement& model, const char* name) {
    sim::Matrix6d matrix = sim::Matrix6d::Zero();
    const std::optional<XmlElement> found = model.child(name);
    if (!found) return matrix;
    const std::vector<double> numbers = found->any_content_numbers();
    if (numbers.size() == 6) {
      for (int i = 0; i < 6; ++i) matrix(i, i) = numbers[static_cast<std::size_t>(i)];
      return matrix;
    }
    const std::vector<double> all = found->content_numbers(36);
    for (int i = 0; i < 36; ++i) matrix(i / 6, i % 6) = all[static_cast<std::size_t>(i)];
    return matrix;
  }
  void read_volume(const XmlElement& link) {
    water_.center_of_buoyancy_m = link.child_vector("center_of_buoyancy", sim::Vector3d::Zero());
    if (const auto box = link.child("box")) water_.height_m = box->child_number("height");
    if (!link.child_flag("neutrally_buoyant", false)) water_.volume_m3 = link.child_number("volume");
  }

  XmlElement element_;
  ImportedVehicle& vehicle_;
  Water water_;
};

std::string numbers_text(const sim::Vector6d& v) {
  return short_list({v.data(), v.data() + 6});
}

std::string added_mass_text(const sim::Matrix6d& added) {
  const sim::Matrix6d diagonal = added.diagonal().asDiagonal();
  if (added == diagonal) return numbers_text(added.diagonal());
  std::vector<double> all;
  for (int i = 0; i < 36; ++i) all.push_back(added(i / 6, i % 6));
  return short_list(all);
}

/// Half the height of a shape that is upright in its body.
double half_height(const ImportedPart& part, const std::vector<MeshFile>& meshes) {
  const sim::Vector3d up = part.X_BP.linear().row(2).transpose().cwiseAbs();
  const RobotShape& shape = part.shape;
  const double across = std::sqrt(std::max(0.0, 1 - up.z() * up.z()));
  switch (shape.shape) {
    case sim::PartShape::box:
      return up.dot(shape.size_m) / 2;
    case sim::PartShape::sphere:
      return shape.radius_m;
    case sim::PartShape::cylinder:
      return up.z() * shape.length_m / 2 + across * shape.radius_m;
    case sim::PartShape::capsule:
      return up.z() * shape.length_m / 2 + shape.radius_m;
    case sim::PartShape::mesh:
      for (const auto& [path, mesh] : meshes)
        if (path == shape.mesh) {
          double half = 0;
          for (const sim::Vector3d& p : mesh.vertices_m) half = std::max(half, std::abs((part.X_BP.linear() * p).z()));
          return half;
        }
      return 0;
    case sim::PartShape::plane:
    case sim::PartShape::terrain:
      break;  // not in SDF
  }
  return 0;
}

/// Height of the parts that collide; unset: there are none.
std::optional<double> height_of(const ImportedBody& body, const std::vector<MeshFile>& meshes) {
  constexpr double none = std::numeric_limits<double>::infinity();
  double low = none, high = -none;
  for (const ImportedPart& part : body.parts) {
    if (part.only_visual) continue;
    const double half = half_height(part, meshes), z = part.X_BP.translation().z();
    low = std::min(low, z - half);
    high = std::max(high, z + half);
  }
  return high > low ? std::optional(high - low) : std::nullopt;
}

/// Keys of `hydrodynamics`.  The body displaces what its collisions do, as with the Buoyancy plugin.
YamlEntries keys_of(const Water& water, const ImportedBody& body, const std::vector<MeshFile>& meshes) {
  FlowMap keys;
  const sim::MeshSolid solid = collision_solid(body, meshes);
  const bool given = water.center_of_buoyancy_m.has_value();
  const std::optional<double> volume_m3 = given                 ? water.volume_m3
                                          : solid.volume_m3 > 0 ? std::optional(solid.volume_m3)
                                                                : std::nullopt;
  if (volume_m3 && *volume_m3 > 0) keys.add("volume_m3", *volume_m3);
  keys.add_unless_zero("center_of_buoyancy_m", given ? *water.center_of_buoyancy_m : solid.centroid_m);
  const std::optional<double> height_m = water.height_m ? water.height_m : height_of(body, meshes);
  if (height_m && *height_m > 0) keys.add("hull_height_m", *height_m);
  if (!water.added.isZero(0)) keys.add("added_mass", added_mass_text(water.added));
  if (!water.linear.isZero(0)) keys.add("linear_damping", numbers_text(water.linear));
  if (!water.quadratic.isZero(0)) keys.add("quadratic_damping", numbers_text(water.quadratic));
  FlowMap derivatives;
  for (const auto& [name, value] : water.derivatives)
    if (value != 0) derivatives.add(yaml_scalar(name), value);
  if (!derivatives.empty()) keys.add("derivatives", derivatives.text());
  if (!water.has_coriolis && !water.added.isZero(0)) keys.add("quirks", "{added_mass_coriolis: none}");
  if (keys.empty()) keys.add("model", "coefficients");
  return keys.entries();
}

Water water_of(const SdfPlugin& plugin, ImportedVehicle& vehicle) {
  WaterReading reading(plugin, vehicle);
  const std::optional<SdfPluginKind> kind = kind_of_plugin(plugin.element);
  if (kind == SdfPluginKind::simple_hydrodynamics) return reading.of_positive_numbers();
  return kind == SdfPluginKind::uuv_hydrodynamics ? reading.of_uuv() : reading.of_derivatives();
}

}  // namespace

void add_water(const SdfModel& model, const std::vector<MeshFile>& meshes, ImportedVehicle& vehicle) {
  std::map<std::string, Water> waters;  // by link
  std::map<std::string, sim::SourcePlace> places;
  for (const SdfPlugin& plugin : model.plugins) {
    const std::string link = link_of_water(plugin);
    if (link.empty()) continue;
    const sim::SourcePlace place = plugin.element.place();
    if (!waters.try_emplace(link, water_of(plugin, vehicle)).second)
      vehicle.notes.push_back({place, "link '" + sim::shortened(sim::printable(link)) +
                                          "': a second plugin with its coefficients is not imported"});
    places.try_emplace(link, place);
  }
  for (const SdfAddedMass& added : model.added_masses) {
    waters[added.link].added += added.matrix;
    for (const RobotLink& link : model.robot.links)
      if (link.name == added.link) places.try_emplace(link.name, link.place);
  }
  for (const auto& [link, water] : waters) {
    const auto place = vehicle.links.find(link);
    const auto body = place == vehicle.links.end()
                          ? vehicle.bodies.end()
                          : std::find_if(vehicle.bodies.begin(), vehicle.bodies.end(),
                                         [&](const ImportedBody& each) { return each.name == place->second.body; });
    const auto leave_out = [&](const std::string& why) {
      vehicle.notes.push_back({places[link], "the coefficients of link '" + sim::shortened(sim::printable(link)) +
                                                 "' are not imported: " + why});
    };
    if (body == vehicle.bodies.end())
      leave_out("there is no such link");
    else if (!place->second.X_BL.isApprox(sim::Pose::Identity(), 1e-9))
      leave_out("it is fixed to a link with another frame, to which coefficients refer");
    else if (!body->water.empty())
      leave_out("a link that is fixed to it has some");
    else
      body->water = keys_of(water, *body, meshes);
  }
}

}  // namespace tools
