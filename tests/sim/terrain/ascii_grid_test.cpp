// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <sys/stat.h>

#include "sim/base/crc32.hpp"
#include "sim/terrain/terrain.hpp"
#include "tests/sim/terrain/terrain_error.hpp"

namespace {

using sim::HeightGrid;
using sim::Holes;
using test::error_of;

const std::string header = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\n";

std::string error_of_ascii(const std::string& text) {
  return error_of([&] { sim::parse_ascii_grid(text, 1, Holes::error); });
}

TEST(AsciiGrid, RowsRunFromNorthToSouthAndTheCornerIsHalfACellOut) {
  const HeightGrid grid = sim::parse_ascii_grid(header + "1 2 3\n4 5 6\n", 0.5, Holes::error);
  EXPECT_EQ(grid.columns, 3);
  EXPECT_EQ(grid.rows, 2);
  EXPECT_EQ(grid.cell_m, 10);
  EXPECT_EQ(grid.west_m, 105);
  EXPECT_EQ(grid.south_m, 205);
  EXPECT_EQ(grid.at(0, 1), 0.5);
  EXPECT_EQ(grid.at(2, 0), 3);
}

TEST(AsciiGrid, KeywordsMayComeInAnyCaseAndOrderAndTheCenterIsThePoint) {
  const HeightGrid grid = sim::parse_ascii_grid(
      "NROWS 2\r\nNCols 2\r\nCELLSIZE 2.5\r\nYLLCENTER 7\r\nXLLCENTER -1e1\r\nNODATA_value -1\r\n+1 2 3e0\r\n4", 1,
      Holes::error);
  EXPECT_EQ(grid.west_m, -10);
  EXPECT_EQ(grid.south_m, 7);
  EXPECT_EQ(grid.at(1, 0), 4);
}

TEST(AsciiGrid, HolesAreAnErrorOrFilled) {
  const std::string text =
      "ncols 4\nnrows 3\nxllcenter 0\nyllcenter 0\ncellsize 1\nNODATA_value -9999\n"
      "0 3 6 9\n0 -9999 -9999 9\n0 3 6 -9999\n";
  EXPECT_EQ(error_of_ascii(text),
            "line 8: a hole (NODATA) at column 2 of row 2: fill holes with 'holes: nearest' or 'holes: linear'");
  const HeightGrid linear = sim::parse_ascii_grid(text, 1, Holes::linear);
  EXPECT_NEAR(linear.at(1, 1), 3, 1e-12);  // both of the row, 0 3 6 9, and of the column, 3 3
  EXPECT_NEAR(linear.at(2, 1), 6, 1e-12);
  EXPECT_EQ(linear.at(3, 0), 6);  // in a corner: the nearest, which was filled itself or not
  const HeightGrid nearest = sim::parse_ascii_grid(
      "ncols 4\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1\n1 2 -9999 -9999\n3 4 -9999 -9999\n", 1, Holes::nearest);
  EXPECT_EQ(nearest.at(3, 1), 2);
  EXPECT_EQ(nearest.at(2, 0), 4);
  EXPECT_EQ(error_of([] {
              sim::parse_ascii_grid("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n-9999 -9999 -9999 -9999",
                                    1, Holes::nearest);
            }),
            "has no heights, only NODATA");
}

TEST(AsciiGrid, ErrorsSayTheLineAndWhatIsWrong) {
  EXPECT_EQ(error_of_ascii(""), "line 1: is not an ESRI ASCII grid: 'ncols' is missing before the heights");
  EXPECT_EQ(error_of_ascii("solid hill\n"), "line 1: unknown key of an ESRI ASCII grid");
  EXPECT_EQ(error_of_ascii("ncols 3\nncols 3\n"), "line 2: 'ncols' comes twice");
  EXPECT_EQ(error_of_ascii("ncols three\n"), "line 1: ncols is not a number, got 'three'");
  EXPECT_EQ(error_of_ascii("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize -10\n1 2 3 4 5 6"),
            "line 5: cellsize must be > 0, got -10");
  EXPECT_EQ(error_of_ascii("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1e-300\n1 2 3 4 5 6"),
            "line 5: cellsize must be from 0.0001 to 1e7 m, got 1e-300");
  EXPECT_EQ(error_of_ascii("ncols 2.5\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3 4 5 6"),
            "line 5: ncols and nrows must be whole numbers, got 2.5");
  EXPECT_EQ(error_of_ascii("ncols 1e9\nnrows 1e9\nxllcorner 0\nyllcorner 0\ncellsize 1\n1"),
            "is too large: it has 1000000000 x 1000000000 points, and may have 16 million");
  EXPECT_EQ(error_of_ascii("ncols 1000\nnrows 1000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1"),
            "is too short for 1000 x 1000 heights");
  EXPECT_EQ(error_of_ascii(header + "1 2 3\n4 5\n"), "line 8: the file ends before height 3 of row 2");
  EXPECT_EQ(error_of_ascii(header + "1 2 3\n4 5 6 7\n"), "line 7: there are more heights than ncols times nrows");
  EXPECT_EQ(error_of_ascii(header + "1 2 3\n4 inf 6\n"), "line 7: height 2 of row 2 is not finite");
  EXPECT_EQ(error_of_ascii(header + "1 2 3\n4 1,5 6\n"), "line 7: height 2 of row 2 is not a number, got '1,5'");
}

TEST(AsciiGrid, HolesAreReadInAllSpellings) {
  const std::string size = "ncols 3\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 10\n";
  for (const char* word : {"nan", "NaN", "-nan", "-nan(ind)", "1.#QNAN", "-1.#IND", "null", "-9999"}) {
    // By NODATA_value nan, by a number, and without; also as the first height, which is not a key.
    for (const char* nodata : {"NODATA_value nan\n", "NODATA_value -9999\n", "NODATA_value null\n", ""}) {
      if (std::string(word) == "-9999" && std::string(nodata).find("value n") != std::string::npos) continue;
      const HeightGrid grid = sim::parse_ascii_grid(size + nodata + word + " 2 4\n2 6 7\n", 1, Holes::nearest);
      EXPECT_EQ(grid.at(0, 1), 2) << word << " " << nodata;  // as both beside it
      EXPECT_EQ(grid.at(2, 1), 4);
    }
    EXPECT_EQ(error_of_ascii(size + "2 " + word + " 4\n5 6 7\n"),
              "line 6: a hole (NODATA) at column 2 of row 1: fill holes with 'holes: nearest' or 'holes: linear'");
  }
  // With NODATA_value nan a number is a height, whatever it is.
  EXPECT_EQ(sim::parse_ascii_grid(size + "NODATA_value nan\n-9999 2 4\n5 6 7\n", 1, Holes::nearest).at(0, 1), -9999);
}

TEST(AsciiGrid, CellsAreGivenByTheirSizeOrByDxAndDy) {
  const std::string head = "ncols 2\nnrows 2\nxllcenter 0\nyllcenter 0\n";
  // As GDAL writes cells that are square except for rounding.
  EXPECT_EQ(sim::parse_ascii_grid(head + "dx 10\ndy 10\n1 2\n3 4\n", 1, Holes::error).cell_m, 10);
  EXPECT_EQ(sim::parse_ascii_grid(head + "dx 10.000000000\ndy 10.000000001\n1 2\n3 4\n", 1, Holes::error).cell_m, 10);
  EXPECT_EQ(error_of_ascii(head + "dx 10\ndy 20\n1 2\n3 4\n"),
            "line 6: cells must be square, but 'dx' is 10 and 'dy' 20");
  EXPECT_EQ(error_of_ascii(head + "dx 10\n1 2\n3 4\n"),
            "line 5: is not an ESRI ASCII grid: 'cellsize' is missing before the heights");
}

TEST(AsciiGrid, BeginsWithAByteOrderMarkOrNot) {
  const std::string text = "ncols 2\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1\n1 2\n3 4\n";
  EXPECT_EQ(sim::parse_ascii_grid("\xef\xbb\xbf" + text, 1, Holes::error).at(1, 0), 4);
}

}  // namespace
