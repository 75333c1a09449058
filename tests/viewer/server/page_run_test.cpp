// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "experiment/replay/replay.hpp"
#include "experiment/run/runner.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/viewer/server/page_run_fixture.hpp"
#include "tests/viewer/server/view_page.hpp"

namespace {

using namespace page_run_fixture;

// Runs that are watched and steered by a page.

TEST(PageRun, SaysWhyTheRunHasEndedAndWhereItsRecordIs) {
  const test_support::ScratchFolder folder;
  const std::string record = folder.file("run.lcm");
  const auto has_ended = [](const web_test::Json& status) { return !status["ended"].is_null(); };
  PageRun run(record);
  run.end();
  const auto status = run.page->text("status", has_ended);
  EXPECT_EQ(status["ended"], "duration");
  EXPECT_EQ(status["log"], record);
  // Also a run that fails.
  std::string too_fast = falling;
  too_fast.insert(too_fast.find("step_s"), "max_speed_mps: 10, ");
  PageRun failed("", too_fast);
  failed.end();
  const auto failure = failed.page->text("status", has_ended);
  EXPECT_THAT(failure["ended"].get<std::string>(), testing::MatchesRegex("fault: .*ball.*"));
  EXPECT_FALSE(failure.contains("log"));
}

TEST(PageRun, ARewindFromThePageGivesTheRunThatNeverWentBackAndReplaysEqual) {
  const test_support::ScratchFolder folder;
  PageRun run(folder.file("run.lcm"));
  run.step(200, 200);
  run.page->control("rewind", 1);
  EXPECT_EQ(run.page->reply()["ok"], true);
  run.page->text("status", [](const web_test::Json& status) { return status["step"] == 100 && status["branch"] == 1; });
  run.end();
  const experiment::Summary plain = plain_run();
  EXPECT_EQ(run.summary.run_hash, plain.run_hash);
  EXPECT_EQ(run.summary.state_hash, plain.state_hash);
  for (const char* record : {"run.lcm", "run.branch1.lcm"}) {
    experiment::ReplayOptions options;
    options.log = folder.file(record);
    options.quiet = true;
    EXPECT_EQ(experiment::replay(options).exit_code(), 0) << record;
  }
}

/// Heights of the ball in the messages on sim.bodies.
double ball_m(const test::ViewMessage& message) {
  return message.header["fields"]["position_m"][0][2].get<double>();
}

TEST(PageRun, AfterARewindThePageGetsTheMessagesOfTheBranchThatItIsOn) {
  PageRun run;
  run.page->subscribe("sim.bodies");
  run.step(300, 300);
  // To 1.5 s: the last message at or before it, of the run that fell so far.
  const auto message_at = [&](double t_s) {
    return run.page->message([&](const test::ViewMessage& message) {
      return static_cast<double>(message.time_us) <= 1e6 * t_s &&
             static_cast<double>(message.time_us) > 1e6 * t_s - 1e5;
    });
  };
  run.page->control("rewind", 1.5);
  const test::ViewMessage first = message_at(1.5);
  EXPECT_NEAR(ball_m(first), height_m(1e-6 * static_cast<double>(first.time_us)), 1e-4);
  EXPECT_EQ(first.header["fields"]["branch"], 0);
  // On the new branch the ball is 300 m high.
  run.page->control("do", 0, "{move: {name: ball, position_m: [1, 2, 300]}}");
  EXPECT_EQ(run.page->reply()["ok"], true);
  run.page->control("step", 100);
  EXPECT_GT(ball_m(message_at(2.5)), 250);
  // Back to a time that both branches have: it gets that of its own.
  run.page->control("rewind", 0.5);
  const test::ViewMessage second = message_at(2);
  EXPECT_GT(ball_m(second), 250);
  EXPECT_EQ(second.header["fields"]["branch"], 1);
}

/// With two paths, after one and after two seconds.
const std::string planned =
    falling +
    "events:\n"
    "  - {name: near, at: 1, do: [{publish: {channel: ball.path, type: shoal.waypoints_command_t, value: {x_m: [0, "
    "4],\n"
    "     y_m: [1, 1], depth_m: [.nan, .nan]}}}]}\n"
    "  - {name: far, at: 2, do: [{publish: {channel: ball.path, type: shoal.waypoints_command_t, value: {x_m: [0, 9],\n"
    "     y_m: [1, 1], depth_m: [3, 3], loop: true}}}]}\n";

TEST(PageRun, ShowsThePathsThatHold) {
  PageRun run("", planned);
  const auto paths_in_steps_to = [&](std::int64_t step) {
    run.page->control("step", 150);
    auto paths = run.page->text("paths");
    run.page->text("status", [&](const web_test::Json& status) { return status["step"] == step; });
    return paths;
  };
  const auto near = paths_in_steps_to(150);
  ASSERT_EQ(near["items"].size(), 1u);
  EXPECT_EQ(near["items"][0]["channel"], "ball.path");
  EXPECT_EQ(near["items"][0]["vehicle"], "ball");
  EXPECT_EQ(near["items"][0]["points"], web_test::Json::parse("[[0.0, 1.0, null], [4.0, 1.0, null]]"));
  EXPECT_EQ(near["items"][0]["loop"], false);
  const auto far = paths_in_steps_to(300);
  EXPECT_EQ(far["items"][0]["points"][1], web_test::Json::parse("[9.0, 1.0, 3.0]"));
  EXPECT_EQ(far["items"][0]["loop"], true);
  // A page that comes later has it too.
  test::ViewPage late(run.url);
  EXPECT_EQ(late.text("paths")["items"][0]["points"][1][0], 9);
  // Back at 1.5 s the first one holds again, at 0.5 s none.
  run.page->control("rewind", 1.5);
  EXPECT_EQ(run.page->text("paths")["items"][0]["points"][1][0], 4);
  run.page->control("rewind", 1);
  EXPECT_EQ(run.page->text("paths")["items"].size(), 0u);
}

/// Returns the count of a channel, of the next counts at a time.
std::int64_t count_at(test::ViewPage& page, const std::string& channel, std::int64_t time_us) {
  const auto channels =
      page.text("channels", [&](const web_test::Json& message) { return message["time_us"] == time_us; });
  for (const web_test::Json& item : channels["items"])
    if (item["name"] == channel) return item["count"];
  return 0;
}

TEST(PageRun, ARewindTakesTheCountsOfMessagesBack) {
  PageRun run;
  test::ViewPage& page = *run.page;
  page.control("step", 200);
  const std::int64_t first = count_at(page, "sim.bodies", 2'000'000);
  page.control("step", 100);
  const std::int64_t second = count_at(page, "sim.bodies", 3'000'000);
  EXPECT_GT(second, first);
  page.control("rewind", 1);
  EXPECT_EQ(count_at(page, "sim.bodies", 2'000'000), first);
  page.control("step", 100);
  EXPECT_EQ(count_at(page, "sim.bodies", 3'000'000), second);
}

TEST(PageRun, APageThatConnectsLateGetsTheEarlierEvents) {
  PageRun run;
  run.page->control("do", 0, "{add: {object: {name: box, position_m: [5, 0, 1], parts: [{shape: box, mass_kg: 1}]}}}");
  run.page->control("step", 10);
  const auto first = run.page->text("events", [](const web_test::Json& events) { return !events.contains("all"); });
  EXPECT_EQ(first["items"][0]["who"], "box");
  test::ViewPage late(run.url);
  const auto events = late.text("events");
  EXPECT_EQ(events["all"], true);
  EXPECT_EQ(events["dropped"], 0);
  ASSERT_EQ(events["items"].size(), 1u);
  EXPECT_EQ(events["items"][0], first["items"][0]);
}

}  // namespace
