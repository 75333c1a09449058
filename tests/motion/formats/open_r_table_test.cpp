// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/motion/formats/format_fixture.hpp"

namespace {

TEST(OpenRTable, HasPackagesOfFourFramesThatTheLastOneFillsUp) {
  const test::Written file =
      test::written("openr-c", test::motion({{0, {{"lf_knee", 0}}}, {0.032, {{"lf_knee", 0.1}}}}), test::leg_names());
  EXPECT_EQ(file.bytes,
            "/* Motion wave, 0.032 s: set points of joints every 8 ms, in 1e-6 rad, for OCommandVectorData of OPEN-R "
            "with 4 frames.\n"
            "   The last frame fills up the last package. */\n"
            "#define WAVE_JOINTS 1\n#define WAVE_FRAMES 5\n#define WAVE_PACKAGES 2\n\n"
            "static const char* const wave_locators[WAVE_JOINTS] = {\n    \"PRM:/r2/c1/c2/c3-Joint2:23\",\n};\n\n"
            "static const int wave_frames[WAVE_PACKAGES][4][WAVE_JOINTS] = {\n"
            "    {{0},\n     {25000},\n     {50000},\n     {75000}},\n    {{100000},\n     {100000},\n     {100000},\n "
            "    {100000}},\n};\n");
}

TEST(OpenRTable, CannotBeRead) {
  EXPECT_EQ(test::read_error("openr-c", "int x;"), "file: 'openr-c' files can only be written");
}

}  // namespace
