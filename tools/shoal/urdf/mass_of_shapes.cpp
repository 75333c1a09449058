// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/mass_of_shapes.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "sim/base/math.hpp"

namespace tools {
namespace {

using std::numbers::pi;

/// Solid of revolution about z, at the origin.
sim::MeshSolid round_solid(double volume_m3, double across, double along) {
  return {volume_m3, sim::Vector3d::Zero(), sim::Vector3d(across, across, along).asDiagonal()};
}

sim::MeshSolid ball(double radius_m) {
  const double volume = 4.0 / 3 * pi * std::pow(radius_m, 3), moment = 0.4 * volume * radius_m * radius_m;
  return round_solid(volume, moment, moment);
}

sim::MeshSolid cylinder(double r, double length_m) {
  const double volume = pi * r * r * length_m;
  return round_solid(volume, volume * (3 * r * r + length_m * length_m) / 12, volume * r * r / 2);
}

/// A cylinder and two half balls, whose centroids are 3/8 r beyond its ends.
sim::MeshSolid capsule(double r, double length_m) {
  const sim::MeshSolid middle = cylinder(r, length_m), caps = ball(r);
  const double shift = caps.volume_m3 * length_m * (length_m / 4 + 3.0 / 8 * r);
  return round_solid(middle.volume_m3 + caps.volume_m3, middle.inertia(0, 0) + caps.inertia(0, 0) + shift,
                     middle.inertia(2, 2) + caps.inertia(2, 2));
}

sim::MeshSolid box(const sim::Vector3d& size) {
  const sim::Vector3d squares = size.cwiseProduct(size);
  const double volume = size.prod();
  return {volume, sim::Vector3d::Zero(),
          (volume / 12 * (sim::Vector3d::Constant(squares.sum()) - squares)).asDiagonal()};
}

/// Solids of the convex hulls of mesh files, each computed once.
class HullSolids {
 public:
  explicit HullSolids(const std::vector<MeshFile>& meshes) : meshes_(meshes) {}
  const sim::MeshSolid& of(const std::string& file) {
    const auto [known, added] = solids_.try_emplace(file);
    if (added) known->second = computed(file);
    return known->second;
  }

 private:
  sim::MeshSolid computed(const std::string& file) const {
    for (const auto& [path, mesh] : meshes_)
      if (path == file)
        if (const auto solid = convex_hull(outermost_points(mesh.vertices_m))) return sim::solid_of(*solid);
    return {};  // flat
  }

