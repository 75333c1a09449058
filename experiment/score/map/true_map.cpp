// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/map/true_map.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace experiment {

namespace {

/// A ray continues this far behind a hit.
constexpr double behind_m = 1e-6;
/// A ray starts this far outside of the map, so that it starts outside of what crosses the border.
constexpr double margin_m = 100;

/// Groups of vehicles, which rays pass.
std::set<int> groups_of_vehicles(const sim::World& world) {
  std::set<int> groups;
  for (const auto& vehicle : world.vehicles()) groups.insert(vehicle->group());
  return groups;
}

/// Casts the rays of the rows and columns of a map.
class LineCaster {
 public:
  LineCaster(const sim::World& world, const MapFrame& frame, double height_m, GridMap& map)
      : scene_(world.scene()),
        parts_(world.physics().parts()),
        vehicles_(groups_of_vehicles(world)),
        frame_(frame),
        height_m_(height_m),
        map_(map),
        inside_(frame.size()) {
    filter_.kind = sim::RayKind::laser;
  }

  void cast() {
    for (int row = 0; row < frame_.height; ++row)
      for (const int sense : {1, -1}) cast_line(row, true, sense);
    for (int column = 0; column < frame_.width; ++column)
      for (const int sense : {1, -1}) cast_line(column, false, sense);
    // Where the outlines of two objects coincide, a ray misses one of them: a cell is inside when all four rays say so.
    for (std::size_t i = 0; i < inside_.size(); ++i)
      if (map_.cells[i] == Cell::free && inside_[i] == 4) map_.cells[i] = Cell::solid;
  }

 private:
  /// Follows the center line of a row (along x) or a column (along y), in or against the direction of its axis.
  void cast_line(int line, bool along_x, int sense) {
    // Coordinates along and across the line, from the origin of the map.
    const int cells = along_x ? frame_.width : frame_.height;
    const double length_m = cells * frame_.cell_m;
    const double start_m = sense > 0 ? -margin_m : length_m + margin_m;
    const double across_m = (line + 0.5) * frame_.cell_m;
    sim::Vector3d origin_W(frame_.origin_x_m, frame_.origin_y_m, height_m_);
    origin_W += along_x ? sim::Vector3d(start_m, across_m, 0) : sim::Vector3d(across_m, start_m, 0);
    const sim::Vector3d direction_W = (along_x ? sim::Vector3d::UnitX() : sim::Vector3d::UnitY()) * sense;
    const double total_m = length_m + 2 * margin_m;
    // Hits in their order; a part is entered and left in turn.
    entered_.clear();
    double travelled_m = 0;
    int next = 0;  // first cell, in the direction of the ray, that has not been looked at
    while (const auto hit =
               scene_.cast(origin_W + travelled_m * direction_W, direction_W, total_m - travelled_m, filter_)) {
      const double at_m = travelled_m + hit->range_m;
      travelled_m = at_m + behind_m;
      if (vehicles_.contains(parts_[static_cast<std::size_t>(hit->part)].group)) continue;
      const bool enters = !entered_.contains(hit->part);
      const double within_m = at_m - margin_m + (enters ? behind_m : -behind_m);
      const int cell = static_cast<int>(std::floor(std::clamp(within_m / frame_.cell_m, -1.0, cells + 1.0)));
      fill(line, along_x, sense, next, cell);
      next = std::max(next, cell);
      if (enters)
        entered_.insert(hit->part);
      else
        entered_.erase(hit->part);
      if (cell >= 0 && cell < cells)
        map_.cells[at(line, along_x, sense > 0 ? cell : cells - 1 - cell)] = Cell::occupied;
    }
    fill(line, along_x, sense, next, cells);
  }

  /// Counts the cells from `first` to before `end`, in the direction of the ray, when they are inside of something.
  void fill(int line, bool along_x, int sense, int first, int end) {
    if (entered_.empty()) return;
    const int cells = along_x ? frame_.width : frame_.height;
    for (int cell = std::max(first, 0); cell < std::min(end, cells); ++cell)
      ++inside_[at(line, along_x, sense > 0 ? cell : cells - 1 - cell)];
  }
  std::size_t at(int line, bool along_x, int cell) const {
    return along_x ? frame_.index(cell, line) : frame_.index(line, cell);
  }

  const sim::Scene& scene_;
  std::span<const sim::PartInfo> parts_;
  std::set<int> vehicles_;
  const MapFrame& frame_;
  double height_m_;
  sim::RayFilter filter_;
  GridMap& map_;
  std::vector<std::uint8_t> inside_;  ///< number of rays, of four, in which a cell is inside of something
  std::set<int> entered_;             ///< parts in which the ray is
};

}  // namespace

MapFrame frame_of_area(const MapArea& area, double cell_m) {
  const double width_m = area.x_max_m - area.x_min_m, height_m = area.y_max_m - area.y_min_m;
  if (!(width_m > 0 && height_m > 0))
    throw std::invalid_argument(
        fmt::format("the area must go from a smaller to a larger x and y, got {:.6g},{:.6g} to "
                    "{:.6g},{:.6g}",
                    area.x_min_m, area.y_min_m, area.x_max_m, area.y_max_m));
  // Rounding must not add a cell.
  const double columns = std::ceil(width_m / cell_m - 1e-6), rows = std::ceil(height_m / cell_m - 1e-6);
  if (columns * rows > static_cast<double>(max_map_cells))
    throw std::invalid_argument(
        fmt::format("a map must have at most {} cells, got {:.0f} x {:.0f}: give a smaller area "
                    "or larger cells",
                    max_map_cells, columns, rows));
  return {area.x_min_m, area.y_min_m, cell_m, std::max(1, static_cast<int>(columns)),
          std::max(1, static_cast<int>(rows))};
}

std::optional<MapArea> area_of_objects(const sim::World& world, double height_m) {
  const std::set<int> vehicles = groups_of_vehicles(world);
  Eigen::AlignedBox3d all;
  const auto parts = world.physics().parts();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].group < 0 || vehicles.contains(parts[i].group)) continue;
    const auto box = world.physics().bounds_W(static_cast<int>(i));
    if (box && box->min().z() <= height_m && box->max().z() >= height_m) all.extend(*box);
  }
  if (all.isEmpty()) return std::nullopt;
  // A margin of a meter, and whole meters, so that maps of one world agree.
  return MapArea{std::floor(all.min().x() - 1), std::floor(all.min().y() - 1), std::ceil(all.max().x() + 1),
                 std::ceil(all.max().y() + 1)};
}

GridMap true_map(const sim::World& world, const MapFrame& frame, double height_m) {
  GridMap map{frame, std::vector<Cell>(frame.size(), Cell::free)};
  world.scene().prepare();
  LineCaster(world, frame, height_m, map).cast();
  return map;
}

}  // namespace experiment
