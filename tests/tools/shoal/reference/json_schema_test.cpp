// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/reference/json_schema.hpp"

#include <gmock/gmock.h>
#include <stdio.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "sim/device/device_registry.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/project_paths.hpp"

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A folder beside a copy of the schemas, as in the tree: `worlds/` and `docs/reference/schema/`.
class ScratchTree {
 public:
  ScratchTree() {
    char pattern[] = "/tmp/shoal_schema_XXXXXX";
    root_ = mkdtemp(pattern);
    fs::create_directories(root_ / "docs/reference");
    fs::create_directories(root_ / "worlds");
    fs::copy(test_support::source_path("docs/reference/schema"), root_ / "docs/reference/schema",
             fs::copy_options::recursive);
  }
  ~ScratchTree() { fs::remove_all(root_); }
  ScratchTree(const ScratchTree&) = delete;
  ScratchTree& operator=(const ScratchTree&) = delete;

  std::string write(const std::string& name, const std::string& kind, const std::string& text) const {
    const fs::path path = root_ / "worlds" / name;
    std::ofstream(path) << "# yaml-language-server: $schema=../docs/reference/schema/" << kind << ".schema.json\n"
                        << text;
    return path.string();
  }
  std::string schemas() const { return (root_ / "docs/reference/schema").string(); }

 private:
  fs::path root_;
};

/// Output of tests/tools/shoal/validate_yaml.py; `good`: it ended with 0.
struct Verdict {
  bool good = false;
  std::string output;
};

Verdict validate(const std::string& schemas, const std::string& arguments) {
  const std::string command = "/usr/bin/python3 -B " + test_support::source_path("tests/tools/shoal/validate_yaml.py") +
                              " " + schemas + " " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  Verdict verdict;
  char block[4096];
  for (std::size_t size = 0; (size = fread(block, 1, sizeof block, pipe)) > 0;) verdict.output.append(block, size);
  verdict.good = pclose(pipe) == 0;
  return verdict;
}

const std::string own_schemas = test_support::source_path("docs/reference/schema");

std::string shipped_files() {
  std::string files;
  for (const char* folder : {"worlds", "vehicles"})
    for (const auto& entry : fs::directory_iterator(fs::path(test_support::source_path("")) / folder))
      if (entry.path().extension() == ".yaml") files += " " + entry.path().string();
  return files;
}

TEST(JsonSchema, InDocsIsUpToDate) {
  for (const std::string file : {"world", "vehicle"}) {
    const std::string path = own_schemas + "/" + file + ".schema.json";
    std::ifstream in(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    EXPECT_TRUE(text == tools::json_schema(file))
        << path << " is stale; type\n  build/release/bin/shoal describe --schema " << file
        << " > docs/reference/schema/" << file << ".schema.json";
  }
}

TEST(JsonSchema, ThereIsNoneOfOtherFiles) {
  EXPECT_THROW(tools::json_schema("lidar"), std::out_of_range);
}

TEST(JsonSchema, HasADefinitionForEveryDevice) {
  for (const char* file : {"world", "vehicle"}) {
    const auto schema = nlohmann::json::parse(tools::json_schema(file));
    for (const sim::DeviceType* type : sim::DeviceRegistry::instance().all())
      EXPECT_TRUE(schema["definitions"].contains("device_" + type->name)) << type->name;
  }
}

TEST(JsonSchema, CarriesRangeDefaultAndMeaning) {
  const auto schema = nlohmann::json::parse(tools::json_schema("world"));
  const auto& erp = schema["properties"]["physics"]["properties"]["erp"];
  EXPECT_EQ(erp["minimum"], 0);
  EXPECT_EQ(erp["maximum"], 1);
  EXPECT_TRUE(erp["default"].is_number());
  EXPECT_THAT(erp["description"].get<std::string>(), HasSubstr("put right"));
}

TEST(JsonSchema, AcceptsEveryShippedFile) {
  const Verdict verdict = validate(own_schemas, "accept" + shipped_files());
  EXPECT_TRUE(verdict.good) << verdict.output;
}

TEST(JsonSchema, RefusesTheBadWorldsWhoseMistakeItCanSay) {
  const Verdict verdict = validate(own_schemas, std::string("refuse ") + test_support::source_path("tests/bad_worlds"));
  EXPECT_TRUE(verdict.good) << verdict.output;
}

TEST(JsonSchema, AcceptsWhatTheLoaderAcceptsInOddSpelling) {
  const ScratchTree tree;
  const std::string world =
      tree.write("odd.yaml", "world",
                 "shoal: 1e0\n"
                 "name: 12\n"
                 "description: yes\n"
                 "epoch: 2026-01-01T00:00:00Z\n"
                 "physics: {step_s: 1e-3, gravity_mps2: +9.81, erp: .2}\n"
                 "run:\n"
                 "objects:\n"
                 "vehicles:\n"
                 "  - name: v\n"
                 "    parameters: {mass: 3}\n"
                 "    model:\n"
                 "      shoal: 1\n"
                 "      parameters: {mass: 2, place: [0, 0, 1], rays: 5, kind: box}\n"
                 "      bodies:\n"
                 "        - name: ${name}\n"
                 "          position_m: ${place}\n"
                 "          parts: [{shape: \"${kind}\", size_m: [1, 1, 1], mass_kg: \"${mass}\"}]\n"
                 "      devices: [{name: eye, type: lidar, phase_s: ~, beams: \"${rays}\"}]\n");
  EXPECT_NO_THROW(sim::load_world(world));
  const Verdict verdict = validate(tree.schemas(), "accept " + world);
  EXPECT_TRUE(verdict.good) << verdict.output;
}

TEST(JsonSchema, AcceptsTheWorldAsItIsWrittenToResults) {
  const ScratchTree tree;
  const auto loaded = sim::load_world(test_support::source_path("worlds/coop_land.yaml"));
  const std::string world = tree.write("resolved.yaml", "world", sim::to_yaml(loaded.resolved));
  const Verdict verdict = validate(tree.schemas(), "accept " + world);
  EXPECT_TRUE(verdict.good) << verdict.output;
}

TEST(JsonSchema, AsksForNothingThatAnIncludedFileMayBring) {
  const ScratchTree tree;
  const std::string text = "devices: [{name: lidar, beams: 9}]\n";
  EXPECT_TRUE(
      validate(tree.schemas(), "accept " + tree.write("layer.yaml", "vehicle", "include: a.yaml\n" + text)).good);
  const Verdict whole = validate(tree.schemas(), "accept " + tree.write("whole.yaml", "vehicle", text));
  EXPECT_THAT(whole.output, HasSubstr("'shoal' is a required property"));
  EXPECT_THAT(whole.output, HasSubstr("'type' is a required property"));
}

}  // namespace
