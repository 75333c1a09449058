// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/page_data/look_request.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace {

std::string error_of(const std::string& text) {
  try {
    viewer::parse_look(text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

TEST(LookRequest, NamesATimeOfABranch) {
  const viewer::LookRequest request = viewer::parse_look(R"({"time_us": 1500000, "branch": 2})");
  EXPECT_EQ(request.time_us, 1'500'000);
  EXPECT_EQ(request.branch, 2);
  EXPECT_EQ(viewer::parse_look(R"({"time_us": -2.5})").time_us, -3);  // at or before it
}

TEST(LookRequest, WithoutATimeThePageShowsThePresent) {
  const viewer::LookRequest request = viewer::parse_look(R"({"time_us": null, "branch": null})");
  EXPECT_FALSE(request.time_us);
  EXPECT_FALSE(request.branch);
}

TEST(LookRequest, SaysWhatIsWrong) {
  EXPECT_EQ(error_of("[1]"), "look: must be a JSON object");
  EXPECT_EQ(error_of("{"), "look: must be a JSON object");
  EXPECT_EQ(error_of("{}"), "look: 'time_us' is missing");
  EXPECT_EQ(error_of(R"({"time_us": "now"})"),
            R"(look: 'time_us' must be null or a number from -1e18 to 1e18, got "now")");
  EXPECT_EQ(error_of(R"({"time_us": 2e18})"), "look: 'time_us' must be null or a number from -1e18 to 1e18, got 2e+18");
  EXPECT_EQ(error_of(R"({"time_us": 0, "branch": -1})"), "look: 'branch' must be the number of a branch, got -1");
  EXPECT_EQ(error_of(R"({"time_us": 0, "branch": 3000000000})"),
            "look: 'branch' must be the number of a branch, got 3000000000");
  EXPECT_EQ(error_of(R"({"time_us": 0, "branch": 0.5})"), "look: 'branch' must be the number of a branch, got 0.5");
}

}  // namespace
