// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/reference/json_schema.hpp"

#include <gmock/gmock.h>
#include <stdio.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "experiment/drive/drive_profile.hpp"
#include "experiment/study/study_config.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/motion/motion.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/project_paths.hpp"
#include "tools/shoal/reference/reference_pages.hpp"

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
  for (const char* folder : {"worlds", "worlds/studies", "vehicles"})
    for (const auto& entry : fs::directory_iterator(fs::path(test_support::source_path("")) / folder))
      if (entry.path().extension() == ".yaml") files += " " + entry.path().string();
  return files;
}

TEST(JsonSchema, InDocsIsUpToDate) {
  for (const std::string file : {"world", "vehicle", "study", "motion", "drive"}) {
    const std::string path = own_schemas + "/" + file + ".schema.json";
    std::ifstream in(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::string made = file == "study"    ? tools::study_schema(tools::params_of<experiment::StudyConfig>())
                             : file == "motion" ? tools::motion_schema(tools::params_of<sim::JointMotion>())
                             : file == "drive"  ? tools::drive_schema(tools::params_of<experiment::DriveProfile>())
                                                : tools::json_schema(file);
    EXPECT_TRUE(text == made) << path << " is stale; type\n  build/release/bin/shoal describe --schema " << file
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
  EXPECT_THAT(erp["description"].get<std::string>(), HasSubstr("corrected"));
}

TEST(JsonSchema, AnActionIsAMapOfOneKeyWithTheKeysOfTheActionBelow) {
  const auto schema = nlohmann::json::parse(tools::json_schema("world"));
  const auto& list = schema["properties"]["events"]["items"]["properties"]["do"];
  EXPECT_EQ(list["items"]["$ref"], "#/definitions/action");
  const auto& action = schema["definitions"]["action"];
  EXPECT_EQ(action["minProperties"], 1);
  EXPECT_EQ(action["maxProperties"], 1);
  EXPECT_EQ(action["additionalProperties"], false);
  const auto& publish = action["properties"]["publish"];
  EXPECT_EQ(publish["required"], (nlohmann::json{"channel", "type"}));
  EXPECT_TRUE(publish["properties"].contains("value"));
  EXPECT_FALSE(action["properties"].contains("channel"));
  // The main value alone, or the map.
  EXPECT_EQ(action["properties"]["log"]["anyOf"].size(), 2u);
  const auto& choices = action["properties"]["one_of"]["anyOf"][1]["properties"]["choices"];
  EXPECT_EQ(choices["items"]["items"]["$ref"], "#/definitions/action");
}

TEST(JsonSchema, ANumberOrItsWordIsOffered) {
  const auto schema = nlohmann::json::parse(tools::json_schema("world"));
  const auto& speed = schema["properties"]["run"]["properties"]["speed"];
  EXPECT_EQ(speed["default"], "max");
  ASSERT_EQ(speed["oneOf"].size(), 2u);
  EXPECT_EQ(speed["oneOf"][0]["minimum"], 0.001);
  EXPECT_EQ(speed["oneOf"][1]["const"], "max");
  // In a vehicle file a ${name} as well.
  EXPECT_EQ(schema["definitions"]["device"]["properties"]["rate_hz"]["oneOf"].size(), 3u);
}

TEST(JsonSchema, AcceptsActionsAndWordsAsTheLoaderDoes) {
  const ScratchTree tree;
  const std::string world = tree.write("forms.yaml", "world",
                                       "shoal: 1\n"
                                       "run: {speed: max, duration_s: forever, hash_every_steps: never}\n"
                                       "state_rate_hz: never\n"
                                       "events:\n"
                                       "  - name: e\n"
                                       "    at: 1\n"
                                       "    times: unlimited\n"
                                       "    do:\n"
                                       "      - log: hello\n"
                                       "      - log: {text: hello}\n"
                                       "      - gravity_mps2: 1.6\n"
                                       "      - end: {passed: false, reason: enough}\n"
                                       "      - one_of: [[log: a], [{log: b}, {log: c}]]\n"
                                       "      - one_of: {weights: [1], choices: [[one_of: [[log: d]]]]}\n");
  EXPECT_NO_THROW(sim::load_world(world));
  const Verdict verdict = validate(tree.schemas(), "accept " + world);
  EXPECT_TRUE(verdict.good) << verdict.output;
}

TEST(JsonSchema, AcceptsEveryShippedFile) {
  const Verdict verdict = validate(own_schemas, "accept" + shipped_files());
  EXPECT_TRUE(verdict.good) << verdict.output;
}

TEST(JsonSchema, RefusesTheBadWorldsWhoseMistakeItCanSay) {
  const Verdict verdict = validate(own_schemas, std::string("refuse ") + test_support::source_path("tests/bad_worlds"));
  EXPECT_TRUE(verdict.good) << verdict.output;
}

// `model` of a vehicle is a vehicle; `model` elsewhere is a word.
TEST(JsonSchema, TakesAKeyForAVehicleWhereItIsOneOnly) {
  const auto schema = nlohmann::json::parse(tools::json_schema("world"));
  EXPECT_EQ(schema["properties"]["acoustics"]["properties"]["absorption"]["properties"]["model"]["enum"],
            (nlohmann::json{"thorp", "francois_garrison", "constant"}));
  EXPECT_EQ(schema["properties"]["vehicles"]["items"]["properties"]["model"]["allOf"][0]["$ref"],
            "#/definitions/vehicle");
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

TEST(JsonSchema, KnowsARuleByItsForm) {
  const ScratchTree tree;
  const auto refused = [&](const std::string& kind, const std::string& keys, const std::string& rule) {
    return !validate(tree.schemas(),
                     "accept " + tree.write("ruled.yaml", kind, "shoal: 1\n" + keys + "pass: [" + rule + "]\n"))
                .good;
  };
  const std::string study = "study: s\nworld: w.yaml\nseeds: [1-3, 8]\n";
  for (const auto& [kind, keys] : {std::pair{"world", std::string()}, {"study", study}}) {
    EXPECT_FALSE(refused(kind, keys, "a.rms_m < 0.4 * (b.rms_m - 1)")) << kind;
    EXPECT_FALSE(refused(kind, keys, "max(a.b.rms_m) != -1e-3")) << kind;
    EXPECT_TRUE(refused(kind, keys, "a.rms_m")) << kind;
    EXPECT_TRUE(refused(kind, keys, "1 < a.rms_m < 2")) << kind;
    EXPECT_TRUE(refused(kind, keys, "'{metric: a.rms_m, below: 3}'")) << kind;
    EXPECT_TRUE(refused(kind, keys, "{metric: a.rms_m, below: 3}")) << kind;
  }
  EXPECT_TRUE(refused("study", "study: s\nworld: w.yaml\nseeds: 3-\n", "mean(a.passed) == 1"));
}

TEST(JsonSchema, RequestsNothingThatAnIncludedFileMayBring) {
  const ScratchTree tree;
  const std::string text = "devices: [{name: lidar, beams: 9}]\n";
  EXPECT_TRUE(
      validate(tree.schemas(), "accept " + tree.write("layer.yaml", "vehicle", "include: a.yaml\n" + text)).good);
  const Verdict whole = validate(tree.schemas(), "accept " + tree.write("whole.yaml", "vehicle", text));
  EXPECT_THAT(whole.output, HasSubstr("'shoal' is a required property"));
  EXPECT_THAT(whole.output, HasSubstr("'type' is a required property"));
}

}  // namespace
