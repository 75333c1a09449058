// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/images/log_image.hpp"

#include <gmock/gmock.h>

#include <cstring>

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

}  // namespace
