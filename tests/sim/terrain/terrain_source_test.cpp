// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "sim/base/crc32.hpp"
#include "sim/terrain/terrain.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/sim/terrain/terrain_error.hpp"

namespace {

using sim::HeightGrid;
using sim::Holes;
using testing::HasSubstr;

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

struct PictureExtra {
  int transparent_level = -1;  ///< of a tRNS chunk; -1: without
  int interlace = PNG_INTERLACE_NONE;
  int palette = 0;  ///< colors in a PLTE chunk
};

/// A PNG that is removed again.
class Picture {
 public:
  Picture(int width, int height, int bits, int color_type, const std::vector<unsigned char>& bytes,
          const PictureExtra& extra = {})
      : path_(folder_.file("image.png")) {
    std::FILE* file = std::fopen(path_.c_str(), "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_set_IHDR(png, info, width, height, bits, color_type, extra.interlace, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_color_16 transparent{};
    transparent.gray = static_cast<png_uint_16>(extra.transparent_level);
    if (extra.transparent_level >= 0) png_set_tRNS(png, info, nullptr, 0, &transparent);
    const std::vector<png_color> palette(static_cast<std::size_t>(extra.palette), png_color{1, 2, 3});
    if (extra.palette > 0) png_set_PLTE(png, info, palette.data(), extra.palette);
    png_write_info(png, info);
    for (int pass = png_set_interlace_handling(png); pass > 0; --pass)
      for (int row = 0; row < height; ++row)
        png_write_row(png, bytes.data() + static_cast<std::size_t>(row) * (bytes.size() / height));
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    std::fclose(file);
  }
  const std::string& path() const { return path_; }

 private:
  test_support::ScratchFolder folder_;
  std::string path_;
};

TEST(PngGrid, EightAndSixteenBitsGoFromBlackToWhiteWithNorthOnTop) {
  const Picture small(2, 2, 8, PNG_COLOR_TYPE_GRAY, {0, 255, 51, 102});
  const HeightGrid grid = sim::read_png_grid(small.path(), 0.5, 10, 20);
  EXPECT_EQ(grid.at(0, 1), 10);
  EXPECT_EQ(grid.at(1, 1), 20);
  EXPECT_NEAR(grid.at(0, 0), 12, 1e-12);
  EXPECT_NEAR(grid.at(1, 0), 14, 1e-12);
  const Picture deep(2, 2, 16, PNG_COLOR_TYPE_GRAY, {0, 0, 0, 1, 255, 255, 1, 0});
  const HeightGrid fine = sim::read_png_grid(deep.path(), 0.5, 0, 65535);
  EXPECT_EQ(fine.at(0, 1), 0);
  EXPECT_EQ(fine.at(1, 1), 1);
  EXPECT_EQ(fine.at(0, 0), 65535);
  EXPECT_EQ(fine.at(1, 0), 256);
}

TEST(PngGrid, ColorsAndBrokenFilesAreErrors) {
  const Picture color(2, 2, 8, PNG_COLOR_TYPE_RGB, std::vector<unsigned char>(12, 7));
  EXPECT_EQ(error_of([&] { sim::read_png_grid(color.path(), 1, 0, 1); }),
            "cannot be read as heights: PNG: has colors or transparency, must be plain grey");
  const Picture whole(64, 64, 8, PNG_COLOR_TYPE_GRAY, std::vector<unsigned char>(4096, 7));
  std::filesystem::resize_file(whole.path(), std::filesystem::file_size(whole.path()) - 20);
  EXPECT_THAT(error_of([&] { sim::read_png_grid(whole.path(), 1, 0, 1); }),
              HasSubstr("cannot be read as heights: PNG: "));
  std::ofstream(whole.path()) << "no image at all";
  EXPECT_THAT(error_of([&] { sim::read_png_grid(whole.path(), 1, 0, 1); }),
              HasSubstr("cannot be read as heights: PNG: "));
}

/// Before: 134 or 139, for each row had a channel more than there was room for.
TEST(PngGrid, AGreyImageWithATransparentLevelIsRefused) {
  for (const int bits : {8, 16}) {
    const Picture image(16, 16, bits, PNG_COLOR_TYPE_GRAY,
                        std::vector<unsigned char>(static_cast<std::size_t>(16 * 16 * bits / 8), 7),
                        {.transparent_level = 7});
    EXPECT_EQ(error_of([&] { sim::read_png_grid(image.path(), 1, 0, 1); }),
              "cannot be read as heights: PNG: has colors or transparency, must be plain grey");
  }
}

TEST(PngGrid, APaletteAndGreyWithAlphaAreRefused) {
  const Picture indexed(4, 4, 8, PNG_COLOR_TYPE_PALETTE, std::vector<unsigned char>(16, 1), {.palette = 4});
  const Picture alpha(4, 4, 16, PNG_COLOR_TYPE_GRAY_ALPHA, std::vector<unsigned char>(64, 1));
  for (const Picture* image : {&indexed, &alpha})
    EXPECT_EQ(error_of([&] { sim::read_png_grid(image->path(), 1, 0, 1); }),
              "cannot be read as heights: PNG: has colors or transparency, must be plain grey");
}

TEST(PngGrid, InterlacedRowsAndFewBitsGiveTheSameHeights) {
  std::vector<unsigned char> bytes(17 * 17);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<unsigned char>(i);
  const Picture plain(17, 17, 8, PNG_COLOR_TYPE_GRAY, bytes);
  const Picture interlaced(17, 17, 8, PNG_COLOR_TYPE_GRAY, bytes, {.interlace = PNG_INTERLACE_ADAM7});
  EXPECT_EQ(sim::read_png_grid(interlaced.path(), 1, 0, 1).heights_m,
            sim::read_png_grid(plain.path(), 1, 0, 1).heights_m);
  const Picture bits(8, 2, 1, PNG_COLOR_TYPE_GRAY, {0b10000000, 0b00000001});
  const HeightGrid grid = sim::read_png_grid(bits.path(), 1, 0, 3);
  EXPECT_EQ(grid.at(0, 1), 3);
  EXPECT_EQ(grid.at(1, 1), 0);
  EXPECT_EQ(grid.at(7, 0), 3);
}

/// A PNG that claims `width` x `height` and has no data; its check sum is right.
std::string header_of(std::uint32_t width, std::uint32_t height) {
  std::string bytes = "\x89PNG\r\n\x1a\n";
  std::string chunk = "IHDR";
  for (const std::uint32_t side : {width, height})
    for (int shift = 24; shift >= 0; shift -= 8) chunk += static_cast<char>(side >> shift);
  chunk += std::string("\x08\0\0\0\0", 5);
  const std::uint32_t sum = sim::crc32(std::as_bytes(std::span(chunk)));
  bytes += std::string("\0\0\0\x0d", 4) + chunk;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(sum >> shift);
  return bytes + std::string("\0\0\0\0IDAT", 8);
}

TEST(PngGrid, AHugeSizeIsRefusedBeforeMemoryIsTakenForIt) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("huge.png");
  std::ofstream(path) << header_of(900'000, 900'000);
  EXPECT_THAT(error_of([&] { sim::read_png_grid(path, 1, 0, 1); }),
              HasSubstr("is too large: it has 900000 x 900000 points"));
}

TEST(PngGrid, ADamagedCheckSumAndANamedPipeAreRefused) {
  const Picture image(64, 64, 8, PNG_COLOR_TYPE_GRAY, std::vector<unsigned char>(4096, 7));
  std::fstream file(image.path(), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(30);  // within the check sum of the header
  file.put('\x55');
  file.close();
  EXPECT_THAT(error_of([&] { sim::read_png_grid(image.path(), 1, 0, 1); }),
              HasSubstr("cannot be read as heights: PNG: "));
  const test_support::ScratchFolder folder;
  ASSERT_EQ(mkfifo(folder.file("pipe.png").c_str(), 0600), 0);
  EXPECT_EQ(error_of([&] { sim::read_png_grid(folder.file("pipe.png"), 1, 0, 1); }), "does not exist");
}

TEST(Terrain, OriginIsTheMiddleTheCornerOrAPlaceOnTheMap) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("origin.asc");
  std::ofstream(path) << header << "1 2 3\n4 5 6\n";
  sim::TerrainConfig config;
  config.source = sim::TerrainConfig::Source::ascii;
  config.file = path;
  EXPECT_EQ(sim::load_terrain(config).grid.west_m, -10);
  EXPECT_EQ(sim::load_terrain(config).grid.south_m, -5);
  config.origin = sim::TerrainConfig::Origin::corner;
  EXPECT_EQ(sim::load_terrain(config).grid.west_m, 0);
  config.origin = sim::TerrainConfig::Origin::map;
  config.map_origin_m = {110, 200};
  EXPECT_EQ(sim::load_terrain(config).grid.west_m, -5);
  EXPECT_EQ(sim::load_terrain(config).grid.south_m, 5);
  config.vertical_offset_m = -1;
  EXPECT_EQ(sim::load_terrain(config).grid.at(0, 1), 0);
  std::filesystem::remove(path);
  EXPECT_EQ(error_of([&] { sim::load_terrain(config); }), "file '" + path + "' does not exist");
}

TEST(Terrain, FractalDependsOnItsSeedAloneAndSpansTwiceItsAmplitude) {
  sim::TerrainConfig config;
  config.source = sim::TerrainConfig::Source::fractal;
  config.size_m = {40, 20};
  config.amplitude_m = 3;
  const auto heights = [&] { return sim::load_terrain(config).grid.heights_m; };
  const std::vector<double> first = heights();
  EXPECT_EQ(first.size(), 41u * 21u);
  EXPECT_EQ(first, heights());
  EXPECT_NEAR(*std::max_element(first.begin(), first.end()), 3, 1e-12);
  EXPECT_NEAR(*std::min_element(first.begin(), first.end()), -3, 1e-12);
  config.seed = 2;
  EXPECT_NE(first, heights());
}

TEST(Terrain, TheLastAreaOverTheMiddleOfACellWins) {
  sim::TerrainConfig config;
  config.source = sim::TerrainConfig::Source::slope;
  config.size_m = {10, 10};
  config.areas.resize(3);
  config.areas[0].size_m = {6, 6, 0};
  config.areas[1].shape = sim::TerrainAreaConfig::Shape::circle;
  config.areas[1].radius_m = 1.5;
  config.areas[2].shape = sim::TerrainAreaConfig::Shape::polygon;
  config.areas[2].points_m = {{2, 2, 0}, {5, 2, 0}, {5, 5, 0}};
  const sim::Terrain terrain = sim::load_terrain(config);
  EXPECT_EQ(terrain.area_at(-4.5, 0), 0);
  EXPECT_EQ(terrain.area_at(-2.5, 2.5), 1);
  EXPECT_EQ(terrain.area_at(0.5, 0.5), 2);
  EXPECT_EQ(terrain.area_at(4.5, 2.7), 3);
  EXPECT_EQ(terrain.area_at(100, -100), 0);  // outside: as the nearest cell
}

TEST(FractalTerrain, OfWavesFarLongerThanItselfIsAsOfThoseAFewTimesAsLong) {
  sim::TerrainConfig config;
  config.source = sim::TerrainConfig::Source::fractal;
  config.size_m = {64, 32};
  config.wavelength_m = 512;  // 8 times as long
  config.roughness = 1;
  const sim::HeightGrid few_times = sim::generate_grid(config);
  config.wavelength_m = 512 * 16384;
  EXPECT_EQ(sim::generate_grid(config).heights_m, few_times.heights_m);
  config.wavelength_m = 256;
  EXPECT_NE(sim::generate_grid(config).heights_m, few_times.heights_m);
}

}  // namespace
