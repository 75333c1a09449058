// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/load_world.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

std::string errors_of(const std::string& yaml, const sim::LoadOptions& options = {}) {
  try {
    sim::load_world_text(yaml, "worlds/test.yaml", options);
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

std::string lidar_world(const std::string& entry) {
  return test::rover_world("        - {name: lidar, type: lidar}\n", "", entry);
}

TEST(LoadWorld, OverridesChangeOneValueOfTheVehicle) {
  const auto loaded = sim::load_world_text(
      lidar_world("    overrides: {devices.lidar.rate_hz: 5, bodies.chassis.parts.hull.mass_kg: 3}\n"), "test.yaml");
  EXPECT_EQ(loaded.config.vehicles[0].config->devices[0].rate_hz, 5);
  EXPECT_EQ(loaded.config.vehicles[0].config->bodies[0].parts[0].mass_kg, 3);
}

TEST(LoadWorld, SetChangesTheWorldFromTheCommandLine) {
  const auto loaded = sim::load_world_text(
      lidar_world(""), "test.yaml", {.sets = {"run.duration_s=7", "vehicles.r1.position_m=[1, 2, 3]"}, .seed = 42});
  EXPECT_EQ(loaded.config.run.duration_s, 7);
  EXPECT_EQ(loaded.config.run.seed, 42);
  EXPECT_EQ(loaded.config.vehicles[0].X_WV.translation(), sim::Vector3d(1, 2, 3));
}

TEST(LoadWorld, SetTakesWordsAsTheFileDoes) {
  const auto loaded = sim::load_world_text(
      lidar_world(""), "test.yaml",
      {{"run.speed=max", "run.duration_s=forever", "vehicles.r1.devices.lidar.rate_hz=every_step"}, {}});
  EXPECT_EQ(loaded.config.run.speed, 0);
  EXPECT_EQ(loaded.config.run.duration_s, 0);
  EXPECT_EQ(loaded.config.vehicles[0].config->devices[0].rate_hz, 0);
  EXPECT_THAT(errors_of(lidar_world(""), {{"run.speed=0"}, {}}),
              HasSubstr("--set run.speed=0:1:1: run: 'speed' must be >= 0.001 and <= 1000000, or 'max', got 0; write "
                        "'speed: max'"));
}

/// The anchor of a joint with these keys, between a body at the origin, one at (1, 2, 3) and the world.
sim::Vector3d anchor_of(const std::string& keys) {
  const auto loaded = sim::load_world_text(
      "shoal: 1\nvehicles: [{name: v, model: {shoal: 1, vehicle: v, bodies: ["
      "{name: base, parts: [{shape: box, mass_kg: 1}]}, "
      "{name: arm, position_m: [1, 2, 3], parts: [{shape: box, mass_kg: 1}]}], joints: [{name: j, " +
          keys + "}]}}]\n",
      "test.yaml");
  return loaded.config.vehicles[0].config->joints[0].anchor_m;
}

TEST(LoadWorld, AnchorOfAJointIsTheOriginOfItsSecondBodyUnlessItIsGiven) {
  EXPECT_EQ(anchor_of("bodies: [base, arm]"), sim::Vector3d(1, 2, 3));
  EXPECT_EQ(anchor_of("bodies: [arm, base]"), sim::Vector3d(0, 0, 0));
  EXPECT_EQ(anchor_of("bodies: [arm, world]"), sim::Vector3d(1, 2, 3));
  EXPECT_EQ(anchor_of("bodies: [base, arm], anchor_m: [0, 0, 1]"), sim::Vector3d(0, 0, 1));
  EXPECT_EQ(anchor_of("bodies: [base, arm], anchor_m: [0, 0, 0]"), sim::Vector3d(0, 0, 0));
}

TEST(LoadWorld, SetReachesIntoAVehiclesFile) {
  const auto loaded = sim::load_world_text(lidar_world(""), "test.yaml", {{"vehicles.r1.devices.lidar.rate_hz=7"}, {}});
  EXPECT_EQ(loaded.config.vehicles[0].config->devices[0].rate_hz, 7);
  EXPECT_THAT(errors_of(lidar_world(""), {{"vehicles.r1.devices.lidar.rate=7"}, {}}),
              HasSubstr("--set vehicles.r1.devices.lidar.rate=7: vehicle 'r1': device 'lidar': unknown key 'rate'"));
}

TEST(LoadWorld, SetReachesOneVehicleOfACount) {
  const std::string path = "vehicles.r112.devices.lidar.rate_hz=7";
  const auto loaded = sim::load_world_text(lidar_world("    count: 12\n"), "test.yaml", {{path}, {}});
  const auto rate_hz = [](const sim::LoadedWorld& world, std::size_t index) {
    return world.config.vehicles[index].config->devices[0].rate_hz;
  };
  ASSERT_EQ(loaded.config.vehicles.size(), 12u);
  EXPECT_EQ(rate_hz(loaded, 11), 7);
  EXPECT_NE(rate_hz(loaded, 10), 7);
  EXPECT_NE(rate_hz(loaded, 0), 7);
  EXPECT_EQ(loaded.config.vehicles[0].config, loaded.config.vehicles[10].config) << "the others still share one";
  const auto again = sim::load_world_text(sim::to_yaml(loaded.resolved), "again.yaml");
  EXPECT_EQ(rate_hz(again, 11), 7);
  EXPECT_NE(rate_hz(again, 10), 7);
}

TEST(LoadWorld, WhatASingleVehicleOfACountCannotHaveIsSaid) {
  const std::string three = lidar_world("    count: 3\n");
  EXPECT_THAT(errors_of(three, {{"vehicles.r14.devices.lidar.rate_hz=7"}, {}}),
              HasSubstr("'vehicles' has no item 'r14'"));
  EXPECT_EQ(
      errors_of(three, {{"vehicles.r12.position_m=[1, 2, 3]"}, {}}),
      "--set vehicles.r12.position_m=[1, 2, 3]: vehicle 'r12': 'position_m' belongs to all vehicles of the 'count' "
      "of 'r1'; for one of them only keys of the vehicle file can be set");
  EXPECT_THAT(
      errors_of(lidar_world("    count: 3\n    overrides: {r15/devices.lidar.rate_hz: 5}\n")),
      HasSubstr("vehicle 'r1': 'overrides' names no vehicle 'r15': the vehicles of this 'count' are r11 to r13"));
  EXPECT_THAT(errors_of(lidar_world("    overrides: {r11/devices.lidar.rate_hz: 5}\n")),
              HasSubstr("'overrides' names no vehicle 'r11': a '/' is for the vehicles of a 'count'"));
}

TEST(LoadWorld, TheResolvedWorldKeepsTheSeedOfTheCommandLine) {
  const auto loaded = sim::load_world_text(lidar_world(""), "test.yaml", {.seed = 42});
  EXPECT_EQ(sim::load_world_text(sim::to_yaml(loaded.resolved), "again.yaml").config.run.seed, 42);
}

TEST(LoadWorld, VehiclesOfOneKindKeepTheContactsEachBrings) {
  const std::string world =
      "shoal: 1\nvehicles:\n"
      "  - {name: a, model: {shoal: 1, vehicle: x, materials: [{name: m1}], bodies: [{name: b, parts: [{shape: box, "
      "mass_kg: 1, material: m1}]}]}}\n"
      "  - {name: b, model: {shoal: 1, vehicle: x, materials: [{name: m2}], contacts: [{between: [m2, any], friction: "
      "0}], "
      "bodies: [{name: b, parts: [{shape: box, mass_kg: 1, material: m2}]}]}}\n";
  const auto loaded = sim::load_world_text(world, "test.yaml");
  EXPECT_EQ(loaded.config.materials.size(), 2u);
  EXPECT_EQ(loaded.config.contacts.size(), 1u);
}

TEST(LoadWorld, RefusesRatesThatNoStepCanFollow) {
  EXPECT_THAT(errors_of(test::rover_world("        - {name: l, type: lidar, rate_hz: 1e15}\n")),
              HasSubstr("'rate_hz' must be >= 1e-06 and <= 1000000"));
  EXPECT_THAT(errors_of(test::rover_world("        - {name: l, type: lidar, rate_hz: 1e-300}\n")),
              HasSubstr("'rate_hz' must be >= 1e-06 and <= 1000000, or 'every_step'"));
}

TEST(LoadWorld, RefusesTheSimulatorsOwnChannels) {
  EXPECT_THAT(errors_of(test::rover_world("        - {name: l, type: lidar, channel: sim.control}\n")),
              HasSubstr("channel 'sim.control' belongs to the simulator"));
}

TEST(LoadWorld, SetNamesWhatItCannotSet) {
  EXPECT_THAT(errors_of(lidar_world(""), {{"run.durration_s=7"}, {}}),
              HasSubstr("--set run.durration_s=7: run: unknown key 'durration_s'"));
  EXPECT_THAT(errors_of(lidar_world(""), {{"vehicles.r9.position_m=[1, 2, 3]"}, {}}), HasSubstr("r9"));
  EXPECT_THAT(errors_of(lidar_world(""), {{"nonsense"}, {}}), HasSubstr("must be of the form path=value"));
}

TEST(LoadWorld, ParametersReplaceNamesInTheModel) {
  const std::string world = R"(
shoal: 1
vehicles:
  - name: a
    count: 2
    placement: {pattern: line, spacing_m: 4}
    parameters: {mass: 7}
    model:
      shoal: 1
      vehicle: box
      parameters: {mass: 5}
      bodies: [{name: b, parts: [{shape: box, mass_kg: "${mass}"}]}]
      devices: [{name: modem, type: modem, network: "net${index}"}]
)";
  const auto loaded = sim::load_world_text(world, "test.yaml");
  ASSERT_EQ(loaded.config.vehicles.size(), 2u);
  EXPECT_EQ(loaded.config.vehicles[0].name, "a1");
  EXPECT_EQ(loaded.config.vehicles[1].config->bodies[0].parts[0].mass_kg, 7);
  EXPECT_EQ(loaded.config.vehicles[1].X_WV.translation(), sim::Vector3d(2, 0, 0));
  EXPECT_NE(loaded.config.vehicles[0].config, loaded.config.vehicles[1].config);  // ${index} differs
}

TEST(LoadWorld, AlikeInstancesShareOneConfiguration) {
  const auto loaded = sim::load_world_text(lidar_world("    count: 3\n"), "test.yaml");
  EXPECT_EQ(loaded.config.vehicles[0].config, loaded.config.vehicles[2].config);
}

TEST(LoadWorld, NamesAnUnknownParameter) {
  EXPECT_THAT(errors_of(lidar_world("    parameters: {speeed: 3}\n")),
              HasSubstr("vehicle 'r1': the vehicle has no parameter 'speeed'"));
}

TEST(LoadWorld, NamesAMissingVehicleFile) {
  EXPECT_THAT(errors_of("shoal: 1\nvehicles:\n  - {name: a, file: no_such.yaml}\n"),
              HasSubstr("worlds/test.yaml:3:21: vehicle 'a': there is no vehicle file 'no_such.yaml'"));
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("sprat.yaml")) << "shoal: 1\n";
  std::ofstream(folder.file("w.yaml")) << "shoal: 1\nvehicles: [{name: a, file: sprat.yml}]\n";
  try {
    sim::load_world(folder.file("w.yaml"));
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("; did you mean 'sprat.yaml'?"));
  }
}

