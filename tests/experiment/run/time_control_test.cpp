// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/time_control.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "tests/experiment/run/time_control_fixture.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(TimeControl, ARewindGoesToTheStepAndTheSameFollows) {
  test::ControlledRun run;
  run.run_to(150);
  const std::uint64_t hash = run.hash();
  EXPECT_EQ(run.time.rewind(0.5, false), "step 100, 1 s, branch 1, paused");
  EXPECT_EQ(run.world.step_number(), 100);
  EXPECT_THAT(run.timeline.done, ElementsAre("leave for 100", "start"));
  EXPECT_TRUE(run.time.take_moved());
  EXPECT_FALSE(run.time.take_moved()) << "only once";
  run.run_to(150);
  EXPECT_EQ(run.hash(), hash);
}

TEST(TimeControl, AMoveThatTheRunCannotMakeLeavesTheWorldWhereItIs) {
  test::ControlledRun run;
  run.run_to(150);
  const std::uint64_t hash = run.hash();
  run.timeline.refuses = true;
  EXPECT_THAT([&] { run.time.rewind(0.5, false); }, ThrowsMessage<std::runtime_error>("the record cannot branch"));
  EXPECT_THAT(run.timeline.done, ElementsAre("hold"));
  EXPECT_EQ(run.hash(), hash);
  EXPECT_EQ(run.time.place(), "step 150, 1.5 s, branch 0");
}

TEST(TimeControl, ARunWithoutHistoryCannotBeRewound) {
  test::ControlledRun run("", 0);
  run.run_to(10);
  EXPECT_THAT([&] { run.time.rewind(0.05, false); },
              ThrowsMessage<std::runtime_error>(HasSubstr("keeps no snapshots for a rewind: see --rewind-s")));
  EXPECT_EQ(run.time.execute("where", "", 0), "step 10, 0.1 s, branch 0");
}

TEST(TimeControl, ARewindTakesOneWord) {
  test::ControlledRun run;
  EXPECT_THAT([&] { run.time.execute("rewind", "30", 0); },
              ThrowsMessage<std::runtime_error>(HasSubstr("'rewind' takes the text 'run' or none, got '30'")));
  run.run_to(20);
  EXPECT_EQ(run.time.execute("rewind", "run", 0.1), "step 10, 0.1 s, branch 1");
}

TEST(TimeControl, GoesBackToASnapshotFileAndTheSameFollows) {
  test::ControlledRun run;
  run.run_to(20);
  const std::string path = run.options.directory + "/start.snapshot";
  EXPECT_EQ(run.time.write_snapshot("start"), "step 20, 0.2 s, branch 0: " + path);
  EXPECT_THAT([&] { run.time.write_snapshot("start"); },
              ThrowsMessage<std::runtime_error>(path + ": already exists; choose another name"));
  run.run_to(50);
  const std::uint64_t hash = run.hash();
  EXPECT_EQ(run.time.restore("start", true), "step 20, 0.2 s, branch 1");
  run.run_to(50);
  EXPECT_EQ(run.hash(), hash);
}

TEST(TimeControl, ASnapshotFileIsInItsFolder) {
  test::ControlledRun run;
  for (const std::string name : {"../start", ".start", "a b"})
    EXPECT_THAT([&] { run.time.write_snapshot(name); },
                ThrowsMessage<std::runtime_error>(HasSubstr("not beginning with '.', got '" + name + "'")));
  run.run_to(3);
  run.time.write_planned_snapshot();
  EXPECT_TRUE(std::filesystem::exists(run.options.directory + "/branch0_step3.snapshot"));
  EXPECT_THAT([&] { run.time.check_planned_snapshot(3); },
              ThrowsMessage<std::runtime_error>(HasSubstr("a snapshot of an earlier run; give --overwrite")));
  EXPECT_NO_THROW(run.time.check_planned_snapshot(4));
}

TEST(TimeControl, ASnapshotOfAnotherWorldIsRefusedWithTheLineThatDiffers) {
  test::ControlledRun well, pit("name: pit\n");
  well.time.write_snapshot("start");
  std::filesystem::copy(well.options.directory, pit.options.directory);
  EXPECT_THAT([&] { pit.time.restore("start", true); },
              ThrowsMessage<std::runtime_error>(
                  HasSubstr("is of another world or other values: line 1: 'name: well' there, 'name: pit' here")));
  EXPECT_THAT(pit.timeline.done, testing::IsEmpty());
}

}  // namespace
