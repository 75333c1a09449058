// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/mtn_file.hpp"

#include <gmock/gmock.h>

#include "tests/motion/formats/format_fixture.hpp"
#include "tests/motion/formats/mtn_format_fixture.hpp"

namespace {

using namespace mtn_format_fixture;

TEST(MtnFile, OfTheStructureOfTheWorkedExampleIsReadToItsLastByteAndWrittenTheSame) {
  const std::string bytes = example();
  ASSERT_EQ(bytes.size(), 1164u);
  const motion::MtnFile file = motion::parse_mtn(bytes, "file");
  EXPECT_EQ(file.name, "b_stand#lie_S");
  EXPECT_EQ(file.creator, "Makers of Shoal.");
  EXPECT_EQ(file.design, "XYZ-910");
  EXPECT_EQ(file.locators, locators());
  ASSERT_EQ(file.keys.size(), 6u);
  EXPECT_EQ(file.keys[0].pitch, 34906);
  EXPECT_EQ(file.keys[5].between, 100);
  EXPECT_EQ(motion::mtn_bytes(file), bytes);
}

}  // namespace
