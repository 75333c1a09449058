// SPDX-License-Identifier: BSD-3-Clause
// Every device of the registry in its own world, which is written here from what the device says of itself: a new
// device is tested without a word about it.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "sim/device/device_registry.hpp"
#include "tests/devices/state_fixture.hpp"
#include "tests/sim/config/parse.hpp"

namespace {

/// The keys of a device of this type on the vehicle below: its example, or joints for the names that it needs; and some
/// of each kind of noise for each of its quantities.
std::string keys_of(const sim::DeviceType& type) {
  const std::vector<std::string> joints = {"left", "right"};
  std::vector<sim::ParamInfo> table;
  sim::ParamReader in(table);
  type.make_params()->read(in);
  std::string keys = type.example.empty() ? "" : ", " + type.example;
  std::size_t named = 0;
  for (const sim::ParamInfo& info : table) {
    for (const sim::ParamInfo& child : info.children)
      if (child.key == "gauss_markov_std" && type.quantities().size() > 0)
        keys += ", " + info.key + ": {gaussian_std: 1e-3, gauss_markov_std: 1e-3, bias_std: 1e-3}";
    if (!info.required || !type.example.empty()) continue;
    const std::string& joint = joints[named++ % joints.size()];
    if (info.rule == "name of a joint")
      keys += ", " + info.key + ": " + joint;
    else if (info.rule == "names of joints")
      keys += ", " + info.key + ": [" + joint + "]";
    else
      ADD_FAILURE() << type.name << " needs '" << info.key << "': its model must have an `example`";
  }
  return keys;
}

/// A vehicle with wheels and a thruster, on the bottom of a sea, beside another one that it can receive and see.
std::string world_with(const sim::DeviceType& type) {
  const std::string wheel = "parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1, displaces: false}]}\n";
  std::string text = R"(
shoal: 1
physics: {step_s: 0.005}
medium: {water: {}}
objects:
  - {name: bottom, fixed: true, position_m: [0, 0, -5.1], parts: [{shape: plane}]}
vehicles:
  - name: other
    position_m: [6, 1, -4.7]
    model:
      shoal: 1
      vehicle: other
      bodies: [{name: base, parts: [{shape: box, size_m: [1, 1, 0.4], mass_kg: 4000}]}]
      devices:
        - {name: radio, type: modem}
        - {name: sound, type: acoustic_modem}
        - {name: answers, type: transponder}
        - {name: beacon, type: range_beacon, beacon_only: true}
  - name: tested
    position_m: [0, 0, -5]
    model:
      shoal: 1
      vehicle: tested
      bodies:
        - {name: base, position_m: [0, 0, 0.1], parts: [{shape: box, size_m: [0.8, 0.3, 0.1], mass_kg: 60}]}
        - {name: ghost, kinematic: true, position_m: [0, 0, 2], parts: [{shape: sphere, radius_m: 0.1}]}
        - {name: arm, position_m: [0, 0, 0.4], parts: [{shape: box, size_m: [0.1, 0.1, 0.3], mass_kg: 1}]}
)";
  const std::pair<const char*, const char*> wheels[] = {{"left", "[0, 0.3, 0]"},
                                                        {"right", "[0, -0.3, 0]"},
                                                        {"front_left", "[0.4, 0.3, 0]"},
                                                        {"front_right", "[0.4, -0.3, 0]"}};
  for (const auto& [name, place] : wheels)
    text += std::string("        - {name: ") + name + "_wheel, position_m: " + place + ", " + wheel;
  text +=
      "      joints:\n        - {name: arm, type: hinge, bodies: [base, arm], anchor_m: [0, 0, 0.2], axis: [0, 1, "
      "0]}\n";
  for (const auto& [name, place] : wheels) {
    const bool steered = std::string(name).starts_with("front");
    text += std::string("        - {name: ") + name + ", bodies: [base, " + name + "_wheel], anchor_m: " + place +
            (steered ? ", type: hinge2, axis: [0, 0, 1], low_stop: -0.6, high_stop: 0.6, axis2: {axis: [0, 1, 0]}}\n"
                     : ", type: hinge, axis: [0, 1, 0]}\n");
  }
  return text +
         "      devices:\n        - {name: radio, type: modem}\n        - {name: sound, type: acoustic_modem}\n" +
         "        - {name: arm, type: joint_servo, joint: arm}\n        - {name: group, type: joint_group}\n" +
         "        - {name: eye, type: camera, width: 16, height: 12}\n" +
         "        - {name: push, type: thruster}\n        - {name: witness, type: imu}\n" +
         "        - {name: it, type: " + type.name + keys_of(type) + "}\n";
}

class EveryDevice : public testing::TestWithParam<const sim::DeviceType*> {};

/// It works from what it says of itself, and all that it keeps goes back with the world.
TEST_P(EveryDevice, ContinuesAlikeAfterASnapshot) {
  test::SavedRun(world_with(*GetParam())).expect_restored_worlds_go_on_alike({0, 61, 300}, 150);
}

/// Its reports are of the type that it says: the bytes of each can be read with the schema of that type.
TEST_P(EveryDevice, PublishesWhatItSaysItPublishes) {
  test::TappedWorld tapped(world_with(*GetParam()));
  for (int step = 0; step < 400; ++step) tapped.world.step();
  int reports = 0;
  for (const test::TapBus::Sent& sent : tapped.bus.take()) {
    if (sent.channel != "tested.it") continue;
    ++reports;
    const shoal::MessageSchema* schema = shoal::embedded_types().find(std::string_view(GetParam()->report_message));
    ASSERT_NE(schema, nullptr) << GetParam()->report_message;
    EXPECT_EQ(shoal::validate(*schema, sent.payload, shoal::Finite::any), std::nullopt);
  }
  EXPECT_TRUE(GetParam()->reports() || reports == 0);
}

/// Each of its presets is made of its keys, inside their ranges: those that are data are YAML beside its source.
TEST_P(EveryDevice, ReadsItsPresets) {
  std::vector<sim::ParamInfo> table;
  sim::ParamReader describing(table);
  GetParam()->make_params()->read(describing);
  for (const sim::ParamInfo& info : table) {
    if (info.key != "preset") continue;
    for (const std::string& preset : info.choices) {
      const sim::ConfigNode node = test::parse("preset: " + preset);
      sim::Diagnostics diagnostics;
      sim::ParamReader in(node, GetParam()->name, diagnostics);
      GetParam()->make_params()->read(in);
      EXPECT_EQ(diagnostics.lines(), std::vector<std::string>{});
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryDevice, testing::ValuesIn(sim::DeviceRegistry::instance().all()),
                         [](const auto& test) { return test.param->name; });

}  // namespace
