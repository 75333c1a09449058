// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/estimates/vehicle_path.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "shoal/message_codec.hpp"
#include "shoal/pose_t.hpp"
#include "shoal/waypoints_command_t.hpp"
#include "tests/viewer/estimates/log_paths_fixture.hpp"
#include "viewer/estimates/log_paths.hpp"

namespace {

using namespace log_paths_fixture;

std::optional<viewer::VehiclePath> read(const shoal::waypoints_command_t& message) {
  return viewer::read_path(shoal::encode(message));
}

TEST(VehiclePath, HasThePointsOfTheMessage) {
  auto message = path_to(4, 2.5);
  message.utime = 7;
  message.loop = 1;
  const auto path = read(message);
  ASSERT_TRUE(path);
  EXPECT_EQ(path->utime, 7);
  EXPECT_TRUE(path->loop);
  ASSERT_EQ(path->points.size(), 2u);
  EXPECT_EQ(path->points[1], (viewer::VehiclePath::Point{4, 4, 2.5}));
  EXPECT_TRUE(std::isnan(read(path_to(4))->points[0].depth_m));
  EXPECT_TRUE(path->leads_along(*read([&] {
    auto later = message;
    later.utime = 8;
    return later;
  }())));
  EXPECT_FALSE(path->leads_along(*read(path_to(5, 2.5))));
}

TEST(VehiclePath, OfVeryManyPointsHasEvenlySpacedOnes) {
  const auto path = read(path_to(5000, unknown_m, 5001));
  ASSERT_TRUE(path);
  ASSERT_EQ(path->points.size(), viewer::VehiclePath::max_points);
  EXPECT_EQ(path->points.front().x_m, 0);
  EXPECT_EQ(path->points.back().x_m, 5000);
  EXPECT_NEAR(path->points[500].x_m, 5000.0 * 500 / 999, 1);
}

TEST(VehiclePath, IsNoneForOtherMessagesAndForPointsNowhere) {
  EXPECT_FALSE(viewer::read_path(shoal::encode(shoal::pose_t{})));
  EXPECT_FALSE(viewer::read_path({}));
  EXPECT_FALSE(read(path_to(unknown_m)));
  EXPECT_FALSE(read(path_to(std::numeric_limits<double>::infinity())));
  EXPECT_FALSE(read(path_to(1e8)));
  EXPECT_FALSE(read(path_to(1, std::numeric_limits<double>::infinity())));
  auto cut = shoal::encode(path_to(4));
  cut.resize(cut.size() - 3);
  EXPECT_THROW(viewer::read_path(cut), shoal::MessageError);
}

}  // namespace
