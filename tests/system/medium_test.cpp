// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>

#include "tests/system/shoal_program.hpp"

namespace {

using namespace system_test;
using testing::HasSubstr;
using testing::Not;

Ended medium(const std::string& of_world, std::vector<std::string> arguments) {
  const ScratchFolder folder;
  std::ofstream(folder.file("sea.yaml")) << "shoal: 1\nphysics: {gravity_mps2: 9.80665}\nmedium: " << of_world << "\n";
  arguments.insert(arguments.begin(), {"medium", folder.file("sea.yaml")});
  return run_shoal(arguments);
}

TEST(MediumCommand, ShowsAPlace) {
  const Ended ended = medium("{water: {temperature_C: 4, salinity_psu: 34}, wind: {velocity_mps: [5, 0, 0]}}",
                             {"--at", "1,2,-500", "--time", "3"});
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  // Mackenzie's 1473.383 m/s; 101325 + 1025 * 9.80665 * 500.
  EXPECT_THAT(ended.output, HasSubstr("1473.38 m/s"));
  EXPECT_THAT(ended.output, HasSubstr("5127233.1 Pa"));
  EXPECT_THAT(ended.output, testing::ContainsRegex("wind +none \\(under water\\)"));
}

TEST(MediumCommand, ShowsTheWindOverTheWater) {
  const Ended ended = medium("{water: {}, wind: {velocity_mps: [5, 0, 0]}}", {"--at", "1,2,10"});
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, testing::ContainsRegex("wind +5.000 0.000 0.000 m/s east north up"));
}

TEST(MediumCommand, ShowsTheWaterByDepth) {
  const Ended ended = medium("{water: {}}", {"--at", "0,0,-30", "--profile"});
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  for (const char* row : {"\n0 10.000", "\n1 10.000", "\n20 10.000", "\n30 10.000 35.000 1025.000"})
    EXPECT_THAT(ended.output, HasSubstr(row));
}

TEST(MediumCommand, MeasuresTheWaves) {
  const Ended ended =
      medium("{water: {}, waves: {type: regular, height_m: 1, period_s: 5}}", {"--waves", "500", "--at", "3,4,0"});
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("Hs = 4 std      1.41"));  // 4 * 0.5 / sqrt(2)
  EXPECT_THAT(ended.output, HasSubstr("Tz              5.000 s over 99 waves"));
}

TEST(MediumCommand, SaysWhatIsWrong) {
  EXPECT_EQ(medium("{water: {}}", {"--waves", "100"}).exit_code, 2);
  EXPECT_EQ(medium("{}", {"--profile"}).exit_code, 2);
  const Ended ended = medium("{water: {}}", {"--at", "1,2"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.errors, HasSubstr("three numbers in meters"));
}

TEST(Water, ThatIsMissingForCoefficientsIsWarnedOfOnce) {
  const ScratchFolder folder;
  const auto errors_of = [&](const std::string& medium) {
    write_file(folder.file("world.yaml"),
               "shoal: 1\n" + medium + "vehicles:\n  - {name: first, file: " + source("vehicles/otter.yaml") +
                   "}\n  - {name: second, position_m: [9, 0, 0], file: " + source("vehicles/otter.yaml") + "}\n");
    const Ended ended = run_shoal({"check", folder.file("world.yaml")});
    EXPECT_EQ(ended.exit_code, 0) << ended.errors;
    return ended.errors;
  };
  EXPECT_THAT(errors_of(""),
              HasSubstr("vehicle 'first' (and 1 more): it has hydrodynamics, but the world has no 'medium: water:'"));
  EXPECT_THAT(errors_of(""), Not(HasSubstr("second")));
  EXPECT_EQ(errors_of("medium: {water: {}}\n"), "");
}

}  // namespace
