// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/world_checks.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "sim/config/message_text.hpp"
#include "sim/config/warnings.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/vehicle_config.hpp"

namespace sim {
namespace {

constexpr double any_height_m = 12000;  // more than any ocean has
/// Step behind a surface that a ray has met.
constexpr double beyond_m = 1e-4;
/// Surfaces of a solid above a place; where there are more, none is taken for the bottom.
constexpr int max_crossings = 64;

/// Returns the fixed object to which a part belongs; null: it belongs to something that can move.
const ObjectConfig* fixed_object_of(const World& world, int part) {
  const int group = world.physics().parts()[static_cast<std::size_t>(part)].group;
  for (const auto& [name, object] : world.objects())
    if (object.group() == group) return object.config->fixed ? object.config.get() : nullptr;
  return nullptr;
}

/// Returns the depth of the bottom above a point; none when the point is in the open.
std::optional<double> bottom_above(const World& world, const Vector3d& p_W, double depth_m) {
  const auto above = world.scene().cast(p_W, Vector3d::UnitZ(), any_height_m, {});
  const ObjectConfig* object = above ? fixed_object_of(world, above->part) : nullptr;
  if (object == nullptr) return std::nullopt;
  const bool is_ground = !object->any_part([](const PartConfig& part) { return shape_info(part.shape).solid; });
  // A solid is left through its surface an odd number of times from within, and from its tunnels, or below it, an even.
  int crossings = 0;
  Vector3d from_W = p_W;
  for (auto hit = above; !is_ground && hit && crossings < max_crossings;
       hit = world.scene().cast(from_W, Vector3d::UnitZ(), any_height_m, {})) {
    if (hit->part == above->part) ++crossings;
    from_W.z() += hit->range_m + beyond_m;
  }
  if (!is_ground && crossings % 2 == 0) return std::nullopt;
  return depth_m - above->range_m;
}

std::string meters(double value) {
  return number_text(std::round(value * 100) / 100) + " m";
}

}  // namespace

std::string depth_fault(const World& world, const Eigen::Vector2d& p_W, double depth_m) {
  if (!world.config().medium.water) return "";
  const std::string depth = "depth " + meters(depth_m) + " is ";
  if (depth_m < 0) return depth + "in the air: depths are positive downwards";
  const double surface_m = world.config().medium.water->surface_m;
  const auto bottom_m = bottom_above(world, {p_W.x(), p_W.y(), surface_m - depth_m}, depth_m);
  return bottom_m ? depth + "below the bottom, which is at " + meters(*bottom_m) + " there" : "";
}

void warn_of_plans(const World& world, const Vehicle& vehicle, Warnings& warnings) {
  for (const MountedDevice* device : vehicle.devices()) {
    if (!device->senses()) continue;
    for (const PlannedPlace& place : device->sensor()->planned_places()) {
      const std::string fault = depth_fault(world, place.p_W, place.depth_m);
      if (fault.empty()) continue;
      const DeviceConfig& config = device->config();
      warnings.warn(config.source ? place_of(*config.source, place.key) : config.place,
                    "vehicle '" + vehicle.name() + "': device '" + config.name + "'",
                    "'" + std::string(place.key) + "': " + fault);
      // One wrong place in a plan is enough; the others are likely wrong in the same way.
      break;
    }
  }
}

namespace {

constexpr double deepest_m = 12000;  // deeper than any ocean

bool in_water(const World& world, const Vehicle& vehicle, const VehicleConfig& config) {
  return std::any_of(config.bodies.begin(), config.bodies.end(), [&](const BodyConfig& body) {
    return body.has_coefficients() || world.medium().in_water(vehicle.body(body.name).X_WB().translation());
  });
}

bool looks_for_bottom(const World& world, const Vehicle& vehicle) {
  return std::any_of(vehicle.devices().begin(), vehicle.devices().end(), [&](const MountedDevice* device) {
    if (device->senses() && device->sensor()->needs_bottom()) return true;
    if (!device->casts_rays()) return false;
    // What casts rays in the air above the water, such as a radar or a lidar on a mast, looks around.
    const DeviceConfig& config = device->config();
    const Body& carrier = config.body.empty() ? vehicle.base() : vehicle.body(config.body);
    return world.medium().in_water(carrier.X_WB() * config.position_m);
  });
}

bool over_nothing(const World& world, const Vehicle& vehicle) {
  if (!looks_for_bottom(world, vehicle) || !in_water(world, vehicle, vehicle.config())) return false;
  RayFilter others;
  others.exclude_group = vehicle.group();
  return !world.scene().cast(vehicle.X_WV().translation(), -Vector3d::UnitZ(), deepest_m, others);
}

std::vector<std::string> lines_about(const std::vector<const Vehicle*>& over_nothing) {
  if (over_nothing.empty()) return {};
  const std::size_t more = over_nothing.size() - 1;
  const std::string others = more == 0 ? "" : " (nor below " + std::to_string(more) + " more)";
  return {"there is no bottom below vehicle '" + over_nothing[0]->name() + "'" + others +
          ": downward-looking sensors there detect nothing"};
}

}  // namespace

std::vector<std::string> bottom_warnings(const World& world) {
  std::vector<const Vehicle*> found;
  if (world.medium().has_water())
    for (const auto& vehicle : world.vehicles())
      if (over_nothing(world, *vehicle)) found.push_back(vehicle.get());
  return lines_about(found);
}

std::vector<std::string> bottom_warnings(const World& world, const Vehicle& vehicle) {
  if (!world.medium().has_water() || !over_nothing(world, vehicle)) return {};
  return lines_about({&vehicle});
}

std::vector<std::string> end_warnings(const World& world, const std::function<bool(const std::string&)>& is_awaited) {
  constexpr Time max_search = std::chrono::minutes(1);  // a first fix or answer may take some time
  std::vector<std::string> lines = world.warnings().kept();
  for (const auto& vehicle : world.vehicles())
    for (const MountedDevice* device : vehicle->devices()) {
      const auto lack = device->senses() ? device->lack() : std::nullopt;
      if (!lack || lack->span < max_search) continue;
      if (lack->what.ends_with(" under water") && !is_awaited(device->report_channel())) continue;
      lines.push_back(
          fmt::format("device '{}': no {} in {:.6g} s", device->full_name(), lack->what, to_seconds(lack->span)));
    }
  return lines;
}

}  // namespace sim
