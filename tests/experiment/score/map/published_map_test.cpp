// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/map/published_map.hpp"

#include <gmock/gmock.h>

#include "shoal/message_codec.hpp"
#include "shoal/occupancy_grid_t.hpp"
#include "shoal/utime_t.hpp"

namespace {

using experiment::Cell;
using testing::ElementsAre;

shoal::occupancy_grid_t grid() {
  shoal::occupancy_grid_t message{};
  message.utime = 5;
  message.cell_m = 0.1;
  message.origin_m[0] = -1;
  message.width = 3;
  message.height = 2;
  message.cells = {0, 20, 21, 64, 65, -1};
  message.ncells = 6;
  return message;
}

TEST(PublishedMap, HasTheStatesThatMapServerReads) {
  const experiment::PublishedMap published = experiment::decode_map(shoal::encode(grid()));
  EXPECT_EQ(published.utime, 5);
  EXPECT_EQ(published.map.frame.origin_x_m, -1);
  EXPECT_THAT(published.map.cells,
              ElementsAre(Cell::free, Cell::free, Cell::unknown, Cell::unknown, Cell::occupied, Cell::unknown));
}

/// The reason why a map is refused.
std::string reason(const shoal::occupancy_grid_t& message) {
  try {
    experiment::decode_map(shoal::encode(message));
    return {};
  } catch (const shoal::MessageError& error) {
    return error.what();
  }
}

TEST(PublishedMap, RefusesSizesThatDoNotFit) {
  shoal::occupancy_grid_t message = grid();
  message.width = 4;
  EXPECT_THAT(reason(message),
              testing::HasSubstr("'ncells' must be width * height, above 0 and at most 64000000, got 6 of 4 x 2"));
  message = grid();
  message.width = message.height = -1;
  EXPECT_THAT(reason(message), testing::HasSubstr("'ncells'"));
  message = grid();
  message.cell_m = 0;
  EXPECT_THAT(reason(message), testing::HasSubstr("'cell_m' must be from 0.001 to 1000 m, got 0"));
  message = grid();
  message.origin_m[1] = 1e9;
  EXPECT_THAT(reason(message), testing::HasSubstr("'origin_m' must be within 1e7 m"));
  EXPECT_THROW(experiment::decode_map(shoal::encode(shoal::utime_t{})), shoal::MessageError);
}

}  // namespace
