// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/forms_text.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/experiment/replay/replay_fixture.hpp"
#include "tests/viewer/server/page_drive_fixture.hpp"
#include "viewer/server/page_drive.hpp"

namespace {

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
