// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/system/shoal_program.hpp"

namespace {

using namespace system_test;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string bittle = "tests/tools/shoal/urdf/bittle.urdf";

Ended import_urdf(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"import", "urdf"});
  return run_shoal(std::move(arguments));
}

/// The text without its first line, the path of the schema.
std::string without_schema(const std::string& text) {
  return text.substr(text.find('\n') + 1);
}

TEST(ImportUrdf, MakesAVehicleThatPassesTheCheckAndRuns) {
  const ScratchFolder folder;
  const std::string output = folder.file("bittle.yaml");
  const Ended ended = import_urdf({source(bittle), "--output", output});
  EXPECT_EQ(ended.exit_code, 0);
  EXPECT_EQ(ended.output, output + ": vehicle 'bittle': 10 bodies, 9 joints, 9 servos, 0 mesh files; `shoal check " +
                              output + "` checks it\n");
  EXPECT_EQ(ended.errors, "");
  EXPECT_EQ(without_schema(text_of_file(output)), without_schema(text_of_file(source("vehicles/bittle.yaml"))));
  const Ended checked = run_shoal({"check", output});
  EXPECT_EQ(checked.exit_code, 0) << checked.errors;
  EXPECT_EQ(checked.output, output + ": vehicle 'bittle': 10 bodies, 9 joints, 12 devices\n");
  // The vehicle beside the world has precedence over the shipped one.
  write_file(folder.file("bench.yaml"), text_of_file(source("worlds/bittle_bench.yaml")));
  const Ended run = run_shoal({"run", folder.file("bench.yaml"), "--bus", "none"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("passed: standing.max_deg < 3"));
}

TEST(ImportUrdf, WritesStopsOfHalfATurnThatTheCheckTakes) {
  const ScratchFolder folder;
  const std::string urdf = folder.file("r.urdf"), output = folder.file("r.yaml");
  for (const std::string limit :
       {R"(lower="-3.141592653589793" upper="3.141592653589793")", R"(lower="-3.141592653589793" upper="0")",
        R"(lower="-3.14159265359" upper="0")", R"(lower="-12.566370614359172" upper="6.283185307179586")"}) {
    SCOPED_TRACE(limit);
    const std::string link = "<inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial></link>";
    write_file(urdf, "<robot name=\"r\"><link name=\"a\">" + link + "<link name=\"b\">" + link +
                         "<joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/><limit " + limit +
                         " effort=\"10\" velocity=\"1\"/></joint></robot>");
    const Ended ended = import_urdf({urdf, "--output", output, "--overwrite"});
    EXPECT_EQ(ended.exit_code, 0) << ended.errors;
    EXPECT_EQ(ended.errors, "") << "no limit was left to the servo";
    const std::string text = text_of_file(output);
    EXPECT_THAT(text, HasSubstr("low_stop: "));
    EXPECT_THAT(text, HasSubstr("high_stop: "));
    const Ended checked = run_shoal({"check", output});
    EXPECT_EQ(checked.exit_code, 0) << checked.errors;
  }
}

TEST(ImportUrdf, WritesTheHullsOfMeshesBesideTheVehicle) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder.file("robot"));
  write_file(folder.file("robot/tetrahedron.obj"),
             "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  write_file(folder.file("robot/r.urdf"),
             "<robot name=\"r\"><link name=\"a\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/>"
             "</inertial><collision><geometry><mesh filename=\"package://r/tetrahedron.obj\"/></geometry></collision>"
             "</link></robot>");
  const std::string output = folder.file("r.yaml");
  const Ended ended =
      import_urdf({folder.file("robot/r.urdf"), "--output", output, "--package", "r=" + folder.file("robot")});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_TRUE(std::filesystem::exists(folder.file("r_meshes/tetrahedron_hull.stl")));
  write_file(folder.file("w.yaml"),
             "shoal: 1\nrun: {duration_s: 0.5, speed: max}\nobjects: [{name: ground, fixed: true, "
             "parts: [{shape: plane}]}]\nvehicles: [{name: r1, file: r.yaml}]\n");
  EXPECT_EQ(run_shoal({"run", folder.file("w.yaml"), "--bus", "none"}).exit_code, 0);
}

TEST(ImportUrdf, MakesVisualShapesOfACategoryThatTheCheckKnows) {
  const ScratchFolder folder;
  const std::string urdf = folder.file("r.urdf"), output = folder.file("r.yaml");
  write_file(urdf,
             "<robot name=\"r\"><link name=\"a\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/>"
             "</inertial><visual><geometry><sphere radius=\"1\"/></geometry></visual></link></robot>");
  EXPECT_EQ(import_urdf({urdf, "--output", output}).exit_code, 0);
  const Ended checked = run_shoal({"check", output});
  EXPECT_EQ(checked.exit_code, 0) << checked.errors;
  // So does a vehicle with coefficients, which is checked in water.
  std::string text = text_of_file(output);
  const std::string none = "model: none, mass_kg: 1, inertia_kgm2: [1, 1, 1]";
  ASSERT_THAT(text, HasSubstr(none));
  text.replace(text.find(none), none.size(),
               "model: none, mass_kg: 1, volume_m3: 0.001, inertia_kgm2: [1, 1, 1], added_mass: [1, 1, 1, 0, 0, 0]");
  text.replace(text.find("model: none"), 11, "model: coefficients");
  write_file(output, text);
  const Ended in_water = run_shoal({"check", output});
  EXPECT_EQ(in_water.exit_code, 0) << in_water.errors;
}

