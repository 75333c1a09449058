// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "sim/director/script.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/director/event_worlds.hpp"

namespace {

using namespace event_worlds;

sim::ConfigNode yaml(const std::string& text) {
  sim::Diagnostics diagnostics;
  sim::ConfigNode node = sim::parse_config_text(text, "request", diagnostics);
  diagnostics.throw_if_any();
  return node;
}

std::string failure(sim::World& world, const std::string& action) {
  try {
    world.editor().run_action(yaml(action));
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
  return "none";
}

TEST(RunAction, DoesInAWorldWithoutEventsWhatAnEventDoes) {
  test::TestWorld test(test::rover_world(drive));
  test.world.editor().run_action(
      yaml("{add: {object: {name: post, fixed: true, position_m: [3, 0, 0], parts: [{shape: box}]}}}"));
  EXPECT_NE(test.world.find_object("post"), nullptr);
  test.world.editor().run_action(yaml("[{move: {name: r1, position_m: [1, 1, 0.1]}}, {remove: post}]"));
  EXPECT_EQ(test.world.find_object("post"), nullptr);
  EXPECT_NEAR(test.world.vehicles()[0]->X_WV().translation().x(), 1, 1e-12);
}

TEST(RunAction, SaysWhatIsWrongInOneLine) {
  test::TestWorld test(test::rover_world(drive));
  EXPECT_EQ(
      failure(test.world, "{move: {name: r2, position_m: [0, 0, 0]}}"),
      "request:1:15: action 1: move: 'name' names no vehicle or object 'r2'; known vehicles or objects: ground, r1");
  EXPECT_EQ(failure(test.world, "{fault: {device: r1/drve, kind: dead}}"),
            "request:1:1: action 1: there is no device 'r1/drve'; devices are named VEHICLE/DEVICE; vehicle 'r1' has: "
            "drive");
  EXPECT_THAT(failure(test.world, "{dance: r1}"),
              testing::HasSubstr("unknown action 'dance'; known actions: actor, add"));
  EXPECT_THAT(failure(test.world, "{mve: r1}"), testing::HasSubstr("; did you mean 'move'?"));
  EXPECT_THAT(failure(test.world, "{set: {device: r1/drive, values: {body: x}}}"),
              testing::HasSubstr("'body' cannot change while the device runs"));
  EXPECT_THAT(failure(test.world, "{publish: {channel: x, type: shoal.twist_command_t, value: {forward: 1}}}"),
              testing::HasSubstr("shoal.twist_command_t: unknown member 'forward'"));
  EXPECT_THAT(failure(test.world, "{publish: {channel: r1.drive.cmd, type: shoal.gps_data_t}}"),
              testing::AllOf(testing::HasSubstr("device 'r1/drive' takes shoal.twist_command_t"),
                             testing::HasSubstr("on 'r1.drive.cmd', not 'shoal.gps_data_t'")));
}

}  // namespace
