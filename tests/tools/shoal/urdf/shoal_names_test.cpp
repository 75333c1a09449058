// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/shoal_names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/shoal/urdf/urdf_texts.hpp"
#include "tools/shoal/urdf/imported_vehicle.hpp"

namespace {

using test::imported;
using test::link_text;
using test::notes_of;
using test::robot_text;
using testing::HasSubstr;

TEST(ImportedVehicle, NamesAreThoseThatShoalAccepts) {
  const tools::ImportedVehicle vehicle = imported(robot_text(
      link_text("base link") + link_text("base.link") +
      "<joint name=\"joints\" type=\"continuous\"><parent link=\"base link\"/><child link=\"base.link\"/></joint>"));
  EXPECT_EQ(vehicle.bodies[0].name, "base_link");
  EXPECT_EQ(vehicle.bodies[1].name, "base_link_2");
  EXPECT_EQ(vehicle.joints[0].name, "joints_2");  // `joints` is the device that reports them
  EXPECT_THAT(notes_of(vehicle), HasSubstr("r.urdf:3: link 'base.link' is named 'base_link_2' in Shoal\n"));
}

}  // namespace
