// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <future>
#include <thread>

#include "experiment/replay/replay.hpp"
#include "experiment/run/runner.hpp"
#include "messages/yaml/message_writer.hpp"
#include "tests/experiment/replay/replay_fixture.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/viewer/server/view_page.hpp"
#include "viewer/server/run_view.hpp"

// Runs that are watched and steered by a page.

namespace {

using testing::HasSubstr;

/// A ball that falls from 100 m, in steps of 10 ms.
const std::string falling =
    "shoal: 1\nname: fall\nrun: {duration_s: 4, hash_every_steps: 10}\nphysics: {step_s: 0.01}\nobjects: [{name: ball, "
    "position_m: [1, 2, 100], parts: [{shape: sphere, mass_kg: 1}]}]\n";

float height_m(double t_s) {  // the step is exact for constant gravity
  return static_cast<float>(100 - 9.80665 * t_s * t_s / 2);
}

/// A run in another thread, paused, with a page.
class PageRun {
 public:
  explicit PageRun(const std::string& record = "", const std::string& world = falling) {
    loaded_ = sim::load_world_text(world, "worlds/test.yaml", test::LoadedTestWorld::with_messages({}));
    options_.bus = "none";
    options_.quiet = options_.paused = true;
    options_.speed = 0;
    options_.record = record;
    view_.port = 0;
    options_.page = viewer::run_page(view_);
    std::promise<std::string> address;
    auto opened = address.get_future();
    view_.opened = [&address](const std::string& text) { address.set_value(text); };
    thread_ = std::thread([this] { summary = experiment::run_world(loaded_, options_); });
    url = opened.get();
    page = std::make_unique<test::ViewPage>(url);
  }
  ~PageRun() { end(); }
  /// Steps, and waits until it is done.
  void step(int count, std::int64_t to_step) {
    page->control("step", count);
    page->text("status", [&](const web_test::Json& status) { return status["step"] == to_step; });
  }
  /// Runs to the end.
  void end() {
    if (!thread_.joinable()) return;
    page->control("resume");
    thread_.join();
  }

  experiment::Summary summary;
  std::string url;
  std::unique_ptr<test::ViewPage> page;

 private:
  sim::LoadedWorld loaded_;
  experiment::RunOptions options_;
  experiment::ViewOptions view_;
  std::thread thread_;
};

experiment::Summary plain_run() {
  const auto loaded = sim::load_world_text(falling, "worlds/test.yaml", test::LoadedTestWorld::with_messages({}));
  experiment::RunOptions options;
  options.bus = "none";
  options.quiet = true;
  options.speed = 0;
  return experiment::run_world(loaded, options);
}

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

TEST(PageRun, ALookShowsThePastAndDoesNotTouchTheRun) {
  PageRun run;
  run.step(200, 200);
  for (const double t_s : {0.0, 0.5, 1.3, 1.95, 7.0}) {
    const test::ViewState state = run.page->look(1e6 * t_s);
    const double kept_s = std::min(2.0, std::floor(10 * t_s + 1e-9) / 10);
    EXPECT_NEAR(static_cast<double>(state.time_us), 1e6 * kept_s, 1) << t_s;
    EXPECT_NEAR(state.z_m, height_m(kept_s), 1e-4) << t_s;
    EXPECT_EQ(state.count, 1u);
  }
  run.end();
  EXPECT_EQ(run.summary.run_hash, plain_run().run_hash);
}

TEST(PageRun, RefusesALookThatIsNotOne) {
  PageRun run;
  for (const auto& [request, why] : std::vector<std::pair<web_test::Json, std::string>>{
           {{{"op", "look"}}, "look: 'time_us' is missing"},
           {{{"op", "look"}, {"time_us", "x"}}, "look: 'time_us' must be null or a number from -1e18 to 1e18, got"},
           {{{"op", "look"}, {"time_us", 1e300}}, "must be null or a number from -1e18 to 1e18, got 1e+300"},
           {{{"op", "look"}, {"time_us", 0}, {"branch", -1}}, "look: 'branch' must be the number of a branch, got -1"},
           {{{"op", "look"}, {"time_us", 0}, {"branch", 7}}, "look: there is no branch 7"}}) {
    run.page->send(request);
    EXPECT_THAT(run.page->text("error")["text"].get<std::string>(), HasSubstr(why));
  }
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

TEST(PageRun, ListsItsBranchesAndWhereTheyDiffer) {
  const test_support::ScratchFolder folder;
  PageRun run(folder.file("run.lcm"));
  run.step(300, 300);
  run.page->control("rewind", 1.5);
  run.page->text("branches", [](const web_test::Json& message) { return message["present"] == 1; });
  // At 1.5 s the ball is moved; it falls on from there.
  run.page->control("do", 0, "{move: {name: ball, position_m: [1, 2, 300]}}");
  const web_test::Json moved = run.page->reply();
  EXPECT_EQ(moved["ok"], true) << moved;
  run.step(100, 250);
  const web_test::Json list = run.page->text("branches", [](const web_test::Json& message) {
    return message["items"].size() == 2 && !message["items"][0]["differs_us"].is_null();
  });
  EXPECT_EQ(list["by"], "poses");
  EXPECT_EQ(list["items"][0]["end_us"], 3'000'000);
  EXPECT_EQ(list["items"][1]["parent"], 0);
  EXPECT_EQ(list["items"][1]["start_us"], 1'500'000);
  EXPECT_EQ(list["items"][0]["differs_us"], 1'600'000) << "the first state that is kept after it";
  // Both at the same time: the record of the branch that was left, and the present one.
  EXPECT_NEAR(run.page->look(2e6, 0).z_m, height_m(2), 1e-4);
  EXPECT_GT(run.page->look(2e6, 1).z_m, 250);
  EXPECT_NEAR(run.page->look(1e6, 1).z_m, height_m(1), 1e-4) << "the past that they share";
  run.end();
  experiment::ReplayOptions options;
  options.log = folder.file("run.branch1.lcm");
  options.quiet = true;
  EXPECT_EQ(experiment::replay(options).exit_code(), 0) << "a run steered by a page";
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
