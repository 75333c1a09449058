// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/nmea/steering.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace {

using bridges::nmea::Steering;
using testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180;
const char* const apb = "$GPAPB,A,A,0.10,R,N,V,V,011,M,DEST,011,T,120.0,T";
const char* const rmb = "$GPRMB,A,0.66,L,003,004,4917.24,N,12309.57,W,001.3,052.5,000.5,V";

TEST(Steering, TheHeadingToSteerBecomesAYaw) {
  Steering steering(0);
  EXPECT_EQ(steering.take(sim::nmea_sentence(std::string(apb).substr(1)), 7), "");
  const auto command = steering.take_command();
  ASSERT_TRUE(command);
  EXPECT_EQ(command->utime, 7);
  EXPECT_NEAR(command->heading_rad, -30 * degree, 1e-12);  // 120 from north is 30 to the right of east
  EXPECT_TRUE(std::isnan(command->speed_mps));
  EXPECT_TRUE(std::isnan(command->depth_m));
  EXPECT_TRUE(std::isnan(command->altitude_m));
  EXPECT_FALSE(steering.take_command());  // once
}

TEST(Steering, AMagneticHeadingIsCorrectedByTheVariation) {
  Steering steering(-14);
  EXPECT_EQ(steering.take("$GPAPB,A,A,,,,,,,,,,,100,M", 0), "");
  EXPECT_NEAR(steering.take_command()->heading_rad, 4 * degree, 1e-12);  // 86 from true north
}

TEST(Steering, RmbSteersToItsDestinationUnlessApbCame) {
  Steering steering(0);
  EXPECT_EQ(steering.take(rmb, 0), "");
  EXPECT_NEAR(steering.take_command()->heading_rad, 37.5 * degree, 1e-12);
  EXPECT_EQ(steering.take(apb, 1'000'000), "");
  EXPECT_EQ(steering.take(rmb, 1'100'000), "");
  EXPECT_NEAR(steering.take_command()->heading_rad, -30 * degree, 1e-12);
  EXPECT_EQ(steering.take(rmb, 1'000'000 + Steering::prefer_apb_us), "");
  EXPECT_NEAR(steering.take_command()->heading_rad, 37.5 * degree, 1e-12);
}

TEST(Steering, WarningsAndMistakesDoNotSteer) {
  Steering steering(0);
  EXPECT_THAT(steering.take("$GPAPB,V,A,0.10,R,N,V,V,011,M,DEST,011,T,120.0,T", 0), HasSubstr("its status is V"));
  EXPECT_THAT(steering.take("$GPAPB,A,V,0.10,R,N,V,V,011,M,DEST,011,T,120.0,T", 0), HasSubstr("its status is V"));
  EXPECT_THAT(steering.take("$GPAPB,A,A,0.10,R,N,V,V,011,M,DEST,011,T,,T", 0), HasSubstr("no heading to steer"));
  EXPECT_THAT(steering.take("$GPAPB,A,A,0.10,R,N,V,V,011,M,DEST,011,T,1e9,T", 0), HasSubstr("APB has a field"));
  EXPECT_THAT(steering.take("$GPRMB,V", 0), HasSubstr("RMB is not followed: its status is V"));
  EXPECT_THAT(steering.take("$GPRMB,A,,,,,,,,,,,", 0), HasSubstr("no bearing"));
  EXPECT_THAT(steering.take("$GPRMB,A,x", 0), HasSubstr("RMB has a field"));
  EXPECT_THAT(steering.take(std::string(apb) + "*00", 0), HasSubstr("checksum"));
  EXPECT_THAT(steering.take("GET / HTTP/1.1", 0), HasSubstr("must be a sentence of NMEA 0183"));
  EXPECT_EQ(steering.take("$GPRMC,,V", 0), "");  // of no concern
  EXPECT_FALSE(steering.take_command());
}

}  // namespace