  const std::vector<MeshFile>& meshes_;
  std::map<std::string, sim::MeshSolid> solids_;
};

/// Solid of a part in its own frame.
sim::MeshSolid solid_of_part(const RobotShape& shape, HullSolids& hulls) {
  switch (shape.shape) {
    case sim::PartShape::box:
      return box(shape.size_m);
    case sim::PartShape::sphere:
      return ball(shape.radius_m);
    case sim::PartShape::cylinder:
      return cylinder(shape.radius_m, shape.length_m);
    case sim::PartShape::capsule:
      return capsule(shape.radius_m, shape.length_m);
    case sim::PartShape::mesh:
      return hulls.of(shape.mesh);
    case sim::PartShape::plane:
    case sim::PartShape::terrain:
      break;  // not in a URDF
  }
  return {};
}

/// Inertia of a point of mass 1 at `c` about the origin (parallel axis theorem).
sim::Matrix3d of_point(const sim::Vector3d& c) {
  return c.squaredNorm() * sim::Matrix3d::Identity() - c * c.transpose();
}

/// Solid of all parts of a body that collide, or of those that are only visual, in the body's frame.
sim::MeshSolid solid_of_body(const ImportedBody& body, bool visual, HullSolids& hulls) {
  sim::MeshSolid all;
  sim::Vector3d moment = sim::Vector3d::Zero();
  sim::Matrix3d about_origin = sim::Matrix3d::Zero();
  for (const ImportedPart& part : body.parts) {
    if (part.only_visual != visual) continue;
    const sim::MeshSolid solid = solid_of_part(part.shape, hulls);
    const sim::Matrix3d& R_BP = part.X_BP.linear();
    const sim::Vector3d c = part.X_BP * solid.centroid_m;
    all.volume_m3 += solid.volume_m3;
    moment += solid.volume_m3 * c;
    about_origin += R_BP * solid.inertia * R_BP.transpose() + solid.volume_m3 * of_point(c);
  }
  if (!(all.volume_m3 > 0)) return {};
  all.centroid_m = moment / all.volume_m3;
  all.inertia = about_origin - all.volume_m3 * of_point(all.centroid_m);
  return all;
}

/// Returns whether a solid has moments of inertia that a body can have.
bool is_solid(const sim::MeshSolid& solid, double density_kgpm3) {
  constexpr double least_mass_kg = 1e-9;
  if (!(solid.volume_m3 * density_kgpm3 >= least_mass_kg)) return false;
  const sim::Vector3d moments = sim::symmetric_eigenvalues(solid.inertia);
  return moments[0] > 1e-9 * moments[2];
}

/// Says why an inertia is replaced, one whose smallest moment is zero.
std::string fault_of(const sim::Matrix3d& inertia_kgm2) {
  const sim::Vector3d moments = sim::symmetric_eigenvalues(inertia_kgm2);
  constexpr double no_inertia_kgm2 = 1e-15;
  if (moments[2] <= no_inertia_kgm2) return "its inertia is zero";
  const auto shown = [&](int i) { return std::abs(moments[i]) < 1e-9 * moments[2] ? 0 : moments[i]; };
  return fmt::format("no solid has its inertia, with the moments {:.6g}, {:.6g} and {:.6g} kg m^2", shown(0), shown(1),
                     shown(2));
}

void complete(ImportedBody& body, HullSolids& hulls, double density_kgpm3, std::vector<ImportNote>& notes) {
  // The shapes that collide are kept in the vehicle file; visual ones are the last resort.
  sim::MeshSolid solid = solid_of_body(body, false, hulls);
  if (!is_solid(solid, density_kgpm3)) solid = solid_of_body(body, true, hulls);
  const bool has_shapes = is_solid(solid, density_kgpm3);
  std::string text;
  if (body.lacks_mass) {
    constexpr double radius_m = 0.01;
    // Without any shape a ball of 10 mm radius: small, but not so small that ODE becomes stiff.
    if (!has_shapes) solid = ball(radius_m);
    body.mass_kg = density_kgpm3 * solid.volume_m3;
    body.center_of_mass_m = solid.centroid_m;
    body.inertia_kgm2 = density_kgpm3 * solid.inertia;
    text = fmt::format("its mass is not given: it gets {:.4g} kg, that of {} at {:.6g} kg/m^3", body.mass_kg,
                       has_shapes ? "its shapes" : "a ball of 10 mm radius", density_kgpm3);
  } else {
    if (!has_shapes) solid = ball(std::cbrt(3 * body.mass_kg / (4 * pi * usual_density_kgpm3)));
    text = fmt::format("{}: it gets that of {} with its mass", fault_of(body.inertia_kgm2),
                       has_shapes ? "its shapes" : "a ball of 1000 kg/m^3");
    body.inertia_kgm2 = body.mass_kg / solid.volume_m3 * solid.inertia;
  }
  body.lacks_mass = body.lacks_inertia = false;
  notes.push_back({body.place, "body '" + body.name + "': " + text});
}

}  // namespace

void complete_masses(ImportedVehicle& vehicle, const std::vector<MeshFile>& meshes, double density_kgpm3) {
  HullSolids hulls(meshes);
  for (ImportedBody& body : vehicle.bodies)
    if (body.lacks_mass || body.lacks_inertia) complete(body, hulls, density_kgpm3, vehicle.notes);
}

namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Index of the point with the largest value of a function.
template <typename Function>
std::uint32_t index_of_max(const std::vector<sim::Vector3d>& points, Function&& value_of) {
  std::uint32_t best = 0;
  double max = value_of(points[0]);
  for (std::uint32_t i = 1; i < points.size(); ++i)
    if (const double value = value_of(points[i]); value > max) {
      best = i;
      max = value;
    }
  return best;
}

/// Signed distance of a point from the plane of a triangle, positive on its outer side.
double height_over(const std::vector<sim::Vector3d>& points, const Triangle& t, const sim::Vector3d& p) {
  const sim::Vector3d &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
  return (b - a).cross(c - a).stableNormalized().dot(p - a);
}

/// Tetrahedron of four points that are far apart; std::nullopt if all points lie in one plane.
std::optional<std::vector<Triangle>> first_solid(const std::vector<sim::Vector3d>& points, double tolerance) {
  const std::uint32_t a = index_of_max(points, [](const sim::Vector3d& p) { return -p.x(); });
  const std::uint32_t b = index_of_max(points, [&](const sim::Vector3d& p) { return (p - points[a]).norm(); });
  const sim::Vector3d along = (points[b] - points[a]).stableNormalized();
  const std::uint32_t c =
      index_of_max(points, [&](const sim::Vector3d& p) { return (p - points[a]).cross(along).norm(); });
  if ((points[c] - points[a]).cross(along).norm() <= tolerance) return std::nullopt;
  const std::uint32_t d = index_of_max(points, [&](const sim::Vector3d& p) {
    return std::abs(height_over(points, {a, b, c}, p));
  });
  const double height = height_over(points, {a, b, c}, points[d]);
  if (std::abs(height) <= tolerance) return std::nullopt;
  if (height > 0) return std::vector<Triangle>{{a, c, b}, {a, b, d}, {b, c, d}, {c, a, d}};
  return std::vector<Triangle>{{a, b, c}, {b, a, d}, {c, b, d}, {a, c, d}};
}

/// Replaces the triangles that a point sees from outside by triangles from their outline to the point.
void insert(const std::vector<sim::Vector3d>& points, std::uint32_t point, double tolerance,
            std::vector<Triangle>& hull) {
  const auto is_seen = [&](const Triangle& t) { return height_over(points, t, points[point]) > tolerance; };
  const auto seen = std::partition(hull.begin(), hull.end(), [&](const Triangle& t) { return !is_seen(t); });
  if (seen == hull.end()) return;
  std::set<Edge> edges;
  for (auto t = seen; t != hull.end(); ++t)
    for (std::size_t i = 0; i < 3; ++i) edges.insert({(*t)[i], (*t)[(i + 1) % 3]});
  hull.erase(seen, hull.end());
  for (const auto& [from, to] : edges)
    if (!edges.contains({to, from})) hull.push_back({from, to, point});
}

}  // namespace

