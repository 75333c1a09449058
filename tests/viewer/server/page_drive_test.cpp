// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/page_drive.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "experiment/drive/drive_profile.hpp"
#include "tests/experiment/replay/replay_fixture.hpp"
#include "tests/viewer/server/page_drive_fixture.hpp"

namespace {

using namespace page_drive_fixture;
using namespace std::chrono_literals;

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::string refusal(const std::string& text) {
  try {
    viewer::PageDrive::read(text);
  } catch (const experiment::DriveError& error) {
    return error.what();
  }
  return "";
}

TEST_F(PageDriveTest, StopsAFifthOfASecondAfterTheLastMessage) {
  const test::RecordedRun run(test::driven_world(), log);
  drive.take(1, ahead(0.5), run.world, start);
  EXPECT_THAT(speeds(run.world, 0ms), ElementsAre(0.5));
  EXPECT_THAT(speeds(run.world, 199ms), ElementsAre(0.5));
  EXPECT_THAT(speeds(run.world, 200ms), ElementsAre(0));
}

TEST_F(PageDriveTest, StopsAtOnceWhenThePageLetsGoOrLeaves) {
  const test::RecordedRun run(test::driven_world(), log);
  drive.take(1, ahead(0.5), run.world, start);
  EXPECT_THAT(speeds(run.world, 0ms), ElementsAre(0.5));
  drive.take(1, {"r1", "twist", {}}, run.world, start + 10ms);
  EXPECT_THAT(speeds(run.world, 10ms), ElementsAre(0));
  drive.take(1, ahead(0.5), run.world, start + 20ms);
  EXPECT_THAT(speeds(run.world, 20ms), ElementsAre(0.5));
  drive.left(2);
  EXPECT_THAT(speeds(run.world, 70ms), ElementsAre(0.5));
  drive.left(1);
  EXPECT_THAT(speeds(run.world, 80ms), ElementsAre(0));
}

TEST_F(PageDriveTest, CommandsNothingWhileTheRunIsPaused) {
  const test::RecordedRun run(test::driven_world(), log);
  drive.take(1, ahead(0.5), run.world, start);
  EXPECT_THAT(speeds(run.world, 0ms), ElementsAre(0.5));
  EXPECT_THAT(speeds(run.world, 10ms, true), ElementsAre(0));
  drive.take(1, ahead(0.5), run.world, start + 20ms);
  EXPECT_THAT(speeds(run.world, 100ms, true), Not(Contains(0.5)));
}

TEST_F(PageDriveTest, OnePageDrivesAVehicle) {
  const test::RecordedRun run(test::driven_world(), log);
  EXPECT_EQ(refused(1, ahead(0.5), run.world, 0ms), "");
  EXPECT_EQ(refused(2, ahead(1), run.world, 10ms), "vehicle 'r1' is driven by another page");
  // After the first has let go and the vehicle has its safe commands, the other may.
  drive.take(1, {"r1", "twist", {}}, run.world, start + 20ms);
  for (const auto at : {20ms, 70ms, 120ms}) EXPECT_THAT(speeds(run.world, at), ElementsAre(0));
  EXPECT_EQ(refused(2, ahead(1), run.world, 130ms), "");
  EXPECT_THAT(speeds(run.world, 130ms), ElementsAre(1));
}

TEST_F(PageDriveTest, RefusesWhatAVehicleCannot) {
  const test::RecordedRun run(test::driven_world(), log);
  EXPECT_EQ(refused(1, {"r9", "", {{"forward", 1}}}, run.world, 0ms), "there is no vehicle 'r9' to drive");
  EXPECT_EQ(refused(1, {"r1", "fly", {{"forward", 1}}}, run.world, 0ms),
            "'kind' of drive must be twist, tilt, helm, thrust or joints, got 'fly'");
  EXPECT_THAT(refused(1, {"r1", "helm", {{"forward", 1}}}, run.world, 0ms), HasSubstr("cannot be driven by 'helm'"));
  EXPECT_EQ(refused(1, {"r1", "twist", {{"dive", 1}}}, run.world, 0ms), "vehicle 'r1' has no axis 'dive'");
}

TEST_F(PageDriveTest, RefusesMessagesThatAreWrong) {
  EXPECT_EQ(refusal(R"({"vehicle": 3})"), "'vehicle' of drive must be a text");
  EXPECT_EQ(refusal(R"({"vehicle": "a", "values": [1]})"),
            "'values' of drive must be an object with at most 100 numbers");
  EXPECT_EQ(refusal(R"({"vehicle": "a", "values": {"forward": 2}})"),
            "'values.forward' of drive must be a number from -1 to 1");
  EXPECT_EQ(refusal(R"({"vehicle": "a", "values": {"forward": "x"}})"),
            "'values.forward' of drive must be a number from -1 to 1");
  EXPECT_EQ(refusal("[]"), "drive must be a JSON object");
  EXPECT_EQ(refusal(R"({"vehicle": "a", "values": {"forward": -1}})"), "");
}

TEST_F(PageDriveTest, ADrivenRunReplaysEqual) {
  double x_m = 0;
  {
    test::RecordedRun run(test::driven_world(), log);
    run.run(test::steps, [&](std::int64_t step) {
      // A page drives for a second and a half, 20 messages per second, and goes.
      const auto now = start + step * 10ms;
      if (step < 150 && step % 5 == 0) drive.take(1, ahead(0.01 * static_cast<double>(step % 100)), run.world, now);
      if (step == 150) drive.left(1);
      drive.run(run.world, now, false, [&](const std::string&, const std::string& channel, auto payload) {
        run.network.publish(channel, payload, run.world.now());
      });
    });
    x_m = run.world.find_vehicle("r1")->X_WV().translation().x();
  }
  EXPECT_GT(x_m, 0.2);
  const experiment::ReplayOutcome outcome = again();
  EXPECT_EQ(outcome.exit_code(), 0) << outcome.to_text();
  EXPECT_EQ(outcome.steps, test::steps);
}

using namespace page_drive_fixture;
using namespace std::chrono_literals;

using Json = nlohmann::json;

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::Not;

TEST_F(PageDriveTest, FormsTellWhatTheWorldTakes) {
  const test::RecordedRun run(test::driven_world("events: [{name: storm, do: [{log: now}]}]\n"), log);
  const Json forms = Json::parse(viewer::forms_text(run.world, drive.profile()));
  EXPECT_EQ(forms["op"], "forms");
  EXPECT_EQ(forms["events"], Json({"storm"}));
  EXPECT_EQ(forms["objects"], Json({"crate", "ground"}));
  EXPECT_EQ(forms["drives"]["r1"][0], Json({{"kind", "twist"}, {"axes", {"forward", "turn"}}}));
  // Only an actuator can be dead, only a device with noise can be biased.
  const auto faults = [&](const char* type) { return forms["types"][type]["faults"].get<std::vector<std::string>>(); };
  EXPECT_THAT(faults("lidar"), AllOf(Contains("biased"), Not(Contains("dead"))));
  EXPECT_THAT(faults("differential_drive"), AllOf(Contains("dead"), Contains("partial"), Not(Contains("biased"))));
  // Each action has its main key first.
  ASSERT_FALSE(forms["actions"].empty());
  for (const Json& action : forms["actions"]) EXPECT_EQ(action["keys"][0]["key"], action["main"]) << action["word"];
}

TEST_F(PageDriveTest, FormsOfferToDriveTheSegwayThroughItsProgram) {
  const test::RecordedRun run("shoal: 1\nvehicles: [{name: segway1, file: segway_rmp.yaml}]\n", log);
  const Json forms = Json::parse(viewer::forms_text(run.world, drive.profile()));
  EXPECT_EQ(forms["drives"]["segway1"][0], Json({{"kind", "twist"}, {"axes", {"forward", "turn"}}}));
  drive.take(1, {"segway1", "", {{"forward", 1}}}, run.world, start);
  std::vector<std::string> channels;
  drive.run(run.world, start, false,
            [&](const std::string&, const std::string& channel, auto) { channels.push_back(channel); });
  EXPECT_THAT(channels, ElementsAre("segway1.balance.cmd"));
}

}  // namespace
