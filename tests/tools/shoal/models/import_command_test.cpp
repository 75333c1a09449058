// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/called_command.hpp"

namespace {

using testing::HasSubstr;

std::string box_robot(const test_support::ScratchFolder& folder) {
  std::ofstream(folder.file("box.urdf"))
      << "<robot name='box'><link name='base'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' "
         "ixz='0' iyz='0'/></inertial><collision><geometry><box size='1 1 1'/></geometry></collision></link></robot>\n";
  return folder.file("box.urdf");
}

TEST(ImportCommand, WritesAVehicleAndReplacesNone) {
  const test_support::ScratchFolder folder;
  const std::vector<std::string> call{"import", "urdf", box_robot(folder), "--output", folder.file("box.yaml")};
  const test::Called called = test::call_shoal(call);
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_EQ(test::call_shoal({"check", folder.file("box.yaml")}).exit_code, 0);
  const test::Called again = test::call_shoal(call);
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.err, HasSubstr("already exists; --overwrite replaces it"));
}

TEST(ImportCommand, ConvertsAModelInSdf) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("m.sdf"))
      << "<sdf version='1.9'><model name='m'><link name='a'><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy>"
         "<izz>1</izz></inertia></inertial><light name='l'/><sensor name='imu' type='imu'/></link></model></sdf>\n";
  const std::string output = folder.file("m.yaml");
  const test::Called called = test::call_shoal({"import", "sdf", folder.file("m.sdf"), "--output", output});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_THAT(called.out, HasSubstr("vehicle 'm': 1 body, 0 joints"));
  EXPECT_EQ(called.err, folder.file("m.sdf") + ":1: link 'a': <light> is not imported: a vehicle has `led` devices\n");
  EXPECT_EQ(test::call_shoal({"check", output}).exit_code, 0);
  const test::Called wrong = test::call_shoal({"import", "sdf", box_robot(folder), "--output", folder.file("n.yaml")});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("this is URDF: use `shoal import urdf`"));
}

TEST(ImportCommand, SaysWhatIsWrongWithItsOptions) {
  const test_support::ScratchFolder folder;
  const auto wrong = [&](const std::vector<std::string>& more) {
    std::vector<std::string> call{"import", "urdf", box_robot(folder)};
    call.insert(call.end(), more.begin(), more.end());
    const test::Called called = test::call_shoal(call);
    EXPECT_EQ(called.exit_code, 2);
    return called.err;
  };
  EXPECT_THAT(wrong({"--output", folder.file("box.txt")}), HasSubstr("--output must end in .yaml"));
  EXPECT_THAT(wrong({"--output", folder.file("b.yaml"), "--package", "robots"}),
              HasSubstr("--package must be NAME=DIR"));
  EXPECT_THAT(wrong({"--output", folder.file("b.yaml"), "--package", "robots=" + folder.file("none")}),
              HasSubstr("--package: there is no folder"));
}

}  // namespace
