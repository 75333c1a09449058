// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/radar_targets.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "sim/geometry/mesh.hpp"

namespace devices {

namespace {

using Box = Eigen::AlignedBox3d;

using MeshBoxes = std::map<std::pair<std::string, double>, Box>;

/// Returns the box around a mesh, which is read once.
const Box& box_of_mesh(const sim::PartConfig& part, MeshBoxes& known) {
  const std::string path = (std::filesystem::path(part.directory) / part.mesh).string();
  const auto [at, added] = known.try_emplace({path, part.scale});
  if (added)
    for (const sim::Vector3d& p : sim::load_mesh(path, part.scale).vertices_m) at->second.extend(p);
  return at->second;
}

/// Returns the box around a part in the frame of the part; empty for what has no size.
Box box_of(const sim::PartConfig& part, MeshBoxes& meshes) {
  sim::Vector3d half_m(part.radius_m, part.radius_m, part.length_m / 2);
  switch (part.shape) {
    case sim::PartShape::box:
      half_m = part.size_m / 2;
      break;
    case sim::PartShape::sphere:
      half_m.z() = part.radius_m;
      break;
    case sim::PartShape::capsule:
      half_m.z() += part.radius_m;
      break;
    case sim::PartShape::cylinder:
      break;
    case sim::PartShape::mesh:
      return box_of_mesh(part, meshes);
    case sim::PartShape::plane:
    case sim::PartShape::terrain:
      return {};
  }
  return {-half_m, half_m};
}

Box box_of(const sim::BodyConfig& body, MeshBoxes& meshes) {
  Box box_B;
  for (const sim::PartConfig& part : body.parts) {
    const Box box_P = box_of(part, meshes);
    if (!box_P.isEmpty()) box_B.extend(box_P.transformed(sim::make_pose(part.position_m, part.rpy_rad)));
  }
  return box_B;
}

}  // namespace

void RadarCrossSection::read(sim::ParamReader& in) {
  in.require("name");
  in.read_name("name", name, "of a vehicle or an object");
  in.require("rcs_m2");
  in.read("rcs_m2", rcs_m2, sim::between(0, 1e6), "its radar cross section from all sides");
}

bool RadarTarget::may_be_within(const RadarLook& look, double half_width_rad, double distance_m) const {
  const double c = std::cos(half_width_rad), s = std::sin(half_width_rad);
  return std::any_of(boxes_B.begin(), boxes_B.end(), [&](const auto& entry) {
    const auto& [body, box_B] = entry;
    const double radius_m = box_B.sizes().norm() / 2;
    const sim::Vector3d p_W = body->X_WB() * box_B.center() - look.X_WS.translation();
    const double ahead_m = p_W.dot(look.ahead_W()), aside_m = std::abs(p_W.dot(look.left_W()));
    return ahead_m > -radius_m && ahead_m < distance_m + radius_m && aside_m * c - ahead_m * s < radius_m;
  });
}

std::optional<RadarTarget::Outline> RadarTarget::outline(const RadarLook& look) const {
  Outline outline{1e9, -1e9, 1e9, -1e9, 1e9};
  bool above_sea = false;
  for (const auto& [body, box_B] : boxes_B) {
    const sim::Pose X_WB = body->X_WB();
    for (int i = 0; i < 8; ++i) {
      sim::Vector3d p_W = X_WB * box_B.corner(static_cast<Box::CornerType>(i));
      above_sea |= p_W.z() > look.surface_m;
      p_W.z() = std::max(p_W.z(), look.surface_m);
      p_W -= look.X_WS.translation();
      const double azimuth_rad = std::atan2(p_W.dot(look.left_W()), p_W.dot(look.ahead_W()));
      const double elevation_rad = std::atan2(p_W.z(), p_W.head<2>().norm());
      outline.right_rad = std::min(outline.right_rad, azimuth_rad);
      outline.left_rad = std::max(outline.left_rad, azimuth_rad);
      outline.bottom_rad = std::min(outline.bottom_rad, elevation_rad);
      outline.top_rad = std::max(outline.top_rad, elevation_rad);
      outline.near_m = std::min(outline.near_m, p_W.norm());
    }
  }
  return above_sea ? std::optional(outline) : std::nullopt;
}

void RadarTargets::update(const sim::World& world, int own_group, std::span<const RadarCrossSection> rcs) {
  if (generation_ == world.generation()) return;
  generation_ = world.generation();
  targets_.clear();
  for (const auto& vehicle : world.vehicles())
    if (vehicle->group() != own_group) add(*vehicle, vehicle->config(), vehicle->name(), rcs);
  for (const auto& [name, object] : world.objects()) add(object, *object.config, name, rcs);
  indices_.clear();
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const auto group = static_cast<std::size_t>(targets_[i].group);
    if (group >= indices_.size()) indices_.resize(group + 1, -1);
    indices_[group] = static_cast<int>(i);
  }
}

void RadarTargets::add(const sim::Mechanism& mechanism, const sim::MechanismConfig& config, const std::string& name,
                       std::span<const RadarCrossSection> rcs) {
  RadarTarget& target = targets_.emplace_back();
  target.group = mechanism.group();
  target.land = config.any_part([](const sim::PartConfig& part) {
    return part.shape == sim::PartShape::plane || part.shape == sim::PartShape::terrain;
  });
  const auto own = std::find_if(rcs.begin(), rcs.end(), [&](const auto& entry) { return entry.name == name; });
  if (own != rcs.end()) target.rcs_m2 = own->rcs_m2;
  for (std::size_t i = 0; i < config.bodies.size(); ++i) {
    const Box box_B = box_of(config.bodies[i], mesh_boxes_);
    if (!box_B.isEmpty()) target.boxes_B.emplace_back(mechanism.bodies()[i].second, box_B);
  }
}

}  // namespace devices
