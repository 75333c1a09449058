// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rays/ode_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/base/free_numbers.hpp"
#include "sim/ode/find_contacts.hpp"
#include "sim/ode/ode_math.hpp"
#include "sim/ode/part_shape.hpp"

namespace sim {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

AlignedBox box_of(dGeomID geom) {
  dReal b[6];
  dGeomGetAABB(geom, b);
  return {{b[0], b[2], b[4]}, {b[1], b[3], b[5]}};
}

double distance(const AlignedBox& box, const Vector3d& from) {
  return (box.low - from).cwiseMax(from - box.high).cwiseMax(0.0).norm();
}

/// Range at which a ray enters the box; infinity when it misses.
double entry_range(const AlignedBox& box, const Vector3d& origin, const Vector3d& direction) {
  double enter = 0, leave = infinity;
  for (int i = 0; i < 3; ++i) {
    if (direction[i] == 0) {
      if (origin[i] < box.low[i] || origin[i] > box.high[i]) return infinity;
      continue;
    }
    const double a = (box.low[i] - origin[i]) / direction[i], b = (box.high[i] - origin[i]) / direction[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : infinity;
}

}  // namespace

OdeScene::OdeScene(const SceneMoves& moves) : moves_(moves), ray_(dCreateRay(nullptr, 1)) {
  dGeomRaySetClosestHit(ray_.get(), 1);
}

void OdeScene::add_group(int group) {
  slot(open_, group).clear();
}

void OdeScene::add_part(int number, const ScenePart& part) {
  slot(parts_, number) = {part, dGeomGetClass(part.geom), -1, -1, nullptr};
  if (part.moving)
    open_[part.group].push_back(number);
  else
    open_fixed_.push_back(number);
}

void OdeScene::close_group(int group) {
  Cluster cluster{std::move(open_[group]), group, 0};
  open_[group].clear();
  // Moving parts of a group stay close together and share a box; fixed ones may be far apart and get one each.
  for (const int part : cluster.parts) cluster.categories |= parts_[part].category;
  if (!cluster.parts.empty()) add_cluster(0, std::move(cluster));

  std::erase_if(open_fixed_, [&](int part) {
    if (parts_[part].group != group) return false;
    if (parts_[part].kind == dPlaneClass)
      planes_.push_back(part);
    else
      add_cluster(1, {{part}, group, parts_[part].category});
    return true;
  });
}

void OdeScene::add_cluster(int layer, Cluster cluster) {
  std::vector<Cluster>& clusters = layers_[layer].clusters;
  for (const int part : cluster.parts) {
    parts_[part].layer = layer;
    parts_[part].cluster = static_cast<int>(clusters.size());
  }
  clusters.push_back(std::move(cluster));
  layers_[layer].seen = ~std::uint64_t{0};
}

void OdeScene::remove_group(int group, std::span<const int> parts) {
  open_[group].clear();
  std::erase_if(open_fixed_, [&](int part) { return parts_[part].group == group; });
  for (const int part : parts) {
    if (parts_[part].kind == dPlaneClass) std::erase(planes_, part);
    if (parts_[part].cluster >= 0) remove_cluster(parts_[part].layer, parts_[part].cluster);
    parts_[part] = {};
  }
}

/// Removes a cluster; the last cluster replaces it.  Hits do not depend on the order of clusters.
void OdeScene::remove_cluster(int layer, int number) {
  std::vector<Cluster>& clusters = layers_[layer].clusters;
  for (const int part : clusters[number].parts) parts_[part].cluster = -1;
  if (number + 1 != static_cast<int>(clusters.size())) {
    clusters[number] = std::move(clusters.back());
    for (const int part : clusters[number].parts) parts_[part].cluster = number;
  }
  clusters.pop_back();
  layers_[layer].seen = ~std::uint64_t{0};
}

void OdeScene::refresh() const {
  refresh(layers_[0], moves_.moving);
  refresh(layers_[1], moves_.fixed);
}

/// Makes and places the triangles of terrain, whose geom (of the simulator's own class, or ODE's heightfield) rays
/// cannot hit.
void OdeScene::place_triangles(Part& part) {
  if (part.mesh == nullptr || part.kind < dFirstUserClass) return;
  if (!part.triangles) {
    auto made = std::make_shared<TriangleGeom>();
    made->data = make_trimesh_data(*part.mesh);
    made->geom.reset(dCreateTriMesh(nullptr, made->data.get(), nullptr, nullptr, nullptr));
    part.triangles = std::move(made);
  }
  const dReal* p = dGeomGetPosition(part.geom);
  dGeomSetPosition(part.triangles->geom.get(), p[0], p[1], p[2]);
  dGeomSetRotation(part.triangles->geom.get(), dGeomGetRotation(part.geom));
}

void OdeScene::refresh(Layer& layer, std::uint64_t moves) const {
  // The boxes are computed once per change of poses, by the first ray that needs them.
  if (layer.seen == moves) return;
  layer.seen = moves;
  if (&layer == &layers_[0] && moves_.bring_parts) moves_.bring_parts();
  part_boxes_.resize(parts_.size());
  cluster_boxes_.clear();
  for (const Cluster& cluster : layer.clusters) {
    for (const int part : cluster.parts) {
      part_boxes_[part] = box_of(parts_[part].geom);
      place_triangles(parts_[part]);
    }
    AlignedBox box = part_boxes_[cluster.parts.front()];
    for (const int part : cluster.parts) {
      box.low = box.low.cwiseMin(part_boxes_[part].low);
      box.high = box.high.cwiseMax(part_boxes_[part].high);
    }
    cluster_boxes_.push_back(box);
  }
  layer.grid.build(cluster_boxes_);
}

bool OdeScene::hit(int part, const Vector3d& origin_W, const Vector3d& direction_W, RayHit& nearest) const {
  dGeomRaySetLength(ray_.get(), nearest.range_m);
  dGeomRaySet(ray_.get(), origin_W.x(), origin_W.y(), origin_W.z(), direction_W.x(), direction_W.y(), direction_W.z());
  dContactGeom contact;
  const Part& target = parts_[part];
  const dGeomID geom = target.triangles ? target.triangles->geom.get() : target.geom;
  if (find_contacts(ray_.get(), geom, 1, &contact, sizeof contact) == 0) return false;
  // Where two parts share a surface the one with the lower number is hit, whatever the order of tests.
  if (contact.depth > nearest.range_m ||
      (contact.depth == nearest.range_m && part >= nearest.part && nearest.part >= 0))
    return false;
  const Vector3d normal_W = to_eigen(contact.normal);
  const int material = target.triangle_materials.empty() ? target.material : target.triangle_materials[contact.side2];
  nearest = {contact.depth, normal_W.dot(direction_W) > 0 ? Vector3d(-normal_W) : normal_W, part, material};
  return true;
}

void OdeScene::find_candidates(const AlignedBox& around, const RayFilter& filter, const Vector3d& from_W,
                               double range_max_m) const {
  candidates_.clear();
  for (int layer = 0; layer < 2; ++layer)
    layers_[layer].grid.find(around, [&](int index) {
      if (!stops(layers_[layer].clusters[index], filter)) return;
      const double nearest = distance(layers_[layer].grid.box(index), from_W);
      if (nearest <= range_max_m) candidates_.push_back({nearest, layer, index});
    });
  // From near to far, with a tie-break that does not depend on the order in the grid.
  std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
    if (a.nearest_m != b.nearest_m) return a.nearest_m < b.nearest_m;
    return a.layer != b.layer ? a.layer < b.layer : a.cluster < b.cluster;
  });
}

