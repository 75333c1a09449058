// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/ctd_file.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "sim/medium/medium.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/sim/acoustics/config_text.hpp"
#include "tests/sim/medium/log_capture.hpp"

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

std::vector<sim::WaterLayerConfig> rows_of(const std::string& text) {
  return parse_ctd(text).rows;
}

const std::string ctd_header = "depth_m,temperature_C,salinity_psu\n";

/// Temperature of a cast at a depth, linear between its rows, C.
double temperature_at(const std::vector<sim::WaterLayerConfig>& rows, double depth_m) {
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (depth_m <= rows[i].depth_m)
      return std::lerp(rows[i - 1].temperature_C, rows[i].temperature_C,
                       (depth_m - rows[i - 1].depth_m) / (rows[i].depth_m - rows[i - 1].depth_m));
  return rows.back().temperature_C;
}

TEST(CtdFile, ReadsColumnsInAnyOrderAndIgnoresOthers) {
  const auto rows =
      rows_of("# cast 12\nsalinity_psu, oxygen, depth_m ,temperature_C\r\n34.5,6,0.5,16\n\n34.8,6,15,14\n35,6,40,10\n");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].depth_m, 0.5);
  EXPECT_EQ(rows[1].temperature_C, 14);
  EXPECT_EQ(rows[2].salinity_psu, 35);
  EXPECT_FALSE(rows[0].sound_speed_mps);
}

TEST(CtdFile, SkipsHeaveAndTheWayUp) {
  const auto rows =
      rows_of("depth_m,temperature_C,salinity_psu\n-0.2,9,35\n1,9,35\n3,8,35\n2,8.5,35\n4,7,35\n3,8,35\n");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[2].depth_m, 4);
}

TEST(CtdFile, ConvertsPressureByTheCheckValueOfUnesco) {
  // Technical paper 44: 9712.653 m at 10000 dbar and 30 degrees; gravity at 45 degrees is larger by 9.80619 / 9.79324.
  EXPECT_NEAR(sim::depth_of_pressure_m(10000), 9712.653 * (9.793243 + 0.01092) / (9.806191 + 0.01092), 0.3);
  const auto rows = rows_of("pressure_dbar,temperature_C,salinity_psu\n1,9,35\n101,8,35\n");
  EXPECT_NEAR(rows[1].depth_m, sim::depth_of_pressure_m(101), 1e-12);
}

TEST(CtdFile, AveragesManyRowsInLayers) {
  std::string text = "depth_m,temperature_C,salinity_psu\n";
  for (int i = 0; i <= 2000; ++i) text += std::to_string(i * 0.05) + "," + std::to_string(20 - i * 0.005) + ",35\n";
  const auto rows = rows_of(text);
  EXPECT_LE(rows.size(), sim::ctd_rows + 1);
  for (const auto& row : rows) EXPECT_NEAR(row.temperature_C, 20 - row.depth_m / 10, 1e-5);
}

TEST(CtdFile, SaysWhatIsWrong) {
  EXPECT_THAT(ctd_error("temperature_C,salinity_psu\n"), HasSubstr("line 1: the header must name 'depth_m'"));
  EXPECT_THAT(ctd_error("depth_m,salinity_psu\n"), HasSubstr("must name 'temperature_C'"));
  EXPECT_THAT(ctd_error(ctd_header + "1,warm,35\n"), HasSubstr("line 2: 'temperature_C' is not a number"));
  EXPECT_THAT(ctd_error(ctd_header + "1,9\n"), HasSubstr("line 2: 'salinity_psu' is missing"));
  EXPECT_THAT(ctd_error(ctd_header + "1,9,500\n"), HasSubstr("line 2: 'salinity_psu' must be in [0, 400], got '500'"));
  EXPECT_THAT(ctd_error(ctd_header + "1,9,35\n"), HasSubstr("needs two rows"));
}