sim::MeshSolid collision_solid(const ImportedBody& body, const std::vector<MeshFile>& meshes) {
  HullSolids hulls(meshes);
  return solid_of_body(body, false, hulls);
}

std::optional<sim::MeshSolid> solid_of_shape(const RobotShape& shape) {
  if (shape.shape == sim::PartShape::mesh) return std::nullopt;
  const std::vector<MeshFile> none;
  HullSolids hulls(none);
  return solid_of_part(shape, hulls);
}

std::vector<sim::Vector3d> outermost_points(const std::vector<sim::Vector3d>& points) {
  constexpr int directions = 256;
  std::vector<sim::Vector3d> outwards{sim::Vector3d::UnitX(), sim::Vector3d::UnitY(), sim::Vector3d::UnitZ()};
  for (int i = 0; i < 3; ++i) outwards.push_back(-outwards[static_cast<std::size_t>(i)]);
  for (int i = 0; i < directions; ++i) {
    const double z = 1 - (2 * i + 1.0) / directions, level = std::sqrt(1 - z * z);
    const double turn = 2 * std::numbers::pi * i * (std::numbers::phi - 1);
    outwards.emplace_back(level * std::cos(turn), level * std::sin(turn), z);
  }
  std::set<std::uint32_t> found;
  for (const sim::Vector3d& direction : outwards)
    found.insert(index_of_max(points, [&](const sim::Vector3d& p) { return direction.dot(p); }));
  std::vector<sim::Vector3d> outermost;
  for (const std::uint32_t index : found) outermost.push_back(points[index]);
  return outermost;
}

std::optional<sim::Mesh> convex_hull(const std::vector<sim::Vector3d>& points) {
  if (points.size() < 4) return std::nullopt;
  sim::Vector3d low = points.front(), high = points.front();
  for (const sim::Vector3d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double tolerance = 1e-9 * (high - low).norm();
  std::optional<std::vector<Triangle>> hull = first_solid(points, tolerance);
  if (!hull) return std::nullopt;
  for (std::uint32_t i = 0; i < points.size(); ++i) insert(points, i, tolerance, *hull);
  // Keep only the vertices of the hull, in the order of the points.
  std::map<std::uint32_t, std::uint32_t> numbers;
  for (const Triangle& t : *hull)
    for (const std::uint32_t corner : t) numbers[corner] = 0;
  sim::Mesh mesh;
  for (auto& [point, number] : numbers) {
    number = static_cast<std::uint32_t>(mesh.vertices_m.size());
    mesh.vertices_m.push_back(points[point]);
  }
  for (const Triangle& t : *hull) mesh.triangles.push_back({numbers[t[0]], numbers[t[1]], numbers[t[2]]});
  if (!sim::is_closed(mesh) || !(sim::solid_of(mesh).volume_m3 > 0)) return std::nullopt;  // rounding
  return mesh;
}

}  // namespace tools
