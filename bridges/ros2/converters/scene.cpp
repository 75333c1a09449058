// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "bridges/ros2/converters/markers.hpp"
#include "bridges/ros2/converters/scene_values.hpp"
#include "bridges/ros2/converters/surfaces.hpp"
#include "shoal/sim_asset_t.hpp"
#include "shoal/sim_scene_t.hpp"

namespace bridges::ros2 {
namespace {

using AssetPart = ConverterContext::AssetPart;
using Color = std::array<float, 4>;

/// Maximum size of all assets that are kept.
constexpr std::size_t max_asset_bytes = 64'000'000;
constexpr double plane_m = 200;  // edge of the square that shows a plane
constexpr double water_m = 400;

std::optional<Color> color_of(const std::string& text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  Color color{0, 0, 0, 1};
  for (std::size_t i = 0; i < 3; ++i) {
    const char* begin = text.data() + 1 + 2 * i;
    int value = 0;
    const auto [end, error] = std::from_chars(begin, begin + 2, value, 16);
    if (error != std::errc{} || end != begin + 2) return std::nullopt;
    color[i] = static_cast<float>(value) / 255;
  }
  return color;
}

/// Color of a part: its own, that of its material, or the usual one.
Color color_of(const Json& scene, const Json& body, const Json& part) {
  if (const auto own = color_of(text_at(part, "color"))) return *own;
  const Json& materials = list_at(scene, "materials");
  const auto material = static_cast<std::size_t>(std::max(0, integer_at(part, "material")));
  if (material < materials.size())
    if (const auto color = color_of(text_at(materials[material], "color"))) return *color;
  const Json* fixed = at(body, "fixed");
  if (fixed == nullptr || !fixed->is_boolean() || fixed->get<bool>()) return {0.70F, 0.67F, 0.61F, 1};
  return {0.27F, 0.47F, 0.75F, 1};
}

// --- Bodies

bool is_fixed(const Json& body) {
  const Json* fixed = at(body, "fixed");
  return fixed != nullptr && fixed->is_boolean() && fixed->get<bool>();
}

std::string frame_of_body(const Json& body) {
  const std::string owner = text_at(body, "owner");
  std::string name = text_at(body, "name");
  if (name.starts_with(owner + "/")) name.erase(0, owner.size() + 1);
  return body_frame(owner, name);
}

/// The marker of a part, without its shape: that of a body that can move is in the frame of the body.
Marker marker_of(const Json& scene, const Json& body, const Json& part, std::size_t number) {
  Marker marker;
  marker.name = frame_of_body(body);
  marker.frame = is_fixed(body) ? world_frame : marker.name;
  marker.pose = pose_at(part, "pose");
  if (is_fixed(body)) marker.pose = pose_at(body, "pose") * marker.pose;
  // A capsule has three markers.
  marker.id = static_cast<std::int32_t>(3 * number);
  marker.rgba = color_of(scene, body, part);
  return marker;
}

void add_capsule(Marker marker, const Json& part, std::vector<Marker>& markers) {
  const double radius_m = number_at(part, "radius_m"), length_m = number_at(part, "length_m");
  // Markers have no capsule: a cylinder and two spheres look like one.
  marker.type = MarkerType::cylinder;
  marker.scale = {2 * radius_m, 2 * radius_m, length_m};
  markers.push_back(marker);
  marker.type = MarkerType::sphere;
  marker.scale = sim::Vector3d::Constant(2 * radius_m);
  const sim::Pose middle = marker.pose;
  for (const int side : {-1, 1}) {
    ++marker.id;
    marker.pose = middle * Eigen::Translation3d(0, 0, side * length_m / 2);
    markers.push_back(marker);
  }
}

/// Appends the markers of a part; not those of assets.
void add_part(Marker marker, const Json& part, std::vector<Marker>& markers) {
  const std::string shape = text_at(part, "shape");
  const double radius_m = number_at(part, "radius_m");
  if (shape == "box") {
    const auto size_m = numbers_at<3>(part, "size_m");
    if (!size_m) return;
    marker.scale = {(*size_m)[0], (*size_m)[1], (*size_m)[2]};
  } else if (shape == "sphere") {
    marker.type = MarkerType::sphere;
    marker.scale = sim::Vector3d::Constant(2 * radius_m);
  } else if (shape == "cylinder") {
    marker.type = MarkerType::cylinder;
    marker.scale = {2 * radius_m, 2 * radius_m, number_at(part, "length_m")};
  } else if (shape == "capsule") {
    return add_capsule(std::move(marker), part, markers);
  } else if (shape == "plane") {
    constexpr double thickness_m = 0.02;
    marker.scale = {plane_m, plane_m, thickness_m};
    marker.pose = marker.pose * Eigen::Translation3d(0, 0, -thickness_m / 2);
  } else {
    return;
  }
  markers.push_back(std::move(marker));
}

Marker marker_of(const AssetPart& part) {
  Marker marker;
  marker.frame = part.frame;
  marker.name = part.name;
  marker.id = part.id;
  marker.type = MarkerType::triangle_list;
  marker.pose = pose_of(part.pose);
  marker.rgba = part.rgba;
  return marker;
}

template <typename Use>
void for_each_part(const Json& scene, const Use& use) {
  for (const Json& body : list_at(scene, "bodies")) {
    const Json& parts = list_at(body, "parts");
    for (std::size_t i = 0; i < parts.size(); ++i) use(body, parts[i], i);
  }
}

std::vector<AssetPart> asset_parts_of(const Json& scene) {
  std::vector<AssetPart> all;
  for_each_part(scene, [&](const Json& body, const Json& part, std::size_t i) {
    const std::string asset = text_at(part, "asset");
    if (asset.empty()) return;
    const Marker marker = marker_of(scene, body, part, i);
    all.push_back({asset, marker.frame, marker.name, marker.id, numbers_of(marker.pose), marker.rgba});
  });
  return all;
}

// --- Water and zones

void add_water(const Json& scene, std::vector<Marker>& markers) {
  const Json* water = at(scene, "water");
  if (water == nullptr || !water->is_object()) return;
  Marker marker;
  marker.frame = world_frame;
  marker.name = "water";
  // A marker must have a thickness, or RViz draws nothing.
  constexpr double thickness_m = 0.02;
  marker.scale = {water_m, water_m, thickness_m};
  marker.pose.translation().z() = number_at(*water, "level_m");
  marker.rgba = {0.15F, 0.45F, 0.65F, 0.35F};
  markers.push_back(std::move(marker));
}

/// Each zone is its outline, at the height of the datum.
void add_zones(const Json& scene, std::vector<Marker>& markers) {
  std::int32_t number = 0;
  for (const Json& zone : list_at(scene, "zones")) {
    Marker marker;
    marker.frame = world_frame;
    marker.name = "zones";
    marker.id = number++;
    marker.type = MarkerType::line_strip;
    marker.scale = {0.1, 0, 0};
    marker.rgba = {0.9F, 0.7F, 0.1F, 1};
    for (const Json& point : list_at(zone, "polygon_m"))
      if (point.is_array() && point.size() >= 2 && point[0].is_number() && point[1].is_number())
        marker.points_m.emplace_back(point[0].get<double>(), point[1].get<double>(), 0);
    if (marker.points_m.empty()) continue;
    marker.points_m.push_back(marker.points_m.front());
    markers.push_back(std::move(marker));
  }
}

// --- Converters

void put_all(CdrWriter& out, std::int64_t utime, const std::vector<Marker>& markers, bool replaces) {
  out.put_count(markers.size() + (replaces ? 1 : 0));
  if (replaces) put_removal_of_all(out, utime);
  for (const Marker& marker : markers) put_marker(out, utime, marker);
}

/// All that can be drawn, in place of what was before; meshes and terrains only if their assets are known.
bool write_scene(const shoal::sim_scene_t& message, ConverterContext& context, CdrWriter& out) {
  const Json scene = Json::parse(message.scene, nullptr, false);
  if (!scene.is_object()) return false;
  std::vector<Marker> markers;
  for_each_part(scene, [&](const Json& body, const Json& part, std::size_t i) {
    add_part(marker_of(scene, body, part, i), part, markers);
  });
  for (const AssetPart& part : asset_parts_of(scene)) {
    const auto asset = context.assets.find(part.asset);
    if (asset == context.assets.end()) continue;
    Marker marker = marker_of(part);
    marker.points_m = triangles_of_asset(asset->second);
    if (!marker.points_m.empty()) markers.push_back(std::move(marker));
  }
  add_water(scene, markers);
  add_zones(scene, markers);
  put_all(out, message.utime, markers, true);
  return true;
}

/// Parts of the last scene that waited for this asset.
bool write_asset(const shoal::sim_asset_t& message, ConverterContext& context, CdrWriter& out) {
  std::vector<Marker> markers;
  if (context.assets.contains(message.hash)) return false;
  for (const AssetPart& part : context.asset_parts) {
    if (part.asset != message.hash) continue;
    Marker marker = marker_of(part);
    marker.points_m = triangles_of_asset(message.data);
    if (marker.points_m.empty()) return false;
    markers.push_back(std::move(marker));
  }
  if (markers.empty()) return false;
  put_all(out, message.utime, markers, false);
  return true;
}

/// Numbers of points of the surfaces: of a body that can move, of all of these, and of all that are fixed.
constexpr std::size_t max_body_points = 150, max_moving_points = 1500, max_fixed_points = 20'000;

/// Spreads points over markers, more on the larger ones.
std::vector<SurfacePoint> points_on(const std::vector<Marker>& markers, std::size_t count) {
  std::vector<double> extents_m;
  for (const Marker& marker : markers) extents_m.push_back(std::sqrt(surface_area_m2(marker)));
  const double sum_m = std::accumulate(extents_m.begin(), extents_m.end(), 0.0);
  std::vector<SurfacePoint> points;
  for (std::size_t i = 0; i < markers.size() && sum_m > 0; ++i) {
    const double share = extents_m[i] / sum_m;
    if (std::isfinite(share))
      add_surface_points(markers[i], static_cast<std::size_t>(std::lround(share * static_cast<double>(count))), points);
  }
  return points;
}

/// Remembers the frames of the bodies of a scene, its parts and its devices; it gives no message itself.
bool read_scene(const shoal::sim_scene_t& message, ConverterContext& context, CdrWriter&) {
  context.body_frames.clear();
  context.asset_parts.clear();
  context.scene_revision = message.revision;
  const Json scene = Json::parse(message.scene, nullptr, false);
  for (const Json& body : list_at(scene, "bodies")) {
    if (!body.is_object() || !body.contains("id") || !body["id"].is_number_integer()) continue;
    context.body_frames.insert_or_assign(body["id"].get<std::int32_t>(), frame_of_body(body));
  }
  context.asset_parts = asset_parts_of(scene);
  context.renew_surfaces(message.scene);
  read_devices(scene, context);
  return false;
}

/// Remembers an asset, for later scenes; it gives no message itself.
bool read_asset(const shoal::sim_asset_t& message, ConverterContext& context, CdrWriter&) {
  std::size_t kept = message.data.size();
  for (const auto& [hash, data] : context.assets) kept += data.size();
  if (kept <= max_asset_bytes && context.assets.emplace(message.hash, message.data).second) context.renew_surfaces();
  return false;
}

SHOAL_ROS2_CONVERTER(write_scene, "visualization_msgs/msg/MarkerArray", "/scene");
SHOAL_ROS2_CONVERTER(write_asset, "visualization_msgs/msg/MarkerArray", "/scene");
// The converters of a type run in the order of their topics: these after those above.
SHOAL_ROS2_CONVERTER(read_scene, "tf2_msgs/msg/TFMessage", "/tf");
SHOAL_ROS2_CONVERTER(read_asset, "tf2_msgs/msg/TFMessage", "/tf");

}  // namespace

void ConverterContext::renew_surfaces(const std::optional<std::string>& scene) {
  if (scene && *scene == std::exchange(scene_, *scene)) return;  // it is repeated for those who come late
  surfaces_.reset();
  fixed_surfaces_are_sent = false;
}

const ConverterContext::Surfaces& ConverterContext::surfaces() {
  if (surfaces_) return *surfaces_;
  surfaces_.emplace();
  const Json scene = Json::parse(scene_, nullptr, false);
  std::map<std::int32_t, std::vector<Marker>> moving;
  std::vector<Marker> fixed;
  for (const Json& body : list_at(scene, "bodies")) {
    std::vector<Marker>& markers = is_fixed(body) ? fixed : moving[integer_at(body, "id")];
    const Json& parts = list_at(body, "parts");
    for (std::size_t i = 0; i < parts.size(); ++i) {
      Marker marker = marker_of(scene, body, parts[i], i);
      const auto asset = assets.find(text_at(parts[i], "asset"));
      if (asset == assets.end()) {
        add_part(std::move(marker), parts[i], markers);
        continue;
      }
      marker.type = MarkerType::triangle_list;
      marker.points_m = triangles_of_asset(asset->second);
      markers.push_back(std::move(marker));
    }
  }
  for (const auto& [body, markers] : moving)
    surfaces_->moving[body] = points_on(markers, std::min(max_body_points, max_moving_points / moving.size()));
  surfaces_->fixed = points_on(fixed, max_fixed_points);
  return *surfaces_;
}

}  // namespace bridges::ros2
