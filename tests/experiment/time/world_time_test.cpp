// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/time/world_time.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/world/world_state.hpp"
#include "tests/experiment/run_parts_fixture.hpp"

namespace {

using experiment::History;
using testing::HasSubstr;

/// A crate that falls, and an event at 0.5 s.
class WorldTimeTest : public testing::Test {
 protected:
  std::string refusal(const std::string& command, const std::string& text, double value) {
    try {
      time.execute(command, text, value);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "none";
  }
  std::string refused_way_back(double seconds) {
    try {
      time.step_before(seconds, 0);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "none";
  }

  test::PartsOfARun run{{}, "events:\n  - {name: bell, at: 0.5, do: [{log: ding}]}\n"};
  sim::World& world = run.parts.world;
  sim::RunControl& control = run.parts.control;
  experiment::Scoring scoring{world};
  experiment::WorldTime time{world, control, scoring, run.parts.service, {.kept_s = 10}};
};

TEST_F(WorldTimeTest, GoesBackToAKeptStateAndTheSameFollows) {
  EXPECT_TRUE(time.keep()) << "the first state, whatever its step";
  run.step(30);
  const std::uint64_t later = world.state().hash();
  EXPECT_FALSE(time.keep()) << "not a whole second";
  ASSERT_EQ(time.newest_kept_until(29), 0);
  time.load_kept(0);
  EXPECT_EQ(world.step_number(), 0);
  EXPECT_FALSE(time.keep()) << "this state is kept already";
  run.step(30);
  EXPECT_EQ(world.state().hash(), later);
}

TEST_F(WorldTimeTest, KeepsNoStateWithoutATimeToKeepThem) {
  experiment::WorldTime none(world, control, scoring, run.parts.service, {});
  EXPECT_FALSE(none.keep());
  time.keep();
  time.stop_keeping();
  EXPECT_FALSE(time.keeps());
  EXPECT_FALSE(time.oldest_kept());
  EXPECT_FALSE(time.keep());
}

TEST_F(WorldTimeTest, SavesAndLoadsTheWholeState) {
  run.step(10);
  const experiment::SavedRun saved = time.save(History::whole);
  const std::uint64_t hash = world.state().hash();
  run.step(10);
  time.load(saved, History::whole);
  EXPECT_EQ(world.step_number(), 10);
  EXPECT_EQ(world.state().hash(), hash);
}

TEST_F(WorldTimeTest, SaysWhatFollowsThePlaceInAReply) {
  EXPECT_EQ(time.place(), "step 0, 0 s");
  EXPECT_EQ(time.execute("pause", "", 0), "");
  EXPECT_EQ(time.execute("step", "", 1), ", takes 1 step");
  EXPECT_EQ(time.execute("step", "", 2), ", takes 3 steps");
  EXPECT_EQ(time.execute("speed", "", 2), ", 2 x real time");
  EXPECT_EQ(time.execute("speed", "", 0), ", as fast as possible");
  EXPECT_FALSE(time.execute("fly", "", 0));
}

TEST_F(WorldTimeTest, PausesAtATime) {
  control.set_paused(true);
  EXPECT_EQ(time.execute("until", "", 0.2), ", runs until 0.2 s");
  EXPECT_FALSE(control.paused);
  run.step(19);
  EXPECT_FALSE(time.stop_when_there());
  run.step(1);
  EXPECT_TRUE(time.stop_when_there());
  EXPECT_TRUE(control.paused);
  EXPECT_FALSE(time.stop_when_there()) << "only once";
  EXPECT_THAT(refusal("until", "", 0.2), HasSubstr("'until' needs a time after now (0.2 s)"));
}

TEST_F(WorldTimeTest, PausesWhenAnEventHasHappened) {
  EXPECT_EQ(time.execute("until", "bell", 0), ", runs until event 'bell' fires");
  while (!time.stop_when_there() && world.step_number() < 100) run.step(1);
  EXPECT_NEAR(sim::to_seconds(world.now()), 0.5, 0.011);
  EXPECT_THAT(refusal("until", "gong", 0), HasSubstr("got 'gong'"));
}

TEST_F(WorldTimeTest, FindsTheStepBeforeAndSaysWhyThereIsNone) {
  EXPECT_THAT(refused_way_back(1), HasSubstr("already at the start of the run"));
  run.step(50);
  EXPECT_EQ(time.step_before(0.2, 0), 30);
  EXPECT_EQ(time.step_before(3, 0), 0) << "beyond the start";
  EXPECT_EQ(time.step_before(3, 10), 10);
  EXPECT_THAT(refused_way_back(0), HasSubstr("needs a value above 0"));
  EXPECT_THAT(refused_way_back(0.004), HasSubstr("less than half a step of 0.01 s"));
}

TEST(SavedRun, IsSplitIntoWhatWasJoined) {
  const experiment::SavedRun saved{sim::Bytes(5, std::byte{1}), {}, sim::Bytes(300, std::byte{3})};
  const experiment::SavedRun again = experiment::split(experiment::joined(saved));
  EXPECT_EQ(again.state, saved.state);
  EXPECT_EQ(again.scores, saved.scores);
  EXPECT_EQ(again.owners, saved.owners);
}

}  // namespace
