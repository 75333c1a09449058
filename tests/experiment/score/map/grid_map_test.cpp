// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/map/grid_map.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "sim/image/image_file.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using experiment::Cell;
using experiment::GridMap;

// Two columns, three rows from the south: free occupied, solid unknown, occupied free.
const GridMap map{{-1.5, 2, 0.05, 2, 3},
                  {Cell::free, Cell::occupied, Cell::solid, Cell::unknown, Cell::occupied, Cell::free}};

TEST(MapFiles, ImageHasTheNorthUpAndTheLevelsOfMapServer) {
  const sim::Image8 image = experiment::map_image(map);
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.height, 3);
  EXPECT_THAT(image.data, testing::ElementsAre(0, 254, 205, 205, 254, 0));
}

TEST(MapFiles, LevelsAreWhatTheThresholdsOfTheYamlSay) {
  // p = (255 - level) / 255: occupied above 0.65, free below 0.196.
  const auto p = [](double level) { return (255 - level) / 255; };
  EXPECT_GT(p(0), 0.65);
  EXPECT_LT(p(254), 0.196);
  EXPECT_GE(p(205), 0.196);
  EXPECT_LE(p(205), 0.65);
}

TEST(MapFiles, YamlHasTheCornerAndTheQuotedImage) {
  EXPECT_EQ(experiment::map_yaml(map, "it's.png"),
            "image: 'it''s.png'\nmode: trinary\nresolution: 0.05\norigin: [-1.5, 2, 0.0]\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

TEST(MapFiles, AreWrittenBesideEachOther) {
  const test_support::ScratchFolder folder;
  const std::string yaml = experiment::write_map(folder.file("map.png"), map);
  EXPECT_EQ(yaml, folder.file("map.yaml"));
  std::ifstream file(yaml);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_THAT(text, testing::StartsWith("image: 'map.png'\n"));
  const sim::Image8 read = sim::read_image(folder.file("map.png"));
  EXPECT_EQ(read.width, 2);
  EXPECT_EQ(*read.at(1, 0), 254);
  EXPECT_THROW(experiment::write_map(folder.file("none/map.png"), map), std::runtime_error);
}

}  // namespace
