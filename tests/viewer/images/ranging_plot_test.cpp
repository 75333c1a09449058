// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "shoal/message_codec.hpp"
#include "shoal/multibeam_t.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/point_cloud_t.hpp"
#include "shoal/radar_sector_t.hpp"
#include "shoal/side_scan_t.hpp"
#include "shoal/sonar_image_t.hpp"
#include "shoal/utime_t.hpp"
#include "sim/image/image_file.hpp"
#include "viewer/images/log_image.hpp"

namespace {

/// An LCM event log with three events of one message on the channel `s`.
class RangingPlot : public testing::Test {
 protected:
  ~RangingPlot() override { std::filesystem::remove_all(folder_); }

  template <typename Message>
  std::string log_of(const Message& message) {
    const auto payload = shoal::encode(message);
    std::ofstream log(folder_ / "run.lcm", std::ios::binary);
    const auto put = [&](std::uint64_t value, int bytes) {  // big-endian
      for (int i = bytes - 1; i >= 0; --i) log.put(static_cast<char>(value >> (8 * i)));
    };
    for (std::uint64_t number = 0; number < 3; ++number) {
      put(0xEDA1DA01, 4);
      put(number, 8);
      put(number * 1000, 8);
      put(1, 4);
      put(payload.size(), 4);
      log.put('s');
      log.write(reinterpret_cast<const char*>(payload.data()), static_cast<std::streamsize>(payload.size()));
    }
    return (folder_ / "run.lcm").string();
  }
  template <typename Message>
  std::string problem_of(const Message& message, const std::string& channel = "s", std::optional<int> number = {}) {
    try {
      viewer::draw_log(log_of(message), channel, png(), {number, {}});
      return {};
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  }
  std::string png() const { return (folder_ / "out.png").string(); }
  bool drawn() const {
    std::ifstream file(png(), std::ios::binary);
    std::string start(4, ' ');
    return file.read(start.data(), 4) && start == "\x89PNG";
  }

  std::filesystem::path folder_ = [] {
    auto folder = std::filesystem::temp_directory_path() / ("ranging_picture_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    return folder;
  }();
};

shoal::side_scan_t side_scan() {
  return {0, 0, 10, 80, 0.2f, 3, {0, 128, 255}, {255, 128, 0}};
}

TEST_F(RangingPlot, DrawsSideScans) {
  EXPECT_EQ(problem_of(side_scan()), "");
  EXPECT_TRUE(drawn());
}

TEST_F(RangingPlot, DrawsSonarImagesOfOneBeamAndOfAFullCircle) {
  shoal::sonar_image_t image{0, 2, 4, 1, 10, -3.1f, 1.57f, 80, 0.2f, 8, {0, 50, 100, 150, 200, 250, 0, 50}};
  EXPECT_EQ(problem_of(image), "");
  EXPECT_TRUE(drawn());
  image.nbeams = 1;
  image.nbins = 8;
  image.radstep = 0;
  EXPECT_EQ(problem_of(image), "");
  image.nbins = 7;
  EXPECT_EQ(problem_of(image), "the image has an invalid size");
}

TEST_F(RangingPlot, DrawsMultibeamsPointCloudsAndScans) {
  EXPECT_EQ(problem_of(shoal::multibeam_t{0, 2, {-0.5f, 0.5f}, {10, 12}, {100, 100}, {1, 1}}), "");
  EXPECT_TRUE(drawn());
  EXPECT_EQ(problem_of(shoal::point_cloud_t{0, 2, {1, 2}, {3, 4}, {5, 6}, {1, 1}, {0, 1}, {-5, 0}}), "");
  EXPECT_EQ(problem_of(shoal::planar_lidar_t{0, 2, {1, 2}, 0, {}, -0.5f, 1}), "");
}

TEST_F(RangingPlot, DrawsTheTurnOfARadarThatEndsWithTheMessage) {
  // Four spokes of two cells; the far cell of the spoke to the left is strong.
  shoal::radar_sector_t sector{};
  sector.nspokes = 4;
  sector.ncells = 2;
  sector.range_max_m = 100;
  sector.time_offsets_us = {-3, -2, -1, 0};
  sector.azimuths_rad = {0, -1.5708f, 3.1416f, 1.5708f};
  sector.size = 8;
  sector.data = {0, 0, 0, 0, 0, 0, 0, 255};
  EXPECT_EQ(problem_of(sector), "");
  const sim::Image8 image = sim::read_image(png());
  // Means of red in the left and right half, without the axes' labels.
  const auto red = [&](int from, int to) {
    double sum = 0;
    int count = 0;
    for (int y = image.height / 3; y < 2 * image.height / 3; ++y)
      for (int x = from; x < to; ++x) sum += image.at(x, y)[0], ++count;
    return sum / count;
  };
  EXPECT_GT(red(image.width / 4, image.width / 2), red(image.width / 2, 3 * image.width / 4) + 20);
  EXPECT_EQ(problem_of(sector, "s", 1), "");
  sector.size = 7;
  sector.data.pop_back();
  EXPECT_EQ(problem_of(sector), "the sector has an invalid size");
}

TEST_F(RangingPlot, CountsWhoseProductOverflowsAreNoSize) {
  shoal::sonar_image_t image{0, 65536, 65536, 1, 10, -0.5f, 1e-5f, 80, 1, 0, {}};
  EXPECT_EQ(problem_of(image), "the image has an invalid size");
  image.nbeams = 65537;  // 65536 in 32 bits
  image.size = 65536;
  image.data.assign(65536, 'x');
  EXPECT_EQ(problem_of(image), "the image has an invalid size");
}

TEST_F(RangingPlot, OfACutLogSaysSo) {
  const std::string log = log_of(side_scan());
  std::filesystem::resize_file(log, std::filesystem::file_size(log) - 3);
  EXPECT_THAT(viewer::draw_log(log, "s", png(), {}).problems,
              testing::ElementsAre(testing::HasSubstr("the last event is cut off")));
  EXPECT_TRUE(drawn());
}

TEST_F(RangingPlot, SaysWhyThereIsNone) {
  EXPECT_THAT(problem_of(side_scan(), "other"), testing::HasSubstr("no event on channel 'other'"));
  EXPECT_THAT(problem_of(shoal::utime_t{}), testing::HasSubstr("its type cannot be drawn"));
  EXPECT_EQ(problem_of(shoal::planar_lidar_t{0, 2, {1, 2}, 0, {}, -0.5f, 1}, "s", 3),
            "there is no message 3; there are 3, from 0");
}

}  // namespace
