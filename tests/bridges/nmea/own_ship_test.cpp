// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/nmea/own_ship.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "bridges/nmea/sentences.hpp"

namespace {

using bridges::nmea::OwnShip;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::int64_t new_year_us = 20454LL * 86'400'000'000;  // 2026-01-01
constexpr double degree = std::numbers::pi / 180;

std::string line(const std::string& body) {
  return sim::nmea_sentence(body);
}

shoal::gps_data_t fix() {
  shoal::gps_data_t gps{};
  gps.gps_lock = 1;
  gps.latitude = 42.5;
  gps.longitude = -70.25;
  gps.elev = 3;
  gps.numSatellites = 9;
  gps.speed = 1852.0 / 3600;  // a knot
  gps.heading = -0.5 * std::numbers::pi;
  gps.gps_time = static_cast<double>(new_year_us) * 1e-6;
  return gps;
}

/// By a rotation about z.
shoal::ins_t heading(double yaw_rad, double turn_left_radps = 0) {
  shoal::ins_t ins{};
  ins.quat[0] = std::cos(yaw_rad / 2);
  ins.quat[3] = std::sin(yaw_rad / 2);
  ins.gyro[2] = turn_left_radps;
  return ins;
}

OwnShip ship() {
  OwnShip own;
  own.set_time(new_year_us);
  return own;
}

TEST(OwnShip, SaysNothingWithoutDevices) {
  EXPECT_THAT(ship().sentences(), IsEmpty());
}

TEST(OwnShip, AFixGivesPositionCourseAndSpeed) {
  OwnShip own = ship();
  own.has_gps();
  own.receive(fix());
  EXPECT_THAT(own.sentences(), ElementsAre(line("GPRMC,000000.00,A,4230.0000,N,07015.0000,W,1.00,270.0,010126,,,A"),
                                           line("GPGGA,000000.00,4230.0000,N,07015.0000,W,1,09,,3.00,M,0.0,M,,"),
                                           line("GPVTG,270.0,T,,M,1.00,N,1.85,K,A")));
}

TEST(OwnShip, WithoutAFixOrReportsTheReceiverWarns) {
  const auto warnings = ElementsAre(line("GPRMC,000000.00,V,,,,,,,010126,,,N"),
                                    line("GPGGA,000000.00,,,,,0,00,,,M,,M,,"), line("GPVTG,,T,,M,,N,,K,N"));
  OwnShip own = ship();
  own.has_gps();
  EXPECT_THAT(own.sentences(), warnings);
  shoal::gps_data_t lost = fix();
  lost.gps_lock = 0;
  lost.latitude = lost.longitude = std::numeric_limits<double>::quiet_NaN();
  own.receive(lost);
  EXPECT_THAT(own.sentences(), warnings);
  // A receiver that is silent for more than 5 s has no fix either.
  own.receive(fix());
  own.set_time(new_year_us + OwnShip::stale_us + 1'000'000);
  EXPECT_EQ(own.sentences().front(), line("GPRMC,000006.00,V,,,,,,,010126,,,N"));
}

TEST(OwnShip, AYawToTheLeftFromEastIsAHeadingFromNorth) {
  OwnShip own = ship();
  // 30 degrees to the left of east are 60 degrees; 0.01 rad/s to the left are -34.4 degrees per minute.
  own.receive(heading(30 * degree, 0.01));
  EXPECT_THAT(own.sentences(), ElementsAre(line("HEHDT,60.0,T"), line("TIROT,-34.4,A"), line("YXXDR,A,0.00,D,PTCH"),
                                           line("YXXDR,A,0.00,D,ROLL")));
  own.receive(heading(90.01 * degree));
  EXPECT_EQ(own.sentences().front(), line("HEHDT,0.0,T"));  // and not 360.0
}

TEST(OwnShip, ACompassGivesTheHeadingWhereThereIsNoAhrs) {
  OwnShip own = ship();
  shoal::compass_t compass{};
  compass.heading_true_rad = 271 * degree;
  own.receive(compass);
  EXPECT_THAT(own.sentences(), ElementsAre(line("HEHDT,271.0,T")));
}

TEST(OwnShip, PitchAndRollHaveTheSignsOfShips) {
  OwnShip own = ship();
  shoal::inclination_t inclination{};
  inclination.roll_rad = 2 * degree;   // left side up: starboard down
  inclination.pitch_rad = 3 * degree;  // nose down
  own.receive(inclination);
  EXPECT_THAT(own.sentences(), ElementsAre(line("YXXDR,A,-3.00,D,PTCH"), line("YXXDR,A,2.00,D,ROLL")));
}

TEST(OwnShip, SpeedThroughTheWaterAndDepthsAreInEachUnit) {
  OwnShip own = ship();
  shoal::dvl_t dvl{};
  dvl.bottom_lock = dvl.water_lock = 1;
  dvl.altitude_m = 18.288;  // 60 feet, 10 fathoms
  dvl.water_velocity_mps[0] = 1.852 / 3.6;
  own.receive(dvl);
  shoal::pressure_t pressure{};
  pressure.depth_m = 2;
  pressure.temperature_C = 11.5;
  own.receive(pressure);
  EXPECT_THAT(own.sentences(),
              ElementsAre(line("VWVHW,,T,,M,1.00,N,1.85,K"), line("SDDBT,60.0,f,18.29,M,10.0,F"),
                          line("SDDPT,18.29,2.00"), line("YXXDR,D,2.00,M,DEPTH"), line("YXXDR,C,11.50,C,TEMP")));
}

TEST(OwnShip, InvalidReportsAreNotSent) {
  OwnShip own = ship();
  own.receive(shoal::dvl_t{});
  own.receive(shoal::sonar_range_t{});
  own.receive(shoal::water_speed_t{});
  own.receive(shoal::ctd_t{});
  shoal::ins_t imu{};
  for (double& q : imu.quat) q = std::numeric_limits<double>::quiet_NaN();
  own.receive(imu);
  EXPECT_THAT(own.sentences(), IsEmpty());
}

TEST(OwnShip, WindIsFromTheBowAndInKnots) {
  OwnShip own = ship();
  shoal::wind_t wind{};
  wind.valid = 1;
  wind.apparent_speed_mps = 10 * 1852.0 / 3600;
  wind.apparent_angle_rad = -45 * degree;  // from port ahead
  wind.true_speed_mps = 5 * 1852.0 / 3600;
  wind.true_angle_rad = 90 * degree;
  own.receive(wind);
  EXPECT_THAT(own.sentences(), ElementsAre(line("WIMWV,315.0,R,10.0,N,A"), line("WIMWV,90.0,T,5.0,N,A")));
  wind.valid = 0;
  own.receive(wind);
  EXPECT_THAT(own.sentences(), ElementsAre(line("WIMWV,,R,,N,V"), line("WIMWV,,T,,N,V")));
}

TEST(OwnShip, WhatIsOldIsLeftOut) {
  OwnShip own = ship();
  own.receive(heading(0));
  own.set_time(new_year_us + OwnShip::stale_us);
  EXPECT_EQ(own.sentences().size(), 4u);
  own.set_time(new_year_us + OwnShip::stale_us + 1);
  EXPECT_THAT(own.sentences(), IsEmpty());
}

}  // namespace
