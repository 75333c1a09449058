// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/devices/joint/leg_fixture.hpp"
#include "tests/tools/shoal/called_command.hpp"
#include "tests/tools/shoal/motion/leg_files.hpp"

namespace {

using testing::HasSubstr;

TEST(MotionConnectCommand, AnEndIsAFileOrAPoseThatExists) {
  const test::LegFiles files;
  const std::string world =
      files.write("world.yaml", test::leg_world("        - {name: group, type: joint_group}\n"
                                                "        - {name: player, type: motion_player, group: group}\n"));
  const std::string file = files.motion("bend", test::bend);
  const auto refusal = [&](const std::string& from) {
    const test::Called called =
        test::call_shoal({"motion", "connect", from, file, "--world", world, "--output", files.path("between.yaml")});
    EXPECT_EQ(called.exit_code, 2);
    return called.err;
  };
  EXPECT_THAT(refusal(file + ":crouch"), HasSubstr("bend.yaml: there is no pose 'crouch'"));
  EXPECT_THAT(refusal("stand"),
              HasSubstr("'stand' is neither a motion file, nor a pose or motion of vehicle 'leg'; known: none"));
  EXPECT_EQ(files.text_of("between.yaml"), "") << "it was not written";
}

}  // namespace
