// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/trajectory/estimate_file.hpp"

#include <gtest/gtest.h>

#include "sim/config/diagnostics.hpp"

namespace {

using experiment::EstimateFile;
using experiment::parse_estimates;

std::string estimate_error(const std::string& text) {
  try {
    parse_estimates(text, "mine.csv");
    return "none";
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
}

TEST(EstimateFile, ReadsNamedColumnsInAnyOrder) {
  const EstimateFile file = parse_estimates("y, note, t, x\n2, boat, 0, 1\n", "f");
  EXPECT_EQ(file.rows[0].position_m, sim::Vector3d(1, 2, 0));
  EXPECT_FALSE(file.has_height);
}

TEST(EstimateFile, IgnoresNamesOfShoalNavBesideATime) {
  const EstimateFile file = parse_estimates("t,x,y,z,time_s,x_m,cov_xx_m2\n0,1,2,3,7,8,9\n", "f");
  EXPECT_EQ(file.rows[0].time_s, 0);
  EXPECT_EQ(file.rows[0].position_m, sim::Vector3d(1, 2, 3));
  EXPECT_TRUE(file.has_height);
  EXPECT_FALSE(file.rows[0].covariance_m2);
}

TEST(EstimateFile, ReadsColumnsWithoutNames) {
  EXPECT_EQ(parse_estimates("0,1,2\r\n1,3,4\r\n", "f").rows[1].position_m, sim::Vector3d(3, 4, 0));
  EXPECT_EQ(parse_estimates("0,1,2,-5\n", "f").rows[0].position_m, sim::Vector3d(1, 2, -5));
}

TEST(EstimateFile, ReadsCovariances) {
  const EstimateFile flat = parse_estimates("t,x,y,xx,xy,yy\n0,0,0,4,1,2\n", "f");
  ASSERT_TRUE(flat.rows[0].covariance_m2);
  EXPECT_EQ((*flat.rows[0].covariance_m2)(0, 0), 4);
  EXPECT_EQ((*flat.rows[0].covariance_m2)(1, 0), 1);
  const EstimateFile whole = parse_estimates("t,x,y,z,xx,xy,xz,yy,yz,zz\n0,0,0,0,4,0,0,4,1,2\n", "f");
  EXPECT_EQ((*whole.rows[0].covariance_m2)(2, 1), 1);
}

TEST(EstimateFile, ReadsFilesOfShoalNav) {
  const EstimateFile file = parse_estimates(
      "time_s,utime,x_m,y_m,z_m,vx_mps,vy_mps,yaw_rad,cov_xx_m2,cov_xy_m2,cov_yy_m2\n"
      "2.5,2500000,1,2,-3,0,0,0,4,1,2\n",
      "f");
  EXPECT_EQ(file.rows[0].time_s, 2.5);
  EXPECT_EQ(file.rows[0].position_m, sim::Vector3d(1, 2, 0));
  EXPECT_FALSE(file.has_height);  // the filter estimates none
  EXPECT_EQ((*file.rows[0].covariance_m2)(1, 1), 2);
}

TEST(EstimateFile, RefusesWhatItCannotUse) {
  EXPECT_EQ(estimate_error(""), "mine.csv:1:1: must have an estimate");
  EXPECT_EQ(estimate_error("1 2 3\n"),
            "mine.csv:1:1: must be a TUM file, of 8 columns t x y z qx qy qz qw, or a CSV; got 3 columns");
  EXPECT_EQ(estimate_error("0,1\n"),
            "mine.csv:1:1: a CSV without names must have the columns t, x, y or t, x, y, z; got 2");
  EXPECT_EQ(estimate_error("time,x,y\n"),
            "mine.csv:1:1: the columns must include t; columns that are read: t, x, y, z, xx, xy, yy, xz, yz, zz");
  EXPECT_EQ(estimate_error("t,x,x,y\n"), "mine.csv:1:5: each column must be named once, got 'x'");
  EXPECT_EQ(estimate_error("t,x,y,xx\n"), "mine.csv:1:1: a covariance needs the column xy");
  EXPECT_EQ(estimate_error("t,x,y,xx,xy,yy,zz\n"), "mine.csv:1:1: a covariance with z needs the column z");
  EXPECT_EQ(estimate_error("t,x,y\n1,2,3\n1,2,3\n"), "mine.csv:3:1: times must increase, got '1'");
  EXPECT_EQ(estimate_error("t,x,y\n1,2,nan\n"),
            "mine.csv:2:5: y must be a number from -1000000000 to 1000000000, got 'nan'");
  EXPECT_EQ(estimate_error("t,x,y\n1,2\n"), "mine.csv:2:1: must have 3 columns, as the first line, got 2");
  EXPECT_EQ(estimate_error("t,x,y,xx,xy,yy\n0,0,0,1,2,1\n"), "mine.csv:2:7: the covariance must be positive definite");
  EXPECT_EQ(estimate_error("0 0 0 0 0 0 0 7\n"),
            "mine.csv:1:15: a quaternion must be a number from -1.01 to 1.01, got '7'");
}

using experiment::EstimateFile;
using experiment::parse_estimates;

TEST(EstimateFile, ReadsTum) {
  const EstimateFile file = parse_estimates("# t x y z qx qy qz qw\n0.5 1 -2 3e0 0 0 0 1\n\n1.5\t4 5 6 0 0 1 0\n", "f");
  ASSERT_EQ(file.rows.size(), 2u);
  EXPECT_EQ(file.rows[0].time_s, 0.5);
  EXPECT_EQ(file.rows[0].position_m, sim::Vector3d(1, -2, 3));
  EXPECT_EQ(file.rows[1].position_m, sim::Vector3d(4, 5, 6));
  EXPECT_TRUE(file.has_height);
  EXPECT_FALSE(file.rows[0].covariance_m2);
}

}  // namespace
