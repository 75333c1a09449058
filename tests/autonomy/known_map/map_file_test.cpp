// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/known_map/map_file.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "experiment/score/map/grid_map.hpp"

namespace {

using experiment::Cell;
using testing::ElementsAre;
using testing::HasSubstr;

/// Its own folder with a map of 3 x 2 cells.
struct MapFolder {
  MapFolder() {
    std::filesystem::create_directories(path);
    experiment::write_map(
        path + "/a.png",
        {{-1.5, 2, 0.05, 3, 2}, {Cell::free, Cell::occupied, Cell::unknown, Cell::solid, Cell::free, Cell::free}});
  }
  ~MapFolder() { std::filesystem::remove_all(path); }
  std::string with(const std::string& text) const {
    std::ofstream(path + "/b.yaml") << text;
    return path + "/b.yaml";
  }
  std::string path = testing::TempDir() + "/map_file_test";
};

std::string reason(const std::string& path) {
  try {
    autonomy::read_map_file(path);
    return {};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(MapFile, ReadsWhatShoalMapWrites) {
  const MapFolder folder;
  const shoal::occupancy_grid_t map = autonomy::read_map_file(folder.path + "/a.yaml");
  EXPECT_EQ(map.cell_m, 0.05);
  EXPECT_EQ(map.origin_m[0], -1.5);
  EXPECT_EQ(map.origin_m[1], 2);
  EXPECT_EQ(map.width, 3);
  EXPECT_EQ(map.height, 2);
  EXPECT_EQ(map.ncells, 6);
  EXPECT_THAT(map.cells, ElementsAre(0, 100, -1, -1, 0, 0));
  // The other way round: white is occupied.
  EXPECT_THAT(
      autonomy::read_map_file(folder.with("image: a.png\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 1\n")).cells,
      ElementsAre(100, 0, 100, 100, 100, 100));
}

TEST(MapFile, ReportsWhatIsWrongWithItsPlace) {
  const MapFolder folder;
  EXPECT_THAT(reason(folder.path + "/c.yaml"), HasSubstr("c.yaml"));
  EXPECT_THAT(reason(folder.with("image: a.png\nresolution: 0\norigin: [0, 0, 0]\n")),
              HasSubstr("b.yaml:2:13: map: 'resolution' must be >= 0.001 and <= 1, got 0"));
  EXPECT_THAT(reason(folder.with("image: a.png\norigin: [0, 0, 0]\n")), HasSubstr("map: missing key 'resolution'"));
  EXPECT_THAT(reason(folder.with("image: a.png\nresolution: 0.1\norigin: [0, 0, 0.5]\n")),
              HasSubstr("'origin' must have yaw 0"));
  EXPECT_THAT(reason(folder.with("image: a.png\nresolution: 0.1\norigin: [0, 0, 0]\nocupied_thresh: 0.6\n")),
              HasSubstr("did you mean 'occupied_thresh'?"));
  EXPECT_THAT(reason(folder.with("image: d.png\nresolution: 0.1\norigin: [0, 0, 0]\n")),
              HasSubstr("/d.png: cannot be read"));
  EXPECT_THAT(reason(folder.with("image: /dev/zero\nresolution: 0.1\norigin: [0, 0, 0]\n")),
              HasSubstr("/dev/zero: cannot be read, it is not a file"));
  EXPECT_THAT(reason(folder.with("image: .\nresolution: 0.1\norigin: [0, 0, 0]\n")), HasSubstr("it is not a file"));
  EXPECT_THAT(reason(folder.with("image: a.png\nresolution: 0.1\norigin: [0, 0, 0]\nfree_thresh: 0.7\n")),
              HasSubstr("'free_thresh' must be at most 'occupied_thresh', 0.65, got 0.7"));
  EXPECT_THAT(reason(folder.with("image: b.yaml\nresolution: 0.1\norigin: [0, 0, 0]\n")), HasSubstr("/b.yaml: "));
}

}  // namespace
