// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/vehicle_loader.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "sim/world_file/load_world.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::HasSubstr;

template <typename Action>
std::string error_of(Action&& action) {
  try {
    action();
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

/// A world beside a vehicle file of this text.
struct VehicleFile {
  explicit VehicleFile(const std::string& text) {
    std::ofstream(folder.file("auv.yaml")) << text;
    std::ofstream(folder.file("world.yaml")) << "shoal: 1\nvehicles: [{name: a, file: auv.yaml}]\n";
    std::ofstream(folder.file("empty.yaml")) << "shoal: 1\n";
  }
  test_support::ScratchFolder folder;
};

const std::vector<std::string> texts_without_a_map = {"hello\n", "[1, 2]\n", "", "~\n", "7\n", "- {shoal: 1}\n"};

/// Before: the vehicle was missing without a word, and the scores were those of another world.
TEST(VehicleFile, WithoutAMapIsAnErrorOfTheWorld) {
  for (const std::string& text : texts_without_a_map) {
    const VehicleFile file(text);
    EXPECT_THAT(error_of([&] { sim::load_world(file.folder.file("world.yaml")); }),
                testing::AnyOf(HasSubstr("auv.yaml:1:1: must be a map of keys and values"),
                               HasSubstr("auv.yaml: the file is empty")))
        << text;
    EXPECT_NE(error_of([&] { sim::load_vehicle(file.folder.file("auv.yaml")); }), "no error") << text;
  }
}

/// Before: the first of no vehicles was read, and the simulator died.
TEST(VehicleFile, WithoutAMapIsRefusedWhenAPeerSpawnsIt) {
  for (const std::string& text : texts_without_a_map) {
    const VehicleFile file(text);
    const sim::LoadedWorld world = sim::load_world(file.folder.file("empty.yaml"));
    EXPECT_THAT(error_of([&] { sim::read_spawn_request(world.config, "{name: a, file: auv.yaml}"); }),
                HasSubstr("auv.yaml"))
        << text;
    EXPECT_EQ(sim::self_contained_spawn(world.config, "{name: a, file: auv.yaml}"), "{name: a, file: auv.yaml}");
  }
}

TEST(VehicleFile, OfAnyOtherKindIsRefusedWhenAPeerSpawnsIt) {
  const VehicleFile file("shoal: 1\n");
  const sim::LoadedWorld world = sim::load_world(file.folder.file("empty.yaml"));
  for (const std::string request :
       {"hello", "[1, 2]", "", "~", "{name: a}", "{name: a, model: hello}", "{name: a, model: [1]}",
        "{name: a, model: ~}", "{name: a, model: {}, overrides: [1]}", "{name: a, model: {parameters: [1]}}",
        "{name: a, model: {shoal: 1, bodies: hello}}", "{name: a, file: [1]}", "{name: a, file: ''}",
        "{name: a, file: no.yaml}", "{name: a, file: auv.yaml, parameters: 7}"})
    EXPECT_NE(error_of([&] { sim::read_spawn_request(world.config, request); }), "no error") << request;
}

TEST(VehicleFile, WhereAMapBelongsAWordOrAListIsAnError) {
  const auto error = [](const std::string& vehicle) {
    return error_of([&] { sim::load_world_text("shoal: 1\nvehicles: [{name: a, " + vehicle + "}]\n", "w.yaml"); });
  };
  EXPECT_THAT(error("model: {shoal: 1, parameters: [1]}"), HasSubstr("'parameters' must be a map, got [1]"));
  EXPECT_THAT(error("model: {}, overrides: fast"), HasSubstr("'overrides' must be a map, got 'fast'"));
  EXPECT_THAT(error("model: {}, parameters: [a]"), HasSubstr("'parameters' must be a map, got [a]"));
  EXPECT_THAT(error_of([] {
                sim::load_world_text("shoal: 1\nevents: [{at_s: 1, do: [{set: {device: a/b, values: [1]}}]}]\n",
                                     "w.yaml");
              }),
              HasSubstr("'values' must be a map, got [1]"));
}

}  // namespace
