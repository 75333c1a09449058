// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <stdexcept>

#include "autonomy/known_map/localizer.hpp"
#include "autonomy/known_map/map_file.hpp"
#include "shoal/message_codec.hpp"
#include "tests/fuzz/scratch_file.hpp"

// A map in a file: its YAML, and after the first byte of 0 the image `map.png` that it may name.

SHOAL_FUZZ_TARGET(map_file) {
  const auto end = std::find(input.begin(), input.end(), std::byte{0});
  const auto length = static_cast<std::size_t>(end - input.begin());
  const std::string path = fuzz::write_scratch("map.yaml", input.first(length));
  fuzz::write_scratch("map.png", input.subspan(std::min(length + 1, input.size())));
  fuzz::allow<std::invalid_argument, shoal::MessageError>([&] {
    const shoal::occupancy_grid_t map = autonomy::read_map_file(path);
    fuzz::require(map.ncells == map.width * map.height, "a map has all its cells");
    constexpr int small = 10'000;
    if (map.ncells < small) autonomy::LikelihoodField field(map);
  });
}
