// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/view/scene_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "bridges/base/json_text.hpp"
#include "bridges/view/scene_assets.hpp"
#include "sim/base/vehicle_colors.hpp"
#include "sim/device/device.hpp"
#include "sim/world/part_collisions.hpp"
#include "sim/world/world.hpp"

namespace bridges {
namespace {

using Json = nlohmann::ordered_json;

Json numbers(const sim::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Json pose_json(const sim::Pose& X) {
  const sim::Quaterniond q(X.linear());
  const sim::Vector3d& p = X.translation();
  return {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
}

/// Returns a limit; null when it is as good as infinite.
Json limit_json(double limit_m) {
  return std::abs(limit_m) < 1e8 ? Json(limit_m) : Json(nullptr);
}

/// Writer of one scene.
class SceneWriter {
 public:
  SceneWriter(const sim::World& world, SceneAssets& assets) : world_(world), assets_(assets), collisions_(world) {
    for (int i = 0; i < world.physics().materials(); ++i) material_numbers_[world.physics().material(i).name] = i;
  }

  Json materials();
  Json bodies();
  Json vehicles() const;
  Json water() const;
  Json zones() const;

 private:
  Json part(const sim::PartConfig& part, const std::string& owner);
  Json body(const sim::Body& body, const std::string& owner, const char* kind,
            const std::vector<sim::PartConfig>& parts);

  const sim::World& world_;
  SceneAssets& assets_;
  const sim::PartCollisions collisions_;
  std::map<std::string, int, std::less<>> material_numbers_;
};

Json SceneWriter::materials() {
  Json all = Json::array();
  for (int i = 0; i < world_.physics().materials(); ++i) {
    const sim::MaterialConfig& material = world_.physics().material(i);
    Json json{{"name", material.name}, {"gloss", material.gloss}};
    if (!material.color.empty()) json["color"] = material.color;
    const sim::TextureConfig& texture = material.texture;
    switch (texture.pattern) {
      case sim::TextureConfig::Pattern::none:
        break;
      case sim::TextureConfig::Pattern::checker:
        json["texture"] = {{"pattern", "checker"}, {"colors", texture.colors}, {"size_m", texture.size_m}};
        break;
      case sim::TextureConfig::Pattern::stripes:
        json["texture"] = {{"pattern", "stripes"}, {"colors", texture.colors}, {"size_m", texture.size_m}};
        break;
      case sim::TextureConfig::Pattern::image:
        json["texture"] = {{"pattern", "image"}, {"size_m", texture.size_m}, {"asset", assets_.add_image(texture)}};
    }
    all.push_back(std::move(json));
  }
  return all;
}

Json SceneWriter::part(const sim::PartConfig& part, const std::string& owner) {
  Json json;
  if (!part.name.empty()) json["name"] = part.name;
  json["shape"] = std::string(sim::word_of(sim::part_shape_words, part.shape));
  switch (part.shape) {
    case sim::PartShape::box:
      json["size_m"] = numbers(part.size_m);
      break;
    case sim::PartShape::sphere:
      json["radius_m"] = part.radius_m;
      break;
    case sim::PartShape::capsule:
    case sim::PartShape::cylinder:
      json["radius_m"] = part.radius_m;
      json["length_m"] = part.length_m;
      break;
    case sim::PartShape::plane:
      break;
    case sim::PartShape::mesh:
      json["asset"] = assets_.add_mesh(part);
      break;
    case sim::PartShape::terrain:
      json["asset"] = assets_.add_terrain(part);
  }
  json["pose"] = pose_json(sim::make_pose(part.position_m, part.rpy_rad));
  if (!part.color.empty()) json["color"] = part.color;
  // The view of collision shapes leaves out parts that can touch nothing.
  if (!collisions_.has(part, owner)) json["collides"] = false;
  const auto material = material_numbers_.find(part.material);
  json["material"] = material == material_numbers_.end() ? 0 : material->second;
  return json;
}

Json SceneWriter::body(const sim::Body& body, const std::string& owner, const char* kind,
                       const std::vector<sim::PartConfig>& parts) {
  Json json{{"id", body.number()}, {"name", body.name()},   {"owner", owner},
            {"kind", kind},        {"fixed", body.fixed()}, {"pose", pose_json(body.X_WB())}};
  json["parts"] = Json::array();
  for (const sim::PartConfig& each : parts) json["parts"].push_back(part(each, owner));
  return json;
}

Json SceneWriter::bodies() {
  std::vector<Json> all;
  const auto add = [&](const sim::Mechanism& owner, const sim::MechanismConfig& config, const std::string& name,
                       const char* kind) {
    for (std::size_t i = 0; i < std::min(config.bodies.size(), owner.bodies().size()); ++i)
      all.push_back(body(*owner.bodies()[i].second, name, kind, config.bodies[i].parts));
  };
  for (const auto& vehicle : world_.vehicles()) add(*vehicle, vehicle->config(), vehicle->name(), "vehicle");
  for (const auto& [name, object] : world_.objects()) add(object, *object.config, name, "object");
  // By number, as in sim.bodies, so that pages can merge both lists.
  std::sort(all.begin(), all.end(), [](const Json& a, const Json& b) { return a["id"] < b["id"]; });
  return all;
}

Json field_of_view_json(const sim::FieldOfView& view) {
  Json json;
  switch (view.kind) {
    case sim::FieldOfView::Kind::fan:
      json = {{"kind", "fan"}, {"from_rad", view.from_rad}, {"to_rad", view.to_rad}};
      break;
    case sim::FieldOfView::Kind::cone:
      json = {{"kind", "cone"}, {"axis", numbers(view.axis_S)}, {"half_angle_rad", view.half_angle_rad}};
      break;
    case sim::FieldOfView::Kind::frustum:
      json = {{"kind", "frustum"}, {"horizontal_rad", view.horizontal_rad}, {"vertical_rad", view.vertical_rad}};
      break;
    case sim::FieldOfView::Kind::beams:
      json = {{"kind", "beams"}, {"directions", Json::array()}};
      for (const sim::Vector3d& direction : view.directions_S) json["directions"].push_back(numbers(direction));
  }
  json["range_m"] = view.range_m;
  json["range_min_m"] = view.range_min_m;
  return json;
}

Json SceneWriter::vehicles() const {
  Json all = Json::array();
  for (const auto& vehicle : world_.vehicles()) {
    Json devices = Json::array();
    for (const sim::MountedDevice* device : vehicle->devices()) {
      const sim::DeviceConfig& config = device->config();
      const sim::Body& body = config.body.empty() ? vehicle->base() : vehicle->body(config.body);
      Json json{{"name", config.name},
                {"type", config.type},
                {"body", body.number()},
                {"pose", pose_json(config.X_BS())},
                {"channels", Json::array()}};
      if (!device->report_channel().empty()) json["channels"].push_back(device->report_channel());
      if (device->sensor() != nullptr && device->sensor()->data_rate_bps())
        json["data_rate_bps"] = *device->sensor()->data_rate_bps();
      if (device->sensor() != nullptr)
        if (const auto origin = device->sensor()->origin()) json["origin"] = pose_json(*origin);
      if (device->sensor() != nullptr)
        if (const auto view = device->sensor()->field_of_view()) json["field_of_view"] = field_of_view_json(*view);
      devices.push_back(std::move(json));
    }
    all.push_back({{"name", vehicle->name()},
                   {"color", fmt::format("#{:06x}", sim::vehicle_color(vehicle->number()))},
                   {"body", vehicle->base().number()},
                   // The page places the name and the track of a vehicle at its frame V, but only poses of bodies are
                   // published.
                   {"pose", pose_json(vehicle->base().X_WB().inverse() * vehicle->X_WV())},
                   {"own_clock", !vehicle->clock().perfect()},
                   {"devices", std::move(devices)}});
  }
  return all;
}

Json SceneWriter::water() const {
  const sim::Medium& medium = world_.medium();
  if (!medium.has_water()) return nullptr;
  Json waves = Json::array();
  for (const sim::WaveComponent& wave : medium.wave_components())
    waves.push_back({{"amplitude_m", wave.amplitude_m},
                     {"k_radpm", wave.k_radpm},
                     {"omega_radps", wave.omega_radps},
                     {"phase_rad", wave.phase_rad},
                     {"direction_rad", wave.direction_rad}});
  // The profile of the sound speed, at depths that grow like its changes do: densest near the surface.
  const double level_m = medium.still_surface_m();
  Json profile = Json::array();
  for (const double depth_m : {0., 1., 2., 5., 10., 20., 30., 50., 75., 100., 150., 200., 300., 500., 1000.}) {
    // Velocity of the water, even where it is below a trough of the waves.
    const double c = 1 / medium.mean_slowness_spm(level_m - depth_m, level_m - depth_m);
    if (std::isfinite(c)) profile.push_back({level_m - depth_m, c});
  }
  const sim::MediumConfig& config = world_.config().medium;
  return {{"level_m", level_m},
          {"waves", std::move(waves)},
          {"sound_speed", std::move(profile)},
          {"mean_level_m", config.water->surface_m},
          {"tides", tides_json(config.tides)},
          {"currents", currents_json(config.current, *medium.current())}};
}

/// Writes each zone as a polygon in the world: zones that are tilted are drawn by their outline in the xy-plane.
Json SceneWriter::zones() const {
  constexpr int circle_points = 32;
  Json all = Json::array();
  for (const sim::Zone& zone : world_.zones().all()) {
    const sim::ZoneConfig& config = zone.config();
    const sim::Pose X_WZ = sim::make_pose(config.position_m, config.rpy_rad);
    std::vector<sim::Vector3d> outline;
    double low_m = -config.height_m / 2, high_m = config.height_m / 2;
    // Outline and limits in the frame of the zone.
    switch (config.shape) {
      case sim::ZoneShape::box:
        for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
          outline.push_back({x * config.size_m.x() / 2, y * config.size_m.y() / 2, 0});
        high_m = config.size_m.z() / 2;
        low_m = -high_m;
        break;
      case sim::ZoneShape::sphere:
        high_m = config.radius_m;
        low_m = -high_m;
        [[fallthrough]];
      case sim::ZoneShape::cylinder:
        for (int i = 0; i < circle_points; ++i) {
          const double angle = 2 * std::numbers::pi * i / circle_points;
          outline.push_back({config.radius_m * std::cos(angle), config.radius_m * std::sin(angle), 0});
        }
        break;
      case sim::ZoneShape::polygon:
        outline = config.points_m;
        low_m = config.low_m;
        high_m = config.high_m;
    }
    Json polygon = Json::array();
    for (const sim::Vector3d& point : outline) {
      const sim::Vector3d p_W = X_WZ * point;
      polygon.push_back({p_W.x(), p_W.y()});
    }
    const double z_m = config.position_m.z();
    Json flags = Json::array();
    if (config.gps_denied) flags.push_back("gps_denied");
    if (config.radio_denied) flags.push_back("radio_denied");
    if (config.speed_limit_mps) flags.push_back("speed_limit");
    if (config.finish) flags.push_back("finish");
    all.push_back({{"name", config.name},
                   {"polygon_m", std::move(polygon)},
                   {"z_m", {limit_json(z_m + low_m), limit_json(z_m + high_m)}},
                   {"flags", std::move(flags)}});
  }
  return all;
}

Json light_json(const sim::LightConfig& light) {
  return {{"to_sun", numbers(light.to_sun_W())},
          {"sun", light.sun},
          {"sky", light.sky},
          {"zenith", light.zenith_color},
          {"horizon", light.horizon_color},
          {"shadows", light.shadows}};
}

}  // namespace

std::string scene_text(const sim::World& world, int revision, SceneAssets& assets) {
  SceneWriter writer(world, assets);
  Json scene{{"op", "scene"}, {"revision", revision}, {"world", world.config().name}};
  // Positions of bodies are sent as 32-bit numbers relative to this point, which resolve 1 mm up to 16 km from it.
  scene["origin_m"] = {0, 0, 0};
  scene["light"] = light_json(world.config().light);
  scene["materials"] = writer.materials();
  scene["bodies"] = writer.bodies();
  scene["vehicles"] = writer.vehicles();
  scene["water"] = writer.water();
  scene["zones"] = writer.zones();
  // A name that is not UTF-8 must not prevent the scene.
  return json_text(scene);
}

namespace {

using Json = nlohmann::ordered_json;

/// Writes a grid; one with more points is sampled at fewer places.
Json grid_json(const sim::CurrentGrid& grid) {
  constexpr int max_points = 64;
  const int columns = std::min(grid.columns(), max_points), rows = std::min(grid.rows(), max_points);
  const Eigen::Vector2d low_m = grid.low_m(), high_m = grid.high_m();
  Json velocities = Json::array();
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      // Rounding must not exceed the ends: there may be no current outside of the grid.
      const double x_m = std::min(high_m.x(), low_m.x() + i * (high_m.x() - low_m.x()) / (columns - 1));
      const double y_m = std::min(high_m.y(), low_m.y() + j * (high_m.y() - low_m.y()) / (rows - 1));
      const sim::Vector3d v_W = grid.velocity_W(x_m, y_m);
      velocities.push_back({v_W.x(), v_W.y()});
    }
  return {{"type", "grid"},
          {"low_m", {low_m.x(), low_m.y()}},
          {"high_m", {high_m.x(), high_m.y()}},
          {"columns", columns},
          {"rows", rows},
          {"outside", grid.keeps_edge() ? "edge" : "zero"},
          {"velocities_mps", std::move(velocities)}};
}

Json current_json(const sim::CurrentConfig& entry) {
  using Type = sim::CurrentConfig::Type;
  switch (entry.type) {
    case Type::constant: {
      const sim::Vector3d& v = entry.velocity_mps;
      return {{"type", "constant"}, {"velocity_mps", {v.x(), v.y(), v.z()}}};
    }
    case Type::profile: {
      Json rows = Json::array();
      for (const sim::CurrentLayerConfig& row : entry.profile) {
        const sim::Vector3d& v = row.velocity_mps;
        rows.push_back({row.depth_m, v.x(), v.y(), v.z()});
      }
      return {{"type", "profile"}, {"rows", std::move(rows)}};
    }
    case Type::power_law:
      return {{"type", "power_law"},
              {"speed_mps", entry.speed_mps},
              {"direction_rad", entry.direction_rad},
              {"water_depth_m", entry.water_depth_m},
              {"exponent", entry.exponent}};
    case Type::wind_driven:
      return {{"type", "wind_driven"},
              {"speed_mps", entry.speed_mps},
              {"direction_rad", entry.direction_rad},
              {"reference_depth_m", entry.reference_depth_m}};
    case Type::gauss_markov:
      return {{"type", "gauss_markov"}, {"speed_mps", entry.speed_mps}, {"direction_rad", entry.direction_rad}};
    case Type::vortex:
      return {{"type", "vortex"},
              {"center_m", {entry.center_m[0], entry.center_m[1]}},
              {"peak_speed_mps", entry.peak_speed_mps},
              {"core_radius_m", entry.core_radius_m},
              {"core", entry.core == sim::CurrentConfig::Core::rankine ? "rankine" : "lamb_oseen"}};
    case Type::grid:
      break;  // grid_json()
  }
  return {};
}

}  // namespace

Json tides_json(const std::vector<sim::TideConfig>& tides) {
  Json all = Json::array();
  for (const sim::TideConfig& tide : tides)
    all.push_back({{"amplitude_m", tide.amplitude_m},
                   {"period_s", tide.period_s},
                   {"phase_rad", tide.phase_rad},
                   {"current_mps", tide.current_mps},
                   {"current_direction_rad", tide.current_direction_rad},
                   {"current_lead_rad", tide.current_lead_rad}});
  return all;
}

Json currents_json(const std::vector<sim::CurrentConfig>& entries, const sim::Current& current) {
  Json all = Json::array();
  auto grid = current.grids().begin();
  for (const sim::CurrentConfig& entry : entries)
    all.push_back(entry.type == sim::CurrentConfig::Type::grid ? grid_json(*grid++) : current_json(entry));
  return all;
}

}  // namespace bridges
