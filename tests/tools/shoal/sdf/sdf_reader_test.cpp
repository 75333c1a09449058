// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/sdf/sdf_reader.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/sdf/sdf_texts.hpp"

namespace {

using namespace test;
using testing::HasSubstr;

TEST(SdfReader, TakesVersionsFrom1_4On) {
  for (const std::string version : {"1.4", "1.6", "1.10", "1.12"})
    EXPECT_EQ(sdf_error(sdf_text(sdf_link("a"), version)), "") << version;
  EXPECT_EQ(sdf_error(sdf_text(sdf_link("a"), "1.3")), "m.sdf:1: 'version' must be 1.4 to 1.12, got '1.3'");
  EXPECT_EQ(sdf_error(sdf_text(sdf_link("a"), "2")), "m.sdf:1: 'version' must be 1.4 to 1.12, got '2'");
  EXPECT_THAT(notes_of(imported_sdf(sdf_text(sdf_link("a"), "1.13")).vehicle), HasSubstr("SDF 1.13 is read as 1.12"));
  EXPECT_EQ(sdf_error("<robot name=\"r\"/>"),
            "m.sdf:1: the root element must be <sdf>, got <robot>; this is URDF: use `shoal import urdf`");
}

TEST(SdfReader, ChoosesAModelOfAWorld) {
  const std::string world = "<sdf version=\"1.9\"><world name=\"w\"><model name=\"m1\">" + sdf_link("a") +
                            "</model><model name=\"m2\">" + sdf_link("b") + "</model></world></sdf>";
  EXPECT_EQ(sdf_error(world), "m.sdf:1: choose a model by --model: m1, m2");
  const tools::RobotImport import = imported_sdf(world, {}, "m2");
  EXPECT_EQ(import.vehicle.bodies.at(0).name, "b");
  EXPECT_THAT(notes_of(import.vehicle), HasSubstr("only model 'm2' of the <world> is imported"));
}

TEST(SdfReader, ListsWhatItLeavesOutWithTheReason) {
  const tools::RobotImport import = imported_sdf(
      sdf_text(sdf_link("a", "<light name=\"l\" type=\"point\"/><gravity>0</gravity>") + sdf_plugin("Surprise", "")));
  const std::string notes = notes_of(import.vehicle);
  EXPECT_THAT(notes, HasSubstr("m.sdf:2: link 'a': <light> is not imported: a vehicle has `led` devices\n"));
  EXPECT_THAT(notes, HasSubstr("m.sdf:2: link 'a': <gravity> is not imported: all bodies have weight\n"));
  EXPECT_THAT(notes,
              HasSubstr("m.sdf:3: plugin 'gz::sim::systems::Surprise' is not imported: it is a program for Gazebo\n"));
}

/// A folder of models, as GZ_SIM_RESOURCE_PATH names it.
struct ModelFolder : test_support::ScratchFolder {
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(file(name)).parent_path());
    std::ofstream(file(name)) << text;
  }
  tools::RobotImport import(const std::string& name, const std::vector<std::string>& models = {}) const {
    tools::RobotImportOptions options;
    options.meshes.folders.models = models;
    return tools::import_sdf(file(name), "", options);
  }
  std::string error(const std::string& name, const std::vector<std::string>& models = {}) const {
    try {
      import(name, models);
      return {};
    } catch (const sim::ConfigError& problem) {
      return problem.what();
    }
  }
};

TEST(SdfReader, MergesAndNestsIncludedModels) {
  const ModelFolder folder;
  folder.write("models/base/model.sdf", sdf_text(sdf_link("a") + sdf_plugin("Surprise", "")));
  folder.write("models/arm/model.config",
               "<model><sdf version=\"1.5\">old.sdf</sdf><sdf version=\"1.9\">new.sdf</sdf></model>");
  folder.write("models/arm/new.sdf", sdf_text(sdf_link("b", "<pose>0 0 1 0 0 0</pose>")));
  folder.write("robot/model.sdf",
               sdf_text("<include merge=\"true\"><uri>model://base</uri><pose>0 0 2 0 0 0</pose></include>\n"
                        "<include><uri>model://arm</uri><name>left</name><pose>3 0 0 0 0 0</pose></include>\n" +
                        sdf_joint("fixed", "", "<parent>a</parent><child>left::b</child>")));
  const tools::RobotImport import = folder.import("robot/model.sdf", {folder.file("models")});
  ASSERT_EQ(import.vehicle.bodies.size(), 1u);
  const tools::ImportedBody& body = import.vehicle.bodies[0];
  EXPECT_EQ(body.name, "a");
  EXPECT_DOUBLE_EQ(body.mass_kg, 2);
  // a is at (0, 0, 2), b at (3, 0, 1): in the frame of a their mean is (1.5, 0, -0.5).
  EXPECT_TRUE(body.X_VB.translation().isApprox(sim::Vector3d(0, 0, 2)));
  EXPECT_TRUE(body.center_of_mass_m.isApprox(sim::Vector3d(1.5, 0, -0.5)));
  EXPECT_THAT(notes_of(import.vehicle), HasSubstr(folder.file("models/base/model.sdf") + ":3: plugin"));
}

