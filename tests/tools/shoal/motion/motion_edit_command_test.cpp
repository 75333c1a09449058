// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <numbers>

#include "sim/motion/motion.hpp"
#include "tests/tools/shoal/called_command.hpp"
#include "tests/tools/shoal/motion/leg_files.hpp"

namespace {

using testing::HasSubstr;

TEST(MotionEditCommand, SaysWhatTheFileHasAndWhatItHad) {
  const test::LegFiles files;
  const std::string file = files.motion("bend", test::bend);
  const test::Called called = test::call_shoal({"motion", "edit", "scale", file, "--by", "2"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_EQ(called.out, file + ": 2.000 s, 1 joint, 2 keys; before 1.000 s, 1 joint, 2 keys\n");
}

TEST(MotionEditCommand, AValueIsInTheUnitOfTheFileAndOfALightFromZeroToOne) {
  const test::LegFiles files;
  const std::string file = files.motion("bend", test::bend);
  const test::Called called =
      test::call_shoal({"motion", "edit", "set", file, "--at", "0.5", "maker/knee=30", "lamp=1"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  const sim::JointMotion motion = sim::load_motion(file);
  const std::vector<sim::MotionTrack> tracks = motion.tracks();
  ASSERT_EQ(tracks.size(), 2u) << "the alias is that of the joint which the motion has";
  EXPECT_EQ(tracks[0].joint, "knee");
  EXPECT_NEAR(tracks[0].value_at(0.5), std::numbers::pi / 6, 1e-9);
  EXPECT_TRUE(motion.is_light("lamp"));
  EXPECT_EQ(tracks[1].value_at(0.5), 1);
}

TEST(MotionEditCommand, AJointThatIsSetIsOneOfTheVehicle) {
  const test::LegFiles files;
  const std::string file = files.motion("bend", test::bend), before = files.text_of("bend.yaml");
  const test::Called called = test::call_shoal({"motion", "edit", "set", file, "--at", "0.5", "kneee=30"});
  EXPECT_EQ(called.exit_code, 2);
  EXPECT_THAT(called.err, HasSubstr("joint 'kneee' is not a servo of vehicle 'leg'; did you mean 'knee'?; known: "
                                    "knee, lamp, rod"));
  EXPECT_EQ(files.text_of("bend.yaml"), before);
}

}  // namespace
