// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/images/log_image.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>

#include "devices/ranging/camera.hpp"
#include "shoal/image_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/side_scan_t.hpp"
#include "sim/image/image_file.hpp"
#include "tests/viewer/images/image_log.hpp"

namespace {

using namespace image_log;

using testing::HasSubstr;

TEST_F(LogImage, ChoosesTheImageNearestToASimulatedTime) {
  const std::string log = film(5);
  for (const auto& [at_s, number] : {std::pair{10.0, 0}, {10.7, 1}, {10.8, 2}, {12.0, 4}, {12.4, 4}}) {
    const auto made = viewer::draw_log(log, "r.camera", png_, {{}, at_s});
    EXPECT_EQ(sim::read_image(png_).data[0], number) << at_s;
    EXPECT_THAT(made.drawn, HasSubstr("message " + std::to_string(number) + " of 0 to 4, at "));
  }
  EXPECT_EQ(problem([&] {
              viewer::draw_log(log, "r.camera", png_, {{}, 20});
            }),
            "there is no message at 20 s; they are from 10.000 to 12.000 s");
  EXPECT_EQ(problem([&] {
              viewer::draw_log(log, "r.camera", png_, {{}, 2});
            }),
            "there is no message at 2 s; they are from 10.000 to 12.000 s");
}

TEST_F(LogImage, ChoosesByNumberElseTheLast) {
  const std::string log = film(5);
  viewer::draw_log(log, "r.camera", png_, {3, {}});
  EXPECT_EQ(sim::read_image(png_).data[0], 3);
  EXPECT_EQ(viewer::draw_log(log, "r.camera", png_, {}).drawn, "message 4 of 0 to 4, at 12.000 s");
  EXPECT_EQ(sim::read_image(png_).data[0], 4);
  EXPECT_EQ(problem([&] {
              viewer::draw_log(log, "r.camera", png_, {5, {}});
            }),
            "there is no message 5; there are 5, from 0");
}

TEST_F(LogImage, CountsFromTheFirstEventWhereTheLogDoesNotSayWhenTheRunBegan) {
  Log log;
  for (int i = 0; i < 3; ++i) log.add(50 + i, "c", shoal::encode(grey(static_cast<std::uint8_t>(i), 0)));
  viewer::draw_log(log.write(folder_.file("a.lcm")), "c", png_, {{}, 1.2});
  EXPECT_EQ(sim::read_image(png_).data[0], 1);
}

TEST_F(LogImage, RefusesToChooseAmongLinesThatAreAllDrawn) {
  Log log;
  log.add(0, "s", shoal::encode(shoal::side_scan_t{0, 0, 10, 80, 0.2f, 3, {0, 128, 255}, {255, 128, 0}}));
  const std::string path = log.write(folder_.file("s.lcm"));
  EXPECT_THAT(problem([&] { viewer::draw_log(path, "s", png_, {0, {}}); }), HasSubstr("all its messages are drawn"));
  EXPECT_THAT(problem([&] { viewer::draw_log(path, "s", png_, {{}, 0}); }), HasSubstr("all its messages are drawn"));
}

using namespace image_log;

using testing::HasSubstr;

void set_data(shoal::image_t& image, std::int32_t format, int stride, const void* data, std::size_t size) {
  image.pixelformat = format;
  image.row_stride = stride;
  image.data.resize(size);
  std::memcpy(image.data.data(), data, size);
  image.size = static_cast<std::int32_t>(size);
}

void add_metadata(shoal::image_t& image, const std::string& key, const std::string& value) {
  shoal::image_metadata_t entry{};
  entry.key = key;
  entry.value.assign(value.begin(), value.end());
  entry.n = static_cast<std::int32_t>(value.size());
  image.metadata.push_back(entry);
  image.nmetadata = static_cast<std::int32_t>(image.metadata.size());
}

TEST_F(LogImage, ShowsCamerasOfEveryKind) {
  sim::Image8 color(2, 1, 3);
  color.data = {255, 0, 0, 0, 0, 255};
  shoal::image_t image = grey(0, 0);
  // Rows may be padded.
  const std::uint8_t padded[] = {255, 0, 0, 0, 0, 255, 9, 9};
  set_data(image, devices::pixel_format_rgb, 8, padded, sizeof padded);
  EXPECT_EQ(drawn(image).data, color.data);
  sim::Bytes bytes;
  sim::encode_png(color, bytes);
  set_data(image, devices::pixel_format_png, 0, bytes.data(), bytes.size());
  EXPECT_EQ(drawn(image).data, color.data);
  sim::Image8 plain(16, 16, 3);
  std::fill(plain.data.begin(), plain.data.end(), 128);
  sim::encode_jpeg(plain, 95, bytes);
  image.width = image.height = 16;
  set_data(image, devices::pixel_format_mjpeg, 0, bytes.data(), bytes.size());
  EXPECT_NEAR(drawn(image).data[0], 128, 3);
}

TEST_F(LogImage, ShowsNearDepthBrightAndLabelsInTheirColors) {
  shoal::image_t image = grey(0, 0);
  const float depth_m[] = {1.0F, 10.0F};
  set_data(image, devices::pixel_format_float_grey32, 8, depth_m, sizeof depth_m);
  const sim::Image8 meters = drawn(image);  // read back as RGB: the second pixel begins at 3
  EXPECT_EQ(meters.data[0], 255);
  EXPECT_EQ(meters.data[3], 40);  // 255 - 215, the farthest
  sim::Image16 levels(2, 1, 1);
  levels.data = {1000, 10000};
  set_data(image, devices::pixel_format_le_grey16, 4, levels.data.data(), 4);
  EXPECT_EQ(drawn(image).data, meters.data);
  sim::Bytes bytes;
  sim::encode_png(levels, bytes);
  set_data(image, devices::pixel_format_png, 0, bytes.data(), bytes.size());
  add_metadata(image, "unit", "mm");
  EXPECT_EQ(drawn(image).data, meters.data);

  shoal::image_t labels = grey(0, 0);
  add_metadata(labels, "labels", "1 wall\n2 floor\n");
  levels.data = {1, 2};
  set_data(labels, devices::pixel_format_le_grey16, 4, levels.data.data(), 4);
  const auto first = sim::label_color(1);
  const sim::Image8 colored = drawn(labels);
  EXPECT_TRUE(std::equal(first.begin(), first.end(), colored.data.begin()));
}

TEST_F(LogImage, SaysWhatIsWrongWithAnImage) {
  shoal::image_t image = grey(0, 0);
  image.height = 9;
  EXPECT_EQ(problem([&] { drawn(image); }), "the image of 2 x 9 pixels has 2 bytes in rows of 2");
  image = grey(0, 0);
  image.row_stride = 1;
  EXPECT_EQ(problem([&] { drawn(image); }), "the image of 2 x 1 pixels has 2 bytes in rows of 1");
  image.width = 100'000;
  EXPECT_EQ(problem([&] { drawn(image); }), "the image has an invalid size: 100000 x 1");
  image = grey(0, 0);
  image.pixelformat = 7;
  EXPECT_THAT(problem([&] { drawn(image); }), HasSubstr("pixel format 7 cannot be drawn"));
  image.pixelformat = devices::pixel_format_png;
  EXPECT_NE(problem([&] { drawn(image); }), "");
}

}  // namespace
