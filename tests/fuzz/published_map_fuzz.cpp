// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "experiment/score/map/published_map.hpp"
#include "shoal/message_codec.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// An occupancy grid on the bus, which a metric and `shoal map` read.

SHOAL_FUZZ_TARGET(published_map) {
  fuzz::allow<shoal::MessageError>([&] {
    const experiment::PublishedMap published = experiment::decode_map(input);
    const experiment::MapFrame& frame = published.map.frame;
    fuzz::require(frame.width > 0 && frame.height > 0, "a map has cells");
    fuzz::require(published.map.cells.size() == frame.size(), "as many as its frame");
    fuzz::require(published.map.cells.size() <= input.size(), "not more than bytes arrived");
    fuzz::require(std::isfinite(frame.origin_x_m) && frame.cell_m > 0, "its place is a number");
  });
}