TEST(ImportUrdf, GivesMassesByTheDensity) {
  const ScratchFolder folder;
  const std::string urdf = folder.file("r.urdf"), output = folder.file("r.yaml");
  write_file(urdf,
             "<robot name=\"r\">\n<link name=\"a\"><collision><geometry><box size=\"1 2 3\"/></geometry></collision>"
             "</link></robot>");
  const Ended refused = import_urdf({urdf, "--output", output});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, HasSubstr("`--density 1000` gives it the mass of its shapes"));
  const Ended ended = import_urdf({urdf, "--output", output, "--density", "500"});
  EXPECT_EQ(ended.exit_code, 0);
  EXPECT_EQ(ended.errors,
            urdf + ":2: body 'a': its mass is not given: it gets 3000 kg, that of its shapes at 500 kg/m^3\n");
  EXPECT_EQ(run_shoal({"check", output}).exit_code, 0);
  EXPECT_EQ(import_urdf({urdf, "--output", output, "--density", "0", "--overwrite"}).exit_code, 2);
  EXPECT_EQ(import_urdf({urdf, "--output", output, "--density", "nan", "--overwrite"}).exit_code, 2);
}

TEST(ImportUrdf, RefusesAFileThatExistsUnlessItMayReplaceIt) {
  const ScratchFolder folder;
  const std::string output = folder.file("bittle.yaml");
  write_file(output, "mine\n");
  const Ended refused = import_urdf({source(bittle), "--output", output});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, HasSubstr(output + ": already exists; --overwrite replaces it"));
  EXPECT_EQ(text_of_file(output), "mine\n");
  EXPECT_EQ(import_urdf({source(bittle), "--output", output, "--overwrite"}).exit_code, 0);
}

TEST(ImportUrdf, NamesTheLineOfAMistakeAndWritesNothing) {
  const ScratchFolder folder;
  const std::string urdf = folder.file("r.urdf"), output = folder.file("r.yaml");
  write_file(urdf,
             "<robot name=\"r\">\n<link name=\"a\">\n<inertial><mass value=\"heavy\"/></inertial></link></robot>");
  const Ended ended = import_urdf({urdf, "--output", output});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.output, IsEmpty());
  EXPECT_EQ(ended.errors, urdf + ":3: link 'a': 'value' must be a number between -1e9 and 1e9, got 'heavy'\n");
  EXPECT_FALSE(std::filesystem::exists(output));
}

TEST(ImportUrdf, RefusesWrongArguments) {
  const ScratchFolder folder;
  const std::string output = folder.file("r.yaml");
  EXPECT_THAT(import_urdf({source(bittle), "--output", folder.file("r.txt")}).errors, HasSubstr("must end in .yaml"));
  EXPECT_THAT(import_urdf({source(bittle), "--output", output, "--package", "p"}).errors,
              HasSubstr("--package must be NAME=DIR, got 'p'"));
  EXPECT_THAT(import_urdf({source(bittle), "--output", output, "--package", "p=" + folder.file("gone")}).errors,
              HasSubstr("--package: there is no folder"));
  EXPECT_EQ(import_urdf({source(bittle), "--output", output, "--meshes", "round"}).exit_code, 2);
  EXPECT_EQ(import_urdf({folder.file("gone.urdf"), "--output", output}).errors,
            folder.file("gone.urdf") + ": does not exist\n");
  const Ended unwritable = import_urdf({source(bittle), "--output", folder.file("no/such/folder.yaml")});
  EXPECT_EQ(unwritable.exit_code, 4);
  EXPECT_THAT(unwritable.errors, HasSubstr("no such folder"));
}

TEST(ImportSdf, MakesAVehicleThatPassesTheCheckAndRunsInWater) {
  const ScratchFolder folder;
  const std::string sdf = folder.file("m.sdf"), output = folder.file("m.yaml");
  const std::string inertial =
      "<inertial><mass>10</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>";
  write_file(
      sdf, "<sdf version='1.9'><model name='m'><link name='hull'>" + inertial +
               "<collision name='c'><pose>0 0 0.1 0 0 0</pose><geometry><box><size>0.5 0.2 0.1</size></box></geometry>"
               "</collision><sensor name='imu' type='imu'/></link><link name='propeller'><pose>-0.3 0 0 0 0 0</pose>" +
               inertial +
               "</link><joint name='p' type='revolute'><parent>hull</parent><child>propeller</child><axis><xyz>1 0 0"
               "</xyz></axis></joint>\n<plugin name='gz::sim::systems::Thruster' filename='t'><joint_name>p"
               "</joint_name></plugin><plugin name='gz::sim::systems::Hydrodynamics' filename='h'><link_name>hull"
               "</link_name><xDotU>-5</xDotU><xUabsU>-20</xUabsU><yVabsR>-1</yVabsR></plugin></model></sdf>\n");
  const Ended ended = run_shoal({"import", "sdf", sdf, "--output", output});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("vehicle 'm': 1 body, 0 joints, 0 servos, 0 mesh files"));
  EXPECT_EQ(ended.errors, sdf + ":1: joint 'p' is fixed: a `thruster` does not turn its propeller\n");
  const Ended checked = run_shoal({"check", output});
  EXPECT_EQ(checked.exit_code, 0) << checked.errors;
  write_file(folder.file("w.yaml"),
             "shoal: 1\nrun: {duration_s: 1, speed: max}\nmedium: {water: {surface_m: 10}}\n"
             "vehicles: [{name: v, file: m.yaml}]\n");
  EXPECT_EQ(run_shoal({"run", folder.file("w.yaml"), "--bus", "none"}).exit_code, 0);
}

}  // namespace
