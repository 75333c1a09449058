// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/estimates/log_paths.hpp"

#include <gmock/gmock.h>

#include "shoal/waypoints_command_t.hpp"
#include "tests/experiment/replay/recorded_run.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/viewer/estimates/log_paths_fixture.hpp"

namespace {

using namespace log_paths_fixture;

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
