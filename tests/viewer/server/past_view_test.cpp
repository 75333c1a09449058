// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "experiment/replay/replay.hpp"
#include "experiment/run/runner.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/viewer/server/page_run_fixture.hpp"
#include "tests/viewer/server/view_page.hpp"

namespace {

using namespace page_run_fixture;

using testing::HasSubstr;

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

}  // namespace
