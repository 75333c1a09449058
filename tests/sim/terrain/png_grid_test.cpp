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
using test::error_of;
using testing::HasSubstr;

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

}  // namespace
