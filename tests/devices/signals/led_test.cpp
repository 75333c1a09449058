// SPDX-License-Identifier: BSD-3-Clause
#include "devices/signals/led.hpp"

#include <gmock/gmock.h>

#include "shoal/led_t.hpp"
#include "sim/image/image.hpp"
#include "tests/devices/state_fixture.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A hull with two lamps; the second one has a red and a green light.
std::string lamp_world(const std::string& devices, const std::string& more = "") {
  return R"(shoal: 1
physics: {step_s: 0.01, gravity_mps2: 0}
vehicles:
  - name: r1
    model:
      shoal: 1
      vehicle: lamps
      bodies:
        - name: hull
          parts:
            - {name: box, shape: box, size_m: [0.6, 0.4, 0.2], mass_kg: 1}
            - {name: one, shape: box, size_m: [0.1, 0.1, 0.1], position_m: [0.2, 0, 0.1], color: "#123456"}
            - {name: two, shape: box, size_m: [0.1, 0.1, 0.1], position_m: [-0.2, 0, 0.1]}
      devices:
        - {name: imu, type: imu}
)" + devices +
         more;
}

const char* const lamps =
    "        - {name: led, type: led, off_color: \"#000000\", lights: [{name: white, parts: [hull/one]}, "
    "{name: red, parts: [hull/two], color: \"#ff0000\"}, {name: green, parts: [hull/two], color: \"#00ff00\"}]}\n";

shoal::led_t command(const std::vector<std::pair<std::string, double>>& lights) {
  shoal::led_t message{};
  for (const auto& [light, intensity] : lights) {
    message.light.push_back(light);
    message.intensity.push_back(intensity);
  }
  message.count = static_cast<std::int32_t>(lights.size());
  return message;
}

std::optional<sim::Color> color_of(const test::LoadedTestWorld& test, const std::string& part) {
  const sim::PhysicsWorld& physics = test.world.physics();
  const auto number = physics.find_part(test.world.find_vehicle("r1")->group(), part);
  return physics.parts()[static_cast<std::size_t>(number.value())].color;
}

TEST(Led, ShowsTheSumOfTheLightsOfAPart) {
  test::TestWorld test(lamp_world(lamps));
  test::Listener<shoal::led_t> reports(test, "r1.led");
  test.send("r1.led.cmd", command({{"red", 1}, {"green", 0.5}}));
  test.run_for(0.1);
  // Half of the light is level 188 of sRGB, (0.5^(1/2.4) * 1.055 - 0.055) * 255.
  EXPECT_THAT(color_of(test, "hull/two").value(), ElementsAre(255, 188, 0));
  EXPECT_THAT(color_of(test, "hull/one").value(), ElementsAre(0, 0, 0)) << "a light of the same device that is off";
  const shoal::led_t report = reports.last();
  EXPECT_THAT(report.light, ElementsAre("white", "red", "green"));
  EXPECT_THAT(report.intensity, ElementsAre(0, 1, 0.5));
  EXPECT_THAT(report.part, ElementsAre("hull/one", "hull/two"));
  EXPECT_THAT(report.color, ElementsAre(0, 255 * 65536 + 188 * 256));
}

TEST(Led, APartThatALightNamesTwiceShowsItOnce) {
  test::TestWorld test(
      lamp_world("        - {name: led, type: led, off_color: \"#000000\", lights: [{name: white, parts: [hull/two, "
                 "hull/two]}]}\n"));
  test.send("r1.led.cmd", command({{"white", 0.5}}));
  test.run_for(0.1);
  EXPECT_THAT(color_of(test, "hull/two").value(), ElementsAre(188, 188, 188));
}

TEST(Led, UntilItsFirstCommandPartsKeepTheirColorsAndNothingIsReported) {
  test::TestWorld test(lamp_world(lamps));
  test::Listener<shoal::led_t> reports(test, "r1.led");
  test.run_for(0.5);
  EXPECT_THAT(color_of(test, "hull/one").value(), ElementsAre(0x12, 0x34, 0x56));
  EXPECT_EQ(color_of(test, "hull/two"), std::nullopt);
  EXPECT_TRUE(reports.take_all().empty());
}

TEST(Led, IsNoPartOfHashesUntilItsFirstCommand) {
  const auto hashes = [](const std::string& devices, bool is_commanded) {
    test::TestWorld test(lamp_world(devices));
    if (is_commanded) test.send("r1.led.cmd", command({{"red", 1}}));
    test.run_for(1);
    const std::uint64_t state = test.world.state().hash();
    return std::pair(state, test.world.state().run_hash(state));
  };
  EXPECT_EQ(hashes(lamps, false), hashes("", false));
  EXPECT_NE(hashes(lamps, true), hashes("", false));
}

TEST(Led, ShowsInASnapshotWhatItShowed) {
  test::TestWorld test(lamp_world(lamps));
  const sim::Bytes before = test.world.state().snapshot();
  test.send("r1.led.cmd", command({{"white", 1}}));
  test.run_for(0.1);
  const sim::Bytes lit = test.world.state().snapshot();
  test.world.state().restore(before);
  EXPECT_THAT(color_of(test, "hull/one").value(), ElementsAre(0x12, 0x34, 0x56));
  test.world.state().restore(lit);
  EXPECT_THAT(color_of(test, "hull/one").value(), ElementsAre(255, 255, 255));
}

TEST(Led, ContinuesAlikeFromASnapshot) {
  test::SavedRun run(lamp_world(lamps, R"(events:
  - {name: on, at: 0.2, do: [{publish: {channel: r1.led.cmd, type: shoal.led_t, value: {light: [red], intensity: [0.3]}}}]}
)"));
  run.expect_restored_worlds_go_on_alike({0, 10, 40}, 100);
}

TEST(Led, IsDarkWithoutPower) {
  test::TestWorld test(
      lamp_world("        - {name: battery, type: battery, capacity_Wh: 0.001, power_W: 36}\n" + std::string(lamps)));
  test.send("r1.led.cmd", command({{"white", 1}}));
  test.run_for(0.05);
  EXPECT_THAT(color_of(test, "hull/one").value(), ElementsAre(255, 255, 255));
  test.run_for(0.2);  // 0.001 W h last 0.1 s
  EXPECT_THAT(color_of(test, "hull/one").value(), ElementsAre(0, 0, 0));
}

TEST(Led, IgnoresBadCommandsAsAWhole) {
  test::TestWorld test(lamp_world(lamps));
  test.send("r1.led.cmd", command({{"red", 1}, {"gren", 1}}));
  test.send("r1.led.cmd", command({{"red", 1}, {"green", 1.5}}));
  test.run_for(0.1);
  EXPECT_EQ(color_of(test, "hull/two"), std::nullopt);
  EXPECT_EQ(test.world.counts().bad_messages, 2);
}

TEST(Led, SaysWhatIsWrongWithItsParameters) {
  const auto error = [](const std::string& keys) {
    return test::error_of_world(lamp_world("        - {name: led, type: led" + keys + "}\n"));
  };
  EXPECT_THAT(error(""), HasSubstr("missing key 'lights'"));
  EXPECT_THAT(error(", lights: [{name: a, parts: [hull/oen]}]"), HasSubstr("hull/oen"));
  EXPECT_THAT(error(", lights: [{name: a, color: red}]"), HasSubstr("'color' must look like #rrggbb, got 'red'"));
  EXPECT_THAT(error(", lights: [{name: a}, {name: a}]"), HasSubstr("'lights' names 'a' twice"));
}

}  // namespace