std::optional<RayHit> OdeScene::cast(const Vector3d& origin_W, const Vector3d& direction_W, double range_max_m,
                                     const RayFilter& filter) const {
  if (!(range_max_m > 0)) return std::nullopt;
  refresh();
  RayHit nearest;
  nearest.range_m = range_max_m;
  const Vector3d end_W = origin_W + range_max_m * direction_W;
  find_candidates({origin_W.cwiseMin(end_W), origin_W.cwiseMax(end_W)}, filter, origin_W, range_max_m);
  for (const Candidate& candidate : candidates_) {
    // Skip boxes behind the nearest hit.
    if (candidate.nearest_m > nearest.range_m) break;
    const Layer& layer = layers_[candidate.layer];
    if (entry_range(layer.grid.box(candidate.cluster), origin_W, direction_W) > nearest.range_m) continue;
    for (const int part : layer.clusters[candidate.cluster].parts)
      if (stops(parts_[part], filter)) hit(part, origin_W, direction_W, nearest);
  }
  for (const int plane : planes_)
    if (stops(parts_[plane], filter)) hit(plane, origin_W, direction_W, nearest);
  if (nearest.part < 0) return std::nullopt;
  return nearest;
}

const std::vector<Vector3d>& OdeScene::directions(const Fan& fan) const {
  // Reuse the sines and cosines of the last fan, as a fleet has many equal sensors.
  if (fan.first_angle_rad != directions_of_.first_angle_rad || fan.step_rad != directions_of_.step_rad ||
      fan.count != directions_of_.count) {
    directions_S_.clear();
    for (int i = 0; i < fan.count; ++i) {
      const double angle = fan.first_angle_rad + i * fan.step_rad;
      directions_S_.emplace_back(std::cos(angle), std::sin(angle), 0);
    }
    directions_of_ = fan;
  }
  return directions_S_;
}

