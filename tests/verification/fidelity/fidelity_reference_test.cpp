// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/fidelity/fidelity_files.hpp"

namespace {

using namespace fidelity_files;

using testing::HasSubstr;

TEST_F(FidelityFiles, AReferenceMustBeATrackOfTwoRowsOrMore) {
  const auto error_with = [&](const std::string& text) {
    write("c.csv", text);
    return error_of(cases(""));
  };
  EXPECT_THAT(error_of(cases("")), HasSubstr("c.csv: case 'c': does not exist"));
  EXPECT_THAT(error_with(""), HasSubstr("c.csv: case 'c': is empty"));
  EXPECT_THAT(error_with(header), HasSubstr("c.csv: case 'c': must have two rows of numbers or more, has 0"));
  EXPECT_THAT(error_with(header + row(0)), HasSubstr("c.csv: case 'c': must have two rows of numbers or more, has 1"));
  EXPECT_THAT(error_with(header + row(0) + row(0.2) + row(0.1)),
              HasSubstr("c.csv:4:1: case 'c': the time must rise, got 0.1 after 0.2"));
  EXPECT_THAT(error_with(header + row(0.1) + row(0.2)),
              HasSubstr("c.csv:2:1: case 'c': the first row must be at t = 0, got 0.1"));
  EXPECT_THAT(error_with(header + row(0) + "0.1,1e308,2,3,0,0,0.5,0,0,0,0,0,0,0\n"),
              HasSubstr("c.csv:3:1: case 'c': must have numbers from -1e9 to 1e9, got 1e308"));
  EXPECT_THAT(error_with("x,y\n0,1\n"), HasSubstr("c.csv:1:1: case 'c': the first column must be t, got 'x'"));
  EXPECT_EQ(error_with(header + row(0) + row(0.1)), "");
}

TEST_F(FidelityFiles, ADirectoryIsNoReference) {
  std::filesystem::create_directory(folder_.file("c.csv"));
  EXPECT_THAT(error_of(cases("")), HasSubstr("c.csv: case 'c': is not a file"));
}

}  // namespace
