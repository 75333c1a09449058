// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/touch.hpp"

#include <gmock/gmock.h>

#include "shoal/touch_t.hpp"
#include "tests/devices/state_fixture.hpp"

namespace {

using testing::HasSubstr;

/// A box of 1 kg that stands on a plate: 10 N press on its lower side.
std::string touch_world(const std::string& keys, const std::string& at = "[0, 0, 0.1]", const std::string& more = "") {
  return R"(shoal: 1
physics: {step_s: 0.002, gravity_mps2: 10}
objects:
  - {name: ground, fixed: true, parts: [{shape: plane}]}
vehicles:
  - name: r1
    position_m: )" +
         at + R"(
    model:
      shoal: 1
      vehicle: box
      bodies: [{name: hull, parts: [{shape: box, size_m: [0.6, 0.4, 0.2], mass_kg: 1}]}]
      devices:
        - {name: touch, type: touch)" +
         keys + "}\n" + more;
}

shoal::touch_t press(double pressure) {
  shoal::touch_t message{};
  message.pressure = pressure;
  return message;
}

TEST(Touch, PressureIsTheShareOfTheFullForce) {
  test::TestWorld test(touch_world(", full_force_N: 20"));
  test::Listener<shoal::touch_t> reports(test, "r1.touch");
  test.run_for(1);
  const auto report = reports.last();
  EXPECT_EQ(report.touched, 1);
  EXPECT_NEAR(report.pressure, 0.5, 0.01);  // at rest the four contacts carry 10 N
}

TEST(Touch, FeelsAHandByCommandUntilItLetsGo) {
  test::TestWorld test(touch_world("", "[0, 0, 50]"));  // in the air: it touches nothing
  test::Listener<shoal::touch_t> reports(test, "r1.touch");
  test.run_for(0.1);
  EXPECT_TRUE(reports.take_all().empty());
  test.send("r1.touch.cmd", press(0.25));
  test.run_for(0.1);
  test.send("r1.touch.cmd", press(0));
  test.run_for(0.1);
  const auto all = reports.take_all();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].pressure, 0.25);
  EXPECT_EQ(all[0].touched, 1);
  EXPECT_EQ(all[1].pressure, 0);
  EXPECT_EQ(all[1].touched, 0);
}

TEST(Touch, IsPressedFullyByAHandThatOnlyTouches) {
  test::TestWorld test(touch_world("", "[0, 0, 50]"));
  test::Listener<shoal::touch_t> reports(test, "r1.touch");
  shoal::touch_t hand = press(0);
  hand.touched = 1;
  test.send("r1.touch.cmd", hand);
  test.run_for(0.1);
  EXPECT_EQ(reports.last().pressure, 1);
}

TEST(Touch, ContinuesAlikeFromASnapshot) {
  test::SavedRun run(touch_world("", "[0, 0, 0.2]", R"(events:
  - {name: hand, at: 0.5, do: [{publish: {channel: r1.touch.cmd, type: shoal.touch_t, value: {pressure: 0.3}}}]}
)"));
  run.expect_restored_worlds_go_on_alike({0, 60, 300}, 150);
}

TEST(Touch, IgnoresBadCommandsAndContinues) {
  test::TestWorld test(touch_world("", "[0, 0, 50]"));
  test::Listener<shoal::touch_t> reports(test, "r1.touch");
  test.send("r1.touch.cmd", press(1.5));
  test.send("r1.touch.cmd", press(-0.1));
  test.run_for(0.1);
  EXPECT_EQ(test.world.counts().bad_messages, 2);
  EXPECT_TRUE(reports.take_all().empty());
}

TEST(Touch, SaysWhatIsWrongWithItsParameters) {
  EXPECT_THAT(test::error_of_world(touch_world(", full_force_N: 0")), HasSubstr("'full_force_N' must be > 0, got 0"));
  EXPECT_THAT(test::error_of_world(touch_world(", parts: [hull/back]")), HasSubstr("hull/back"));
}

}  // namespace