TEST(LoadWorld, RefusesTwoVehiclesOfOneName) {
  const std::string model = ", model: {shoal: 1, bodies: [{name: b, parts: [{shape: box, mass_kg: 1}]}]}}\n";
  EXPECT_THAT(errors_of("shoal: 1\nvehicles:\n  - {name: a" + model + "  - {name: a" + model),
              HasSubstr("duplicate vehicle 'a'"));
}

TEST(LoadWorld, RefusesTwoDevicesOnOneChannel) {
  EXPECT_THAT(errors_of(test::rover_world("        - {name: l1, type: lidar, channel: scan}\n"
                                          "        - {name: l2, type: lidar, channel: scan}\n")),
              HasSubstr("device 'l2': channel 'scan' is used twice"));
}

TEST(LoadWorld, RefusesNamesThatDoNotFitAChannel) {
  EXPECT_THAT(errors_of(test::rover_world("        - {name: \"li dar\", type: lidar}\n")),
              HasSubstr("must be made of letters, digits, '_' and '-', got 'li dar'"));
  EXPECT_THAT(errors_of(test::rover_world("        - {name: " + std::string(70, 'x') + ", type: lidar}\n")),
              HasSubstr("must have 1 to 63 characters"));
}

TEST(LoadWorld, ListsTheKnownTypesForAnUnknownDevice) {
  EXPECT_THAT(errors_of(test::rover_world("        - {name: l, type: lider, beams: 3}\n")),
              ContainsRegex("device 'l': unknown device type 'lider'; known types: .*; did you mean 'lidar'"));
}