TEST(CtdFile, SkipsRowsWithMissingValuesAndSaysSo) {
  // The bad flag of Sea-Bird, nines, fill values of netCDF, words and nothing.
  for (const char* cell : {"-9.990e-29", "-9.99e-29", "99.999", "99.99", "-99", "-999.0", "-9999", "99999",
                           "9.96921e36", "1e35", "1e400", "nan", "NaN", "-nan", "NULL", "NA", ""}) {
    const auto cast = parse_ctd(ctd_header + "41,3,31\n43," + cell + ",31.39\n45,2,32\n47," + cell + ",32\n");
    ASSERT_EQ(cast.rows.size(), 2u) << cell;
    EXPECT_EQ(temperature_at(cast.rows, 43), 2.5) << cell;  // between 3 and 2
    EXPECT_EQ(cast.warnings,
              std::vector<std::string>{"2 rows are skipped for missing values, the first in line 3: 'temperature_C' '" +
                                       std::string(cell) + "'"});
  }
  for (const char* row : {"43,9,99.999,1480,1025", "43,9,35,9999,1025", "43,9,35,1480,9999", "-9999,9,35,1480,1025",
                          "43,9,-9.99e-29,1480,1025", "nan,9,35,1480,1025", "43,9,-9,1480,1025"}) {
    const auto cast =
        parse_ctd("depth_m,temperature_C,salinity_psu,sound_speed_mps,density_kgpm3\n41,3,31,1480,1025\n" +
                  std::string(row) + "\n45,2,32,1481,1026\n");
    EXPECT_EQ(cast.rows.size(), 2u) << row;
    ASSERT_EQ(cast.warnings.size(), 1u) << row;
    EXPECT_THAT(cast.warnings[0], HasSubstr("1 row is skipped for missing values, the first in line 3: '")) << row;
  }
  EXPECT_THAT(
      ctd_error(ctd_header + "1,-999,35\n2,-999,35\n"),
      HasSubstr("needs two rows of increasing depth below the header; 2 rows are skipped for missing values, the "
                "first in line 2: 'temperature_C' '-999'"));
}

TEST(CtdFile, ValuesOfNinesThatWaterCanHaveAreValues) {
  const auto cast = parse_ctd(
      "depth_m,temperature_C,salinity_psu,density_kgpm3\n9,9.9,9,999\n9.9,9.99,9.9,999.9\n99,9,"
      "35,1025\n300,-1.7,35,1026\n");
  EXPECT_EQ(cast.rows.size(), 4u);
  EXPECT_TRUE(cast.warnings.empty());
}

TEST(CtdFile, WarnsOfValuesThatNoUsualWaterHas) {
  const auto cast = parse_ctd(
      "depth_m,temperature_C,salinity_psu,sound_speed_mps\n1,60,35,1800\n2,61,35,1500\n3,9,46,"
      "1500\n");
  EXPECT_EQ(cast.rows.size(), 3u);
  EXPECT_EQ(cast.warnings,
            (std::vector<std::string>{"line 2: 'temperature_C' '60' is unusual for water, which has -5 to 45; in 2 "
                                      "rows",
                                      "line 4: 'salinity_psu' '46' is unusual for water, which has 0 to 45",
                                      "line 2: 'sound_speed_mps' '1800' is unusual for water, which has 1350 to "
                                      "1700"}));
}

TEST(CtdFile, RefusesASpikeOfTheDepthWithItsLine) {
  for (const char* depth : {"150", "9999"})
    EXPECT_THAT(
        ctd_error(ctd_header + "0,8,35\n5,7,35\n" + depth + ",6,35\n10,6,35\n20,5,35\n30,4,35\n40,3,35\n60,1,35\n"),
        HasSubstr("line 4: a depth of " + std::string(depth) + " m is a spike: beside it the cast is at 10 m"));
  // At the end, and upwards.
  EXPECT_THAT(ctd_error(ctd_header + "0,8,35\n5,7,35\n10,6,35\n20,5,35\n9999,5,35\n"),
              HasSubstr("line 6: a depth of 9999 m is a spike"));
  EXPECT_THAT(ctd_error(ctd_header + "0,8,35\n5,7,35\n10,6,35\n0.1,6,35\n20,5,35\n30,4,35\n"),
              HasSubstr("line 5: the depth jumps between 10 and 0.1 m"));
  // One that is not the deepest, and one of some rows.
  EXPECT_THAT(ctd_error(ctd_header + "0,8,35\n5,7,35\n40,6,35\n41,6,35\n10,6,35\n20,5,35\n60,1,35\n"),
              HasSubstr("line 6: the depth jumps between 41 and 10 m"));
  // Among rows so near each other that no step after it is large.
  std::string fine = ctd_header + "0,20,35\n150,20,35\n151,20,35\n";
  for (int i = 1; i <= 600; ++i) fine += std::to_string(0.1 * i) + "," + std::to_string(20 - 0.01 * i) + ",35\n";
  EXPECT_THAT(ctd_error(fine), HasSubstr("a spike, or more than one cast"));
}

