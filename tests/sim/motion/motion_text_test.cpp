// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "sim/motion/motion.hpp"
#include "tests/sim/motion/motion_fixture.hpp"

namespace {

using namespace motion_fixture;

TEST(JointMotion, ItsTextReadsToTheSameMotion) {
  const sim::JointMotion motion = MotionFile(wave).load();
  const std::string text = sim::motion_text(motion);
  const sim::JointMotion again = MotionFile(text).load();
  EXPECT_EQ(sim::motion_text(again), text);
  const auto tracks = motion.tracks(), others = again.tracks();
  for (std::size_t i = 0; i < tracks.size(); ++i)
    for (std::size_t k = 0; k < tracks[i].keys.size(); ++k)
      EXPECT_EQ(tracks[i].keys[k].value, others[i].keys[k].value) << tracks[i].joint << " " << k;
  EXPECT_EQ(again.keys[1].note, "up");
}

}  // namespace
