// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/estimates/log_paths.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "shoal/pose_t.hpp"
#include "shoal/waypoints_command_t.hpp"
#include "tests/experiment/replay/recorded_run.hpp"
#include "tests/scratch_folder.hpp"

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A path along y = x from 0 to `end_m`, as many meters deep.
shoal::waypoints_command_t path_to(double end_m, double depth_m = nan, int points = 2) {
  shoal::waypoints_command_t path{};
  path.n = points;
  for (int i = 0; i < points; ++i) {
    path.x_m.push_back(end_m * i / (points - 1));
    path.y_m.push_back(path.x_m.back());
    path.depth_m.push_back(depth_m);
  }
  return path;
}

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
  const auto path = read(path_to(5000, nan, 5001));
  ASSERT_TRUE(path);
  ASSERT_EQ(path->points.size(), viewer::VehiclePath::max_points);
  EXPECT_EQ(path->points.front().x_m, 0);
  EXPECT_EQ(path->points.back().x_m, 5000);
  EXPECT_NEAR(path->points[500].x_m, 5000.0 * 500 / 999, 1);
}

TEST(VehiclePath, IsNoneForOtherMessagesAndForPointsNowhere) {
  EXPECT_FALSE(viewer::read_path(shoal::encode(shoal::pose_t{})));
  EXPECT_FALSE(viewer::read_path({}));
  EXPECT_FALSE(read(path_to(nan)));
  EXPECT_FALSE(read(path_to(std::numeric_limits<double>::infinity())));
  EXPECT_FALSE(read(path_to(1e8)));
  EXPECT_FALSE(read(path_to(1, std::numeric_limits<double>::infinity())));
  auto cut = shoal::encode(path_to(4));
  cut.resize(cut.size() - 3);
  EXPECT_THROW(viewer::read_path(cut), shoal::MessageError);
}

TEST(LogPaths, TheLastPathOfEachChannelUpToATimeCounts) {
  const test_support::ScratchFolder folder;
  const std::string log = folder.file("run.lcm");
  {
    test::RecordedRun run("shoal: 1\nphysics: {step_s: 0.01}\n", log);
    const auto publish = [&](const std::string& channel, shoal::waypoints_command_t path) {
      const sim::Time now = run.world.now();
      run.recorder.set_time(now);
      path.utime = run.world.epoch_us() + now.count();
      run.gate.publish(channel, shoal::encode(path), now);
    };
    for (int i = 1; i <= 300; ++i) {
      run.world.step();
      if (i == 100) publish("rover1.path", path_to(1));
      if (i == 200) publish("rover1.path", path_to(2));
      if (i == 200) publish("auv.autopilot.cmd", path_to(7, 10));
      if (i == 300) publish("rover1.path", path_to(3));
    }
  }
  const viewer::LogPaths paths(log, 2.5);
  const auto ends = [&](double time_s) {
    std::map<std::string, double> all;
    for (const auto& [channel, path] : paths.at(time_s)) all[channel] = path->points.back().x_m;
    return all;
  };
  using Ends = std::map<std::string, double>;
  EXPECT_EQ(ends(0.9), Ends{});
  EXPECT_EQ(ends(1), (Ends{{"rover1.path", 1}}));
  EXPECT_EQ(ends(2.4), (Ends{{"rover1.path", 2}, {"auv.autopilot.cmd", 7}}));
  EXPECT_EQ(ends(100), ends(2.4)) << "read up to 2.5 s";
  EXPECT_EQ(viewer::path_vehicle("auv.autopilot.cmd"), "auv");
}

}  // namespace
