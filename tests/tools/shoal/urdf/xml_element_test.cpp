// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/xml_element.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/urdf/urdf_texts.hpp"
#include "tools/shoal/urdf/imported_meshes.hpp"
#include "tools/shoal/urdf/urdf_reader.hpp"

namespace {

using test::import_error;
using test::link_text;
using test::robot_text;

std::string shape_error(const std::string& geometry) {
  return import_error(robot_text(link_text("a", "<collision><geometry>" + geometry + "</geometry></collision>")));
}

TEST(UrdfReader, RefusesXacroWithAHint) {
  EXPECT_EQ(import_error(robot_text("<xacro:property name=\"x\" value=\"1\"/>\n")),
            "r.urdf:2: <xacro:property> is xacro, not URDF: run `xacro FILE > robot.urdf` first");
  EXPECT_EQ(shape_error("<sphere radius=\"${r}\"/>"),
            "r.urdf:2: link 'a': 'radius' is a xacro expression, '${r}': run `xacro FILE > robot.urdf` first");
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("arm.urdf.xacro");
  std::ofstream(path) << robot_text(link_text("a"));
  EXPECT_THROW(
      {
        try {
          tools::read_urdf_file(path);
        } catch (const sim::ConfigError& error) {
          EXPECT_EQ(error.what(), path + ": is xacro, not URDF: run `xacro " + path + " > robot.urdf` first");
          throw;
        }
      },
      sim::ConfigError);
}

TEST(UrdfReader, DoesNotExpandEntities) {
  const std::string urdf = "<!DOCTYPE robot [<!ENTITY file SYSTEM \"file:///etc/passwd\"> <!ENTITY x \"y\">]>\n" +
                           robot_text(link_text("a&x;&file;b"));
  const tools::RobotDescription robot = tools::read_urdf(urdf, "r.urdf");
  EXPECT_EQ(robot.links.at(0).name, "a&x;&file;b");
  ASSERT_EQ(robot.notes.size(), 1u);
  EXPECT_EQ(robot.notes[0].text, "the document type is not read; its entities are not expanded");
}

TEST(UrdfReader, BoundsSizeDepthAndCounts) {
  EXPECT_EQ(import_error(std::string(tools::max_robot_file_bytes + 1, ' ')), "r.urdf: must be at most 16 MiB");
  std::string deep;
  for (int i = 0; i < 2000; ++i) deep += "<robot>";
  EXPECT_EQ(import_error(deep), "r.urdf:1: elements are nested too deeply");
  std::string links;
  for (std::size_t i = 0; i <= tools::max_robot_links; ++i) links += "<link name=\"l" + std::to_string(i) + "\"/>";
  EXPECT_EQ(import_error(robot_text(links)), "r.urdf:1: a robot must have at most 2000 links, got 2001");
}

}  // namespace