TEST(SdfReader, RefusesIncludesFromElsewhereAndInALoop) {
  const ModelFolder folder;
  folder.write("robot/model.sdf", sdf_text(sdf_link("a") + "<include><uri>model://arm</uri></include>\n"));
  EXPECT_THAT(folder.error("robot/model.sdf"),
              HasSubstr("model.sdf:3: the folder of model 'arm' is unknown: give --package arm=DIR, or --models"));
  folder.write("outside.sdf", sdf_text(sdf_link("a")));
  folder.write("robot/up.sdf", sdf_text("<include><uri>../outside.sdf</uri></include>\n"));
  EXPECT_THAT(folder.error("robot/up.sdf"), HasSubstr("must be below the folder of the file"));
  folder.write("robot/web.sdf", sdf_text("<include><uri>https://fuel.gazebosim.org/1.0/o/models/m</uri></include>\n"));
  EXPECT_THAT(folder.error("robot/web.sdf"), HasSubstr("is a web address: nothing is downloaded"));
  folder.write("robot/loop.sdf", sdf_text("<include><uri>second.sdf</uri></include>\n"));
  folder.write("robot/second.sdf", sdf_text("<include><uri>loop.sdf</uri></include>\n"));
  EXPECT_THAT(folder.error("robot/loop.sdf"), HasSubstr("second.sdf:2: this file includes itself"));
}

TEST(SdfReader, LimitsTheModelsThatIncludesMultiply) {
  // Each file includes the next one ten times: 10^5 models.
  const ModelFolder folder;
  for (int level = 0; level < 5; ++level) {
    std::string text;
    for (int i = 0; i < 10; ++i)
      text += "<include><name>n" + std::to_string(i) + "</name><uri>" + std::to_string(level + 1) +
              ".sdf</uri></include>\n";
    folder.write(std::to_string(level) + ".sdf", sdf_text(text));
  }
  folder.write("5.sdf", sdf_text(sdf_link("a")));
  EXPECT_THAT(folder.error("0.sdf"), HasSubstr("a robot must have at most 300 models in it"));
}

TEST(SdfReader, RefusesHostileFilesOnOneLine) {
  EXPECT_EQ(sdf_error("<sdf version='1.9'><model name='m'><link name='a'>"), "m.sdf:1: is not well-formed XML");
  std::string deep;
  for (int i = 0; i < 2000; ++i) deep += "<model name='n'>";
  EXPECT_THAT(sdf_error("<sdf version='1.9'>" + deep), HasSubstr("elements are nested too deeply"));
  for (const std::string number : {"nan", "1e400", "-1e300", "", "one"})
    EXPECT_THAT(sdf_error(sdf_text("<link name='a'><inertial><mass>" + number + "</mass></inertial></link>")),
                HasSubstr("m.sdf:2: link 'a': <mass> must be a number between -1e9 and 1e9"))
        << number;
  // Entities are not expanded.
  const std::string entities =
      "<!DOCTYPE sdf [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;\">]>\n" + sdf_text(sdf_link("&b;"));
  EXPECT_THAT(notes_of(imported_sdf(entities).vehicle), HasSubstr("its entities are not expanded"));
  EXPECT_EQ(sdf_error("<sdf version='1.9'/>"), "m.sdf:1: <sdf> must have a <model>");
  EXPECT_EQ(sdf_error(sdf_text("")), "m.sdf:1: a model needs a <link>");
}

}  // namespace