struct OdeScene::FanSearch {
  const OdeScene& scene;
  const Fan& fan;
  const RayFilter& filter;
  std::span<RayHit> hits;
  const std::vector<Vector3d>& directions_S;
  Matrix3d R_SW = fan.X_WS.linear().transpose();
  Vector3d p_WS = fan.X_WS.translation();
  double tilt = std::hypot(R_SW(0, 2), R_SW(1, 2));  // projection of the world's z axis on the plane of the fan

  AlignedBox around() const;
  bool crosses(const AlignedBox& box) const;
  template <typename Use>
  void beams_towards(const AlignedBox& box, Use&& use) const;
  bool any_beyond(const AlignedBox& box, double nearest_m) const;
  void try_part(int part);
  void try_plane(int part);
};

/// Bounding box of the disc that the beams can reach.
AlignedBox OdeScene::FanSearch::around() const {
  const Vector3d z_W = R_SW.row(2).transpose();
  const Vector3d half = fan.range_max_m * (1 - z_W.array().square()).max(0).sqrt().matrix();
  return {p_WS - half, p_WS + half};
}

/// Whether the plane of the fan intersects the box, with a margin for rounding.
bool OdeScene::FanSearch::crosses(const AlignedBox& box) const {
  const double height = R_SW.row(2).dot(box.center() - p_WS);
  return std::abs(height) <= R_SW.row(2).cwiseAbs().dot(box.half_extents()) + 1e-9;
}

/// Calls use(first, last) for the beams that point at the circle around the box, projected along z of S.
template <typename Use>
void OdeScene::FanSearch::beams_towards(const AlignedBox& box, Use&& use) const {
  // Circle around the box in the plane of the fan.
  const Vector3d half = box.half_extents();
  const Vector3d to_center = box.center() - p_WS;
  const double x = R_SW.row(0).dot(to_center), y = R_SW.row(1).dot(to_center);
  const double radius = std::sqrt(half.x() * half.x() + half.y() * half.y()) + half.z() * tilt;
  const double away = std::sqrt(x * x + y * y);
  if (away <= radius * (1 + 1e-9) || !(fan.step_rad > 0) || fan.count == 1) return use(0, fan.count - 1);
  // Angular half width, with the bound asin s <= s + 0.5708 s^3 on [0, 1], which is exact at both ends.
  const double s = radius / away;
  const double half_width = s + 0.5708 * s * s * s + 1e-9;
  const double center = std::atan2(y, x) - fan.first_angle_rad;
  const double span = (fan.count - 1) * fan.step_rad;
  // Beam numbers, for each turn of the fan.
  constexpr double turn = 2 * std::numbers::pi;
  for (double at = center + turn * std::ceil((-half_width - center) / turn); at - half_width <= span; at += turn) {
    const int first = static_cast<int>(std::ceil(std::max(0.0, (at - half_width) / fan.step_rad)));
    const int last = static_cast<int>(std::min<double>(fan.count - 1, std::floor((at + half_width) / fan.step_rad)));
    if (first <= last) use(first, last);
  }
}

