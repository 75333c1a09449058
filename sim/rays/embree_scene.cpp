// SPDX-License-Identifier: BSD-3-Clause
// Addition, removal and motion of parts of EmbreeScene.
#include "sim/rays/embree_scene.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/free_numbers.hpp"
#include "sim/rays/float_rays.hpp"

namespace sim {

void EmbreeScene::add_group(int group) {
  slot(open_, group).clear();
}

void EmbreeScene::add_part(int number, const ScenePart& part) {
  slot(parts_, number) = {part};
  open_[part.group].push_back(number);
}

void EmbreeScene::close_group(int group) {
  for (const int number : open_[group]) add_shape(number);
  open_[group].clear();
}

void EmbreeScene::remove_group(int group, std::span<const int> parts) {
  open_[group].clear();
  for (const int number : parts) {
    if (parts_[number].layer != nullptr) remove_shape(parts_[number]);
    parts_[number] = {};
  }
}

void EmbreeScene::add_shape(int number) {
  Part& added = parts_[number];
  const TriangleScene* triangles = nullptr;
  if (added.part.mesh != nullptr) {
    SharedMesh& shared = meshes_[added.part.mesh];
    if (!shared.triangles) shared.triangles = std::make_unique<TriangleScene>(*added.part.mesh);
    ++shared.users;
    triangles = shared.triangles.get();
  }
  const RayShape shape = make_ray_shape(number, added.part, triangles);
  added.layer = &layer_of(shape, added.part);
  added.at = added.layer->shapes.size();
  added.layer->shapes.push_back(shape);
  added.layer->geoms.push_back(added.part.geom);
  added.layer->changed = true;
}

EmbreeScene::Layer& EmbreeScene::layer_of(const RayShape& shape, const ScenePart& part) {
  if (shape.kind == RayShape::Kind::plane) return planes_;
  if (part.moving) return moving_;
  constexpr std::size_t many = 10'000;
  return part.mesh != nullptr && part.mesh->triangles.size() >= many ? terrain_ : fixed_;
}

/// Removes a shape; the last shape replaces it.
void EmbreeScene::remove_shape(Part& part) {
  Layer& layer = *part.layer;
  parts_[layer.shapes.back().part].at = part.at;
  layer.shapes[part.at] = layer.shapes.back();
  layer.geoms[part.at] = layer.geoms.back();
  layer.shapes.pop_back();
  layer.geoms.pop_back();
  layer.changed = true;
  if (part.part.mesh == nullptr) return;
  const auto shared = meshes_.find(part.part.mesh);
  if (--shared->second.users == 0) meshes_.erase(shared);
}

void EmbreeScene::prepare() const {
  refresh(planes_, moves_.fixed);
  refresh(fixed_, moves_.fixed);
  refresh(terrain_, moves_.fixed);
  refresh(moving_, moves_.moving);
}

void EmbreeScene::refresh(Layer& layer, std::uint64_t moves) const {
  if (layer.seen == moves && !layer.changed) return;
  if (layer.moves && moves_.bring_parts) moves_.bring_parts();
  follow_geoms(layer);
  if (!layer.few()) {
    choose_origin(layer);
    build(layer);
  }
  layer.seen = moves;
  layer.changed = false;
}

void EmbreeScene::follow_geoms(Layer& layer) {
  for (std::size_t i = 0; i < layer.shapes.size(); ++i) {
    RayShape& shape = layer.shapes[i];
    const std::array<double, 3> before = shape.center;
    follow(shape, layer.geoms[i]);
    layer.travelled_m += std::abs(shape.center[0] - before[0]) + std::abs(shape.center[1] - before[1]) +
                         std::abs(shape.center[2] - before[2]);
  }
}

void EmbreeScene::choose_origin(Layer& layer) {
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::max()), high = -low;
  layer.half_width_m = 0;
  double widest_m = 0;
  for (const RayShape& shape : layer.shapes) {
    low = low.cwiseMin(shape.center_W());
    high = high.cwiseMax(shape.center_W());
    const double reach_m = shape.reach_m();
    layer.half_width_m += reach_m;
    widest_m = std::max(widest_m, reach_m);
  }
  // Embree computes in single precision, so a layer has its origin among its shapes.
  layer.origin_W = (low + high) / 2;
  layer.radius_m = (high - low).norm() / 2 + widest_m;
}

/// Builds or refits the tree.  A refit is some ten times faster than a build; but after motions of about the width of
/// the shapes, rays would test too many of them.
void EmbreeScene::build(Layer& layer) {
  // Create the scene.
  if (!layer.scene) {
    layer.scene.reset(rtcNewScene(embree_device()));
    check_embree();
    if (layer.moves) {
      // Embree refits a tree only with both of these settings.
      rtcSetSceneFlags(layer.scene.get(), RTC_SCENE_FLAG_DYNAMIC);
      rtcSetSceneBuildQuality(layer.scene.get(), RTC_BUILD_QUALITY_LOW);
    }
  }
  // Build a new tree after changes or large motions.
  if (!layer.geometry || layer.changed || layer.travelled_m > layer.half_width_m) {
    if (layer.geometry) rtcDetachGeometry(layer.scene.get(), 0);
    layer.geometry.reset(rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_USER));
    check_embree();
    rtcSetGeometryBuildQuality(layer.geometry.get(), RTC_BUILD_QUALITY_REFIT);
    rtcSetGeometryUserPrimitiveCount(layer.geometry.get(), static_cast<unsigned>(layer.shapes.size()));
    rtcSetGeometryUserData(layer.geometry.get(), &layer);
    rtcSetGeometryBoundsFunction(layer.geometry.get(), bounds_of, nullptr);
    rtcSetGeometryIntersectFunction(layer.geometry.get(), intersect);
    rtcSetGeometryOccludedFunction(layer.geometry.get(), find_occluded);
    rtcAttachGeometryByID(layer.scene.get(), layer.geometry.get(), 0);
    layer.travelled_m = 0;
  }
  // Build or refit.
  rtcCommitGeometry(layer.geometry.get());
  commit_alone(layer.scene.get());
}

void EmbreeScene::bounds_of(const RTCBoundsFunctionArguments* arguments) {
  const Layer& layer = *static_cast<const Layer*>(arguments->geometryUserPtr);
  const RayShape& shape = layer.shapes[arguments->primID];
  const double margin_m = FloatRays::rounding * layer.radius_m;
  const Vector3d center = shape.center_W() - layer.origin_W;
  const Vector3d half = shape.half_extents_W() + Vector3d::Constant(margin_m);
  const Eigen::Vector3f low = (center - half).cast<float>(), high = (center + half).cast<float>();
  RTCBounds& out = *arguments->bounds_o;
  out.lower_x = low.x(), out.lower_y = low.y(), out.lower_z = low.z();
  out.upper_x = high.x(), out.upper_y = high.y(), out.upper_z = high.z();
}

}  // namespace sim
