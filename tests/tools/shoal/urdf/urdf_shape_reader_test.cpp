// SPDX-License-Identifier: BSD-3-Clause
// What other readers of URDF overlook: it gets a note, and the robot is imported.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/urdf/urdf_texts.hpp"
#include "tools/shoal/urdf/imported_meshes.hpp"
#include "tools/shoal/urdf/urdf_reader.hpp"

namespace {

using test::import_error;
using test::imported;
using test::link_text;
using test::notes_of;
using test::robot_text;
using testing::HasSubstr;

const std::string unit_box = "<geometry><box size=\"1 1 1\"/></geometry>";

/// Robot of one link with a shape on line 3.
tools::ImportedVehicle with_shape(const std::string& kind, const std::string& content) {
  return imported(robot_text(link_text("a", "\n<" + kind + ">" + content + "</" + kind + ">\n")));
}

TEST(DecorativeFault, AShapeWithoutVolumeIsLeftOut) {
  const auto expect_left_out = [](const std::string& geometry, const std::string& word) {
    for (const std::string kind : {"collision", "visual"}) {
      const tools::ImportedVehicle vehicle = with_shape(kind, "<geometry>" + geometry + "</geometry>");
      EXPECT_TRUE(vehicle.bodies.at(0).parts.empty());
      EXPECT_EQ(notes_of(vehicle), "r.urdf:3: link 'a': a <" + word + "> without volume is not imported\n");
    }
  };
  expect_left_out("<box size=\"0 0 0\"/>", "box");
  expect_left_out("<box size=\"1 0 1\"/>", "box");
  expect_left_out("<sphere radius=\"0\"/>", "sphere");
  expect_left_out("<sphere radius=\"1e-7\"/>", "sphere");
  expect_left_out("<cylinder radius=\"0.1\" length=\"0\"/>", "cylinder");
  expect_left_out("<mesh filename=\"m.stl\" scale=\"1 0 1\"/>", "mesh");
}

TEST(DecorativeFault, AnOriginMayHaveAQuaternion) {
  const auto turned = [](const std::string& attributes) {
    return with_shape("collision", "<origin xyz=\"1 2 3\" " + attributes + "/>" + unit_box);
  };
  const tools::ImportedVehicle by_angles = turned("rpy=\"0 0 1.5707963267948966\"");
  const tools::ImportedVehicle by_quaternion = turned("quat_xyzw=\"0 0 0.70711 0.70711\"");
  const auto pose = [](const tools::ImportedVehicle& vehicle) { return vehicle.bodies.at(0).parts.at(0).X_BP; };
  EXPECT_TRUE(pose(by_quaternion).isApprox(pose(by_angles), 1e-9));
  EXPECT_THROW(turned("quat_xyzw=\"0 0 0 0\""), sim::ConfigError);
  EXPECT_THROW(turned("quat_xyzw=\"0 0 0 1\" rpy=\"0 0 1\""), sim::ConfigError);
}

TEST(DecorativeFault, OnlyTheFirstElementOfAGeometryCounts) {
  const tools::ImportedVehicle vehicle =
      with_shape("collision", "<geometry><sphere radius=\"0.5\"/>\n<origin xyz=\"1 0 0\"/></geometry>");
  EXPECT_EQ(vehicle.bodies.at(0).parts.at(0).shape.radius_m, 0.5);
  EXPECT_EQ(notes_of(vehicle), "r.urdf:4: link 'a': only the first element of a <geometry> is imported, <sphere>\n");
}

TEST(DecorativeFault, AVisualThatCannotBeReadIsLeftOut) {
  const tools::ImportedVehicle vehicle = with_shape("visual", "<geometry><cone/></geometry>");
  EXPECT_TRUE(vehicle.bodies.at(0).parts.empty());
  EXPECT_EQ(notes_of(vehicle),
            "r.urdf:3: link 'a': the shape must be one of: box, capsule, cylinder, mesh, sphere, got <cone>: this "
            "<visual> is not imported\n");
  EXPECT_THAT(notes_of(with_shape("visual", "")), HasSubstr("<visual> needs a <geometry>: this <visual>"));
  EXPECT_THAT(notes_of(with_shape("visual", "<geometry><sphere radius=\"-1\"/></geometry>")),
              HasSubstr("'radius' must be > 0, got -1: this <visual>"));
}

TEST(DecorativeFault, AColorIsBroughtIntoItsRange) {
  const auto color = [](const std::string& rgba) {
    const tools::ImportedVehicle vehicle =
        with_shape("visual", unit_box + "<material name=\"m\"><color rgba=\"" + rgba + "\"/></material>");
    return vehicle.bodies.at(0).parts.at(0).shape.color + " " + notes_of(vehicle);
  };
  const auto note = [](const std::string& rgba, const std::string& text) {
    return "r.urdf:3: 'rgba' must be four numbers from 0 to 1, got '" + rgba + "': " + text + "\n";
  };
  EXPECT_EQ(color("1 0.2 0 1"), "#ff3300 ");
  EXPECT_EQ(color("255 51 0 255"), "#ff3300 " + note("255 51 0 255", "it is taken as numbers up to 255"));
  EXPECT_EQ(color("255 51 0 1"), "#ff3300 " + note("255 51 0 1", "it is taken as numbers up to 255"));
  EXPECT_EQ(color("1.2 0.2 -1 1"), "#ff3300 " + note("1.2 0.2 -1 1", "it is limited to this range"));
  EXPECT_EQ(color("1 0.2 0"), "#ff3300 " + note("1 0.2 0", "it is opaque"));
  EXPECT_EQ(color("red"), " " + note("red", "the color is not imported"));
}

TEST(DecorativeFault, OnlyTheFirstOfTwoMaterialsCounts) {
  const tools::ImportedVehicle vehicle = with_shape(
      "visual", unit_box + "<material name=\"m\"><color rgba=\"1 0 0 1\"/></material>\n<material name=\"n\"/>");
  EXPECT_EQ(vehicle.bodies.at(0).parts.at(0).shape.color, "#ff0000");
  EXPECT_EQ(notes_of(vehicle), "r.urdf:4: link 'a': only the first <material> of a shape is imported\n");
}

TEST(DecorativeFault, AnUnknownMaterialOrATextureGivesNoColor) {
  const tools::ImportedVehicle unknown = with_shape("visual", unit_box + "<material name=\"steel\"/>");
  EXPECT_EQ(unknown.bodies.at(0).parts.at(0).shape.color, "");
  EXPECT_EQ(notes_of(unknown), "r.urdf:3: link 'a': the material 'steel' is not defined: its color is not imported\n");
  const tools::ImportedVehicle texture =
      with_shape("visual", unit_box + "<material name=\"m\"><texture filename=\"gone.png\"/></material>");
  EXPECT_EQ(notes_of(texture), "r.urdf:3: the texture of a material is not imported\n");
}

TEST(DecorativeFault, AnEmptyMeshOrAVisualOneThatIsMissingIsLeftOut) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("empty.STL")) << std::string(80, ' ');
  std::ofstream(folder.file("empty.obj"));
  std::ofstream(folder.file("blank.dae")) << "\n";
  std::ofstream(folder.file("text.stl")) << "solid x\nendsolid x\n";
  std::ofstream(folder.file("none.stl")) << std::string(84, '\0');
  std::ofstream(folder.file("page.stl")) << "404: Not Found";
  std::ofstream(folder.file("bad.dae")) << "<COLLADA>";
  const auto convert = [&](const std::string& kind, const std::string& mesh) {
    const std::string path = folder.file("r.urdf");
    tools::ImportedVehicle vehicle =
        tools::vehicle_of(tools::read_urdf(robot_text(link_text("a", "<" + kind + "><geometry><mesh filename=\"" +
                                                                         mesh + "\"/></geometry></" + kind + ">")),
                                           path),
                          path);
    EXPECT_TRUE(tools::convert_meshes(vehicle, {}).empty());
    EXPECT_TRUE(vehicle.bodies.at(0).parts.empty());
    return notes_of(vehicle).substr(path.size());
  };
  for (const std::string file : {"empty.STL", "empty.obj", "blank.dae", "text.stl", "none.stl"})
    EXPECT_EQ(convert("collision", file), ":2: mesh '" + file + "' has no triangles: not imported\n");
  EXPECT_EQ(convert("visual", "gone.stl"), ":2: mesh 'gone.stl' does not exist: this <visual> is not imported\n");
  EXPECT_THAT(convert("visual", "bad.dae"), HasSubstr("this <visual> is not imported\n"));
  EXPECT_EQ(convert("visual", "package://p/m.stl"),
            ":2: the folder of package 'p' is unknown: give --package p=DIR: this <visual> is not imported\n");
  // What collides matters.
  EXPECT_THROW(convert("collision", "gone.stl"), sim::ConfigError);
  EXPECT_THROW(convert("collision", "page.stl"), sim::ConfigError);
}

