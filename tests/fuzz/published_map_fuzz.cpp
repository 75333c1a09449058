// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "experiment/score/map/published_map.hpp"
#include "shoal/message_codec.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "viewer/estimates/vehicle_path.hpp"

// An occupancy grid on the bus, which a metric and `shoal map` read, and a path, which page and film draw.

SHOAL_FUZZ_TARGET(published_map) {
  fuzz::allow<shoal::MessageError>([&] {
    const auto path = viewer::read_path(input);
    if (!path) return;
    fuzz::require(path->points.size() <= viewer::VehiclePath::max_points, "a path has a limit");
    for (const auto& point : path->points)
      fuzz::require(std::isfinite(point.x_m) && std::isfinite(point.y_m), "its points are somewhere");
  });
  fuzz::allow<shoal::MessageError>([&] {
    const experiment::PublishedMap published = experiment::decode_map(input);
    const experiment::MapFrame& frame = published.map.frame;
    fuzz::require(frame.width > 0 && frame.height > 0, "a map has cells");
    fuzz::require(published.map.cells.size() == frame.size(), "as many as its frame");
    fuzz::require(published.map.cells.size() <= input.size(), "not more than bytes arrived");
    fuzz::require(std::isfinite(frame.origin_x_m) && frame.cell_m > 0, "its place is a number");
  });
}
