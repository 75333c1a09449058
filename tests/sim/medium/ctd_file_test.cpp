// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/ctd_file.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "sim/medium/medium.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/sim/acoustics/config_text.hpp"

namespace {

using sim::parse_ctd;
using testing::HasSubstr;

/// The words of the error of an invalid file.
std::string ctd_error(const std::string& text) {
  try {
    parse_ctd(text);
  } catch (const sim::CtdError& error) {
    return error.what();
  }
  return "";
}

TEST(CtdFile, ReadsColumnsInAnyOrderAndIgnoresOthers) {
  const auto rows = parse_ctd(
      "# cast 12\nsalinity_psu, oxygen, depth_m ,temperature_C\r\n34.5,6,0.5,16\n\n34.8,6,15,14\n35,6,40,10\n");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].depth_m, 0.5);
  EXPECT_EQ(rows[1].temperature_C, 14);
  EXPECT_EQ(rows[2].salinity_psu, 35);
  EXPECT_FALSE(rows[0].sound_speed_mps);
}

TEST(CtdFile, SkipsHeaveAndTheWayUp) {
  const auto rows =
      parse_ctd("depth_m,temperature_C,salinity_psu\n-0.2,9,35\n1,9,35\n3,8,35\n2,8.5,35\n4,7,35\n3,8,35\n");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[2].depth_m, 4);
}

TEST(CtdFile, ConvertsPressureByTheCheckValueOfUnesco) {
  // Technical paper 44: 9712.653 m at 10000 dbar and 30 degrees; gravity at 45 degrees is larger by 9.80619 / 9.79324.
  EXPECT_NEAR(sim::depth_of_pressure_m(10000), 9712.653 * (9.793243 + 0.01092) / (9.806191 + 0.01092), 0.3);
  const auto rows = parse_ctd("pressure_dbar,temperature_C,salinity_psu\n1,9,35\n101,8,35\n");
  EXPECT_NEAR(rows[1].depth_m, sim::depth_of_pressure_m(101), 1e-12);
}

TEST(CtdFile, AveragesManyRowsInLayers) {
  std::string text = "depth_m,temperature_C,salinity_psu\n";
  for (int i = 0; i <= 2000; ++i) text += std::to_string(i * 0.05) + "," + std::to_string(20 - i * 0.005) + ",35\n";
  const auto rows = parse_ctd(text);
  EXPECT_LE(rows.size(), sim::ctd_rows + 1);
  for (const auto& row : rows) EXPECT_NEAR(row.temperature_C, 20 - row.depth_m / 10, 1e-5);
}

TEST(CtdFile, SaysWhatIsWrong) {
  EXPECT_THAT(ctd_error("temperature_C,salinity_psu\n"), HasSubstr("line 1: the header must name 'depth_m'"));
  EXPECT_THAT(ctd_error("depth_m,salinity_psu\n"), HasSubstr("must name 'temperature_C'"));
  const std::string header = "depth_m,temperature_C,salinity_psu\n";
  EXPECT_THAT(ctd_error(header + "1,warm,35\n"), HasSubstr("line 2: 'temperature_C' is not a number"));
  EXPECT_THAT(ctd_error(header + "1,9\n"), HasSubstr("line 2: 'salinity_psu' is missing"));
  EXPECT_THAT(ctd_error(header + "1,9,nan\n"), HasSubstr("'salinity_psu' must be in [0, 400]"));
  EXPECT_THAT(ctd_error(header + "1,9,35\n"), HasSubstr("needs two rows"));
}

TEST(CtdFile, IsTheProfileOfAWorld) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("ctd.csv")) << "depth_m,temperature_C,salinity_psu\n0,16,34.5\n15,14,34.8\n40,10,35\n";
  const auto read = [&](const std::string& keys) {
    return test_support::read_config<sim::WaterConfig>("{profile_file: " + folder.file("ctd.csv") + keys + "}");
  };
  EXPECT_EQ(read("").profile.size(), 3u);
  EXPECT_THAT(test_support::config_error<sim::WaterConfig>("{profile_file: " + folder.file("none.csv") + "}"),
              HasSubstr("does not exist"));
  EXPECT_THROW(read(", profile: [{depth_m: 0}]"), sim::ConfigError);
}

}  // namespace