TEST(DecorativeFault, EachVisualOfADamagedMeshGetsTheNoteOfTheFirst) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("bad.dae")) << "<COLLADA>";
  const std::string path = folder.file("r.urdf"),
                    visual = "\n<visual><geometry><mesh filename=\"bad.dae\"/></geometry></visual>";
  tools::ImportedVehicle vehicle =
      tools::vehicle_of(tools::read_urdf(robot_text(link_text("a", visual + visual)), path), path);
  EXPECT_TRUE(tools::convert_meshes(vehicle, {}).empty());
  ASSERT_EQ(vehicle.notes.size(), 2u);
  EXPECT_EQ(vehicle.notes[0].text, vehicle.notes[1].text);
  EXPECT_EQ(vehicle.notes[1].place.line, 4);
}

std::string shape_error(const std::string& geometry) {
  return import_error(robot_text(link_text("a", "<collision><geometry>" + geometry + "</geometry></collision>")));
}

TEST(UrdfReader, NamesLineRuleAndValueOfAWrongShape) {
  EXPECT_EQ(shape_error("<sphere radius=\"-1\"/>"), "r.urdf:2: link 'a': 'radius' must be > 0, got -1");
  EXPECT_EQ(shape_error("<sphere radius=\"1e8\"/>"),
            "r.urdf:2: link 'a': 'radius' must be at most 1e7 m, got 100000000");
  EXPECT_EQ(shape_error("<sphere/>"), "r.urdf:2: link 'a': <sphere> needs the attribute 'radius'");
  EXPECT_EQ(shape_error("<sphere radius=\"1 2\"/>"),
            "r.urdf:2: link 'a': 'radius' must be a number between -1e9 and 1e9, got '1 2'");
  EXPECT_EQ(shape_error("<box size=\"1 nan 1\"/>"),
            "r.urdf:2: link 'a': 'size' must be 3 numbers between -1e9 and 1e9, got '1 nan 1'");
  EXPECT_EQ(shape_error("<box size=\"1 -2 1\"/>"), "r.urdf:2: link 'a': 'size' must be > 0, got -2");
  EXPECT_EQ(shape_error("<cone/>"),
            "r.urdf:2: link 'a': the shape must be one of: box, capsule, cylinder, mesh, sphere, got <cone>");
  EXPECT_EQ(shape_error(""), "r.urdf:2: link 'a': <geometry> must have a shape");
}

}  // namespace
