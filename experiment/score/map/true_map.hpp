// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "experiment/score/map/grid_map.hpp"
#include "sim/scene/scene.hpp"
#include "sim/world/world.hpp"

namespace experiment {

/// Corners of an area of the map, m.
struct MapArea {
  double x_min_m = 0, y_min_m = 0, x_max_m = 0, y_max_m = 0;
};

/// Returns the frame of a map of an area whose origin is its corner with the smallest coordinates.  Throws
/// std::invalid_argument when the area is empty, or has more than max_map_cells cells.
MapFrame frame_of_area(const MapArea& area, double cell_m);

/// Returns the area of all objects that have a box around them at this height, with a margin of 1 m; planes and
/// vehicles do not count.  None: there is nothing at this height.
std::optional<MapArea> area_of_objects(const sim::World& world, double height_m);

/// Returns the true map of a world at its present time, at a height above zero: horizontal rays along the center lines
/// of all rows and columns.  A cell is occupied when the outline of an object crosses one of its two center lines; on
/// the border of two cells it belongs to the cell inside of the object.  Vehicles are not part of a map, and materials
/// that transmit lasers are not seen.  The cell size should be smaller than what is to be mapped: a thinner post
/// between center lines is missed.
GridMap true_map(const sim::World& world, const MapFrame& frame, double height_m);

}  // namespace experiment
