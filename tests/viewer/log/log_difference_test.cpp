// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/log/log_difference.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "bridges/log/record_file.hpp"
#include "bridges/view/view_publisher.hpp"
#include "experiment/replay/replay.hpp"
#include "tests/experiment/replay/recorded_run.hpp"
#include "tests/scratch_folder.hpp"
#include "viewer/server/log_view.hpp"

namespace {

/// Logs with hashes, as `shoal run` writes them, differ where their hashes do.
class LogDifference : public testing::Test {
 protected:
  static std::string world(double z_m) {
    return "shoal: 1\nrun: {hash_every_steps: 10}\nphysics: {step_s: 0.01}\nobjects: [{name: ball, parts: [{shape: "
           "sphere, mass_kg: 1}], position_m: [0, 0, " +
           std::to_string(z_m) + "]}]\n";
  }
  /// Records a second; `lift_at`: step at which a client moves the ball.
  std::string record(const std::string& name, double z_m, std::int64_t lift_at = -1) {
    test::RecordedRun run(world(z_m), folder_.file(name));
    bridges::ViewPublisher view(run.gate, run.world, {}, [] { return true; });
    view.after_step();
    run.run(100, [&](std::int64_t step) {
      if (step == lift_at) run.request("do", "{move: {name: ball, position_m: [0, 0, 9]}}");
    });
    return folder_.file(name);
  }

  test_support::ScratchFolder folder_;
};

TEST_F(LogDifference, IsTheFirstHashThatDiffers) {
  const std::string a = record("a.lcm", 1), b = record("b.lcm", 1, 52);
  const auto difference = viewer::first_difference(a, viewer::LogIndex(a), b, viewer::LogIndex(b));
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->by, "sim.hash");
  EXPECT_EQ(difference->step, 60);
  EXPECT_EQ(difference->time_us, 600'000);
}

TEST_F(LogDifference, IsThatOfAReplay) {
  const std::string a = record("a.lcm", 1), b = record("b.lcm", 2);
  const auto difference = viewer::first_difference(a, viewer::LogIndex(a), b, viewer::LogIndex(b));
  ASSERT_TRUE(difference);
  // The log of b in the world of a.
  experiment::ReplayOptions options;
  options.log = b;
  options.world = folder_.file("a.yaml");
  std::ofstream(options.world) << world(1);
  options.quiet = true;
  const experiment::ReplayOutcome replayed = experiment::replay(options);
  ASSERT_TRUE(replayed.first);
  EXPECT_EQ(replayed.first->step, *difference->step);
}

}  // namespace
