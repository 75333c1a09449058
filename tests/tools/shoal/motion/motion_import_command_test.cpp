// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "sim/motion/motion.hpp"
#include "tests/tools/shoal/called_command.hpp"
#include "tests/tools/shoal/motion/leg_files.hpp"

namespace {

using testing::HasSubstr;

TEST(MotionImportCommand, NeedsAFormatThatTheFileDoesNotShow) {
  const test::LegFiles files;
  const test::Called called =
      test::call_shoal({"motion", "import", files.write("wave.xyz", "0 0\n"), "--output", files.path("wave.yaml")});
  EXPECT_EQ(called.exit_code, 2);
  EXPECT_THAT(called.err, HasSubstr("--format"));
  EXPECT_EQ(files.text_of("wave.yaml"), "") << "it was not written";
}

TEST(MotionImportCommand, JointsGetTheNamesOfTheVehicle) {
  const test::LegFiles files;
  const std::string webots =
      files.write("wave.motion", "#WEBOTS_MOTION,V1.0,maker/knee\n00:00:000,Pose1,0\n00:01:000,Pose2,0.5\n");
  const std::string output = files.path("wave.yaml");
  const test::Called called =
      test::call_shoal({"motion", "import", webots, "--vehicle", files.path("leg.yaml"), "--output", output});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  const sim::JointMotion motion = sim::load_motion(output);
  EXPECT_EQ(motion.vehicle, "leg");
  ASSERT_EQ(motion.tracks().size(), 1u);
  EXPECT_EQ(motion.tracks()[0].joint, "knee");
  EXPECT_NEAR(motion.tracks()[0].value_at(1), 0.5, 1e-12);
}

}  // namespace