TEST(CtdFile, TakesTablesOfStandardDepths) {
  const auto cast = parse_ctd(ctd_header + "0,20,35\n10,19,35\n100,12,35\n1000,5,35\n6000,2,35\n");
  EXPECT_EQ(cast.rows.size(), 5u);
  EXPECT_TRUE(cast.warnings.empty());
  // Down and up.
  EXPECT_EQ(rows_of(ctd_header + "0,20,35\n200,12,35\n500,8,35\n1000,5,35\n500,8,35\n200,12,35\n0,20,35\n").size(), 4u);
}

/// A cast of 60 m whose temperature is 20 C less 0.1 C for each meter.
std::string cast_of(const std::vector<double>& depths_m) {
  std::string text = ctd_header;
  for (const double depth_m : depths_m)
    text += std::to_string(depth_m) + "," + std::to_string(20 - 0.1 * depth_m) + ",35\n";
  return text;
}

TEST(CtdFile, ReadsTheWayUpWhereThatIsTheCast) {
  std::vector<double> up_m;
  for (int i = 0; i <= 600; ++i) up_m.push_back(60 - 0.1 * i);
  std::vector<double> with_heave_m = up_m;
  with_heave_m.insert(with_heave_m.begin() + 1, {60.03, 60.01, 60.04, 59.98});
  std::vector<double> lowered_before_m = with_heave_m;
  lowered_before_m.insert(lowered_before_m.begin(), {55, 56.5, 58});
  for (const auto& depths_m : {up_m, with_heave_m, lowered_before_m}) {
    const auto rows = rows_of(cast_of(depths_m));
    for (const double depth_m : {0.5, 20.0, 35.0, 59.0})
      EXPECT_NEAR(temperature_at(rows, depth_m), 20 - 0.1 * depth_m, 1e-5);  // six decimals in the text
  }
}

TEST(CtdFile, TakesTheWayDownOfACastWithBothAndASoakAndHeave) {
  std::vector<double> depths_m;
  const auto go_to = [&](double depth_m) {
    for (double step_m = depth_m > depths_m.back() ? 0.5 : -0.5; std::abs(depths_m.back() - depth_m) > 0.4;)
      depths_m.push_back(depths_m.back() + step_m);
  };
  depths_m.push_back(0);
  for (const double depth_m : {10.0, 1.0, 30.0, 28.5, 60.0, 59.0, 60.0, 0.0}) go_to(depth_m);
  const auto rows = rows_of(cast_of(depths_m));
  EXPECT_EQ(rows.back().depth_m, 60);
  for (const double depth_m : {5.0, 29.0, 45.0}) EXPECT_NEAR(temperature_at(rows, depth_m), 20 - 0.1 * depth_m, 1e-5);
  // Another cast after it.
  go_to(60);
  EXPECT_THAT(ctd_error(cast_of(depths_m)), HasSubstr("a spike, or more than one cast"));
}

TEST(CtdFile, BeginsWithAByteOrderMarkOrNot) {
  EXPECT_EQ(rows_of("\xef\xbb\xbf" + ctd_header + "1,9,35\n2,8,35\n").size(), 2u);
}

TEST(CtdFile, IsTheProfileOfAWorld) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("ctd.csv")) << "depth_m,temperature_C,salinity_psu\n0,16,34.5\n15,14,34.8\n40,10,35\n";
  const auto read = [&](const std::string& keys) {
    return test_support::read_config<sim::WaterConfig>("{profile_file: " + folder.file("ctd.csv") + keys + "}");
  };
  EXPECT_EQ(read("").profile.size(), 3u);
  EXPECT_TRUE(read("").warnings.empty());
  std::ofstream(folder.file("flags.csv")) << "depth_m,temperature_C,salinity_psu\n0,16,34.5\n5,-9.99e-29,34\n9,14,35\n";
  test_support::LogCapture log;
  sim::load_world_text("shoal: 1\nmedium: {water: {profile_file: " + folder.file("flags.csv") + "}}\n", "w.yaml");
  EXPECT_THAT(log.text(), HasSubstr("medium: water: 'profile_file' '" + folder.file("flags.csv") +
                                    "' 1 row is skipped for missing values, the first in line 3: 'temperature_C' "
                                    "'-9.99e-29'"));
  EXPECT_THAT(test_support::config_error<sim::WaterConfig>("{profile_file: " + folder.file("none.csv") + "}"),
              HasSubstr("does not exist"));
  EXPECT_THROW(read(", profile: [{depth_m: 0}]"), sim::ConfigError);
}

}  // namespace