bool OdeScene::FanSearch::any_beyond(const AlignedBox& box, double nearest_m) const {
  bool any = false;
  beams_towards(box, [&](int first, int last) {
    for (int i = first; i <= last && !any; ++i) any = hits[i].range_m > nearest_m;
  });
  return any;
}

void OdeScene::FanSearch::try_part(int part) {
  const AlignedBox& box = scene.part_boxes_[part];
  if (!crosses(box)) return;
  const double nearest_m = distance(box, p_WS);
  beams_towards(box, [&](int first, int last) {
    for (int i = first; i <= last; ++i) {
      if (hits[i].range_m < nearest_m) continue;
      RayHit hit = hits[i];
      // A miss has an infinite range, which ODE's ray cannot have.
      hit.range_m = std::min(hit.range_m, fan.range_max_m);
      if (scene.hit(part, p_WS, fan.X_WS.linear() * directions_S[i], hit)) hits[i] = hit;
    }
  });
}

void OdeScene::FanSearch::try_plane(int part) {
  dVector4 plane;
  dGeomPlaneGetParams(scene.parts_[part].geom, plane);
  const Vector3d normal_S = R_SW * to_eigen(plane);
  const double height = to_eigen(plane).dot(p_WS) - plane[3];
  // Skip a plane that no beam reaches within range, such as the ground below a horizontal fan.
  if (std::hypot(normal_S.x(), normal_S.y()) * fan.range_max_m < std::abs(height)) return;
  for (int i = 0; i < fan.count; ++i) {
    const double range = -height / normal_S.dot(directions_S[i]);
    if (!(range >= 0 && range <= fan.range_max_m)) continue;
    if (range > hits[i].range_m || (range == hits[i].range_m && part >= hits[i].part && hits[i].hit())) continue;
    const Vector3d normal_W = to_eigen(plane);
    hits[i] = {range, height < 0 ? Vector3d(-normal_W) : normal_W, part, scene.parts_[part].material};
  }
}

void OdeScene::cast_fan(const Fan& fan, const RayFilter& filter, std::span<RayHit> hits) const {
  std::fill(hits.begin(), hits.end(), RayHit{});
  if (fan.count <= 0 || !(fan.range_max_m > 0)) return;
  refresh();
  // Planes first, then candidates by distance.
  FanSearch search{*this, fan, filter, hits, directions(fan)};
  for (const int plane : planes_)
    if (stops(parts_[plane], filter)) search.try_plane(plane);
  find_candidates(search.around(), filter, search.p_WS, fan.range_max_m);
  double farthest_m = infinity;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const Candidate& candidate = candidates_[i];
    // Stop when all beams end before the next candidate, as in a room or a crowd.
    if (i % 16 == 15)
      farthest_m = std::max_element(hits.begin(), hits.end(), [](const RayHit& a, const RayHit& b) {
                     return a.range_m < b.range_m;
                   })->range_m;
    if (candidate.nearest_m > farthest_m) break;
    const Layer& layer = layers_[candidate.layer];
    const Cluster& cluster = layer.clusters[candidate.cluster];
    const AlignedBox& box = layer.grid.box(candidate.cluster);
    if (!search.crosses(box)) continue;
    if (cluster.parts.size() > 1 && !search.any_beyond(box, candidate.nearest_m)) continue;
    for (const int part : cluster.parts)
      if (stops(parts_[part], filter)) search.try_part(part);
  }
}

}  // namespace sim