TEST(LoadWorld, ReportsEveryErrorNotOnlyTheFirst) {
  try {
    sim::load_world_text(
        "shoal: 1\nphysics: {step_s: -1}\nrun: {seed: x}\nobjects: [{name: o, parts: [{shape: ball}]}]\n", "w.yaml");
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_EQ(error.lines().size(), 3u) << error.what();
  }
}

TEST(LoadWorld, AMistakeInAVehicleFileIsReportedOnceForAllItsInstances) {
  try {
    sim::load_world_text(test::rover_world("        - {name: l, type: lidar, beams: 0}\n", "", "    count: 50\n"),
                         "w.yaml");
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_EQ(error.lines().size(), 1u) << error.what();
  }
}

TEST(LoadWorld, TheResolvedWorldIsAWorldFileOfItsOwn) {
  const auto loaded = sim::load_world(test_support::source_path("worlds/minimal.yaml"), {{"run.duration_s=3"}, {}});
  const std::string text = sim::to_yaml(loaded.resolved);
  const auto again = sim::load_world_text(text, "elsewhere/world.yaml");
  EXPECT_EQ(again.config.run.duration_s, 3);
  sim::InProcessBus bus1, bus2;
  sim::World first(loaded.config, bus1), second(again.config, bus2);
  for (int i = 0; i < 100; ++i) {
    first.step();
    second.step();
  }
  EXPECT_EQ(first.state().hash(), second.state().hash());
}

TEST(LoadWorld, EveryFileInBadWorldsSaysWhatItsFirstLineExpects) {
  const std::string folder = test_support::source_path("tests/bad_worlds/");
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".yaml") continue;
    std::ifstream in(entry.path());
    std::string first;
    std::getline(in, first);
    const std::string mark = "# expect: ";
    if (first.rfind("# part of", 0) == 0) continue;  // included by another
    ASSERT_EQ(first.rfind(mark, 0), 0u) << entry.path();
    const std::string expected = first.substr(mark.size());
    try {
      const auto loaded = sim::load_world(entry.path().string());
      sim::InProcessBus bus;
      sim::World world(loaded.config, bus);
      ADD_FAILURE() << entry.path() << " was accepted";
    } catch (const sim::ConfigError& error) {
      std::string message = error.what();
      for (std::size_t at = message.find(folder); at != std::string::npos; at = message.find(folder))
        message.erase(at, folder.size());
      EXPECT_THAT(message, HasSubstr(expected)) << entry.path();
    }
    ++files;
  }
  EXPECT_GE(files, 20);
}

}  // namespace
