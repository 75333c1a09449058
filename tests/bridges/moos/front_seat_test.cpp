// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/front_seat.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "shoal/actuator_command_t.hpp"
#include "shoal/helm_command_t.hpp"
#include "shoal/message_codec.hpp"

namespace {

using bridges::GobyFrontSeat;
using bridges::HeronFrontSeat;
using testing::ElementsAre;

bridges::VehicleNavigation at_sea() {
  bridges::VehicleNavigation navigation("a");
  shoal::gps_data_t gps{};
  gps.gps_lock = 1;
  gps.latitude = 42.3584;
  gps.longitude = -71.0876;
  gps.speed = 2;
  navigation.take(gps);
  shoal::compass_t compass{};
  compass.heading_true_rad = std::numbers::pi / 2;
  navigation.take(compass);
  return navigation;
}

TEST(GobyFrontSeat, GivesControlAfterStartAndSteersByCommands) {
  GobyFrontSeat seat("a.autopilot.cmd");
  EXPECT_EQ(seat.take("CMD,HEADING:90,SPEED:1,DEPTH:0", 0).lines, "CMD,RESULT:FAIL\r\n");
  EXPECT_EQ(seat.state(at_sea(), 0), "");
  EXPECT_EQ(seat.take("START,LAT:42.1,LON:-72,DURATION:0,FREQ:10,WARP:1", 0).lines, "CTRL,STATE:PAYLOAD\r\n");
  EXPECT_EQ(seat.state(at_sea(), 0), "NAV,LAT:42.35840000,LON:-71.08760000,DEPTH:0.000,HEADING:90.000,SPEED:2.000\r\n");
  const auto reply = seat.take("CMD,HEADING:0,SPEED:1.5,DEPTH:3", 5);
  EXPECT_EQ(reply.lines, "CMD,RESULT:OK\r\n");
  ASSERT_EQ(reply.commands.size(), 1U);
  EXPECT_EQ(reply.commands[0].channel, "a.autopilot.cmd");
  const auto helm = shoal::decode<shoal::helm_command_t>(reply.commands[0].payload, shoal::Finite::any);
  EXPECT_NEAR(helm.heading_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_EQ(helm.speed_mps, 1.5);
  EXPECT_EQ(helm.depth_m, 3);
  for (const char* line : {"CMD,HEADING:north", "CMD,HEADING", "CMD,ROLL:3", "CMD,SPEED:inf"})
    EXPECT_EQ(seat.take(line, 0).lines, "CMD,RESULT:FAIL\r\n") << line;
  EXPECT_EQ(seat.take("", 0).lines, "");
  EXPECT_EQ(seat.refused(), 6U);
  seat.begin();  // the next back seat
  EXPECT_EQ(seat.state(at_sea(), 0), "");
}

TEST(HeronFrontSeat, TakesTheSpeedsOfBothPropellers) {
  HeronFrontSeat seat({"a.port.cmd", "a.starboard.cmd", 200});
  const auto reply = seat.take("$PYDIR,50,-100.0", 3);
  ASSERT_EQ(reply.commands.size(), 2U);
  EXPECT_EQ(reply.commands[0].channel, "a.port.cmd");
  const auto value_of = [&](std::size_t i) {
    return shoal::decode<shoal::actuator_command_t>(reply.commands[i].payload, shoal::Finite::required).value;
  };
  EXPECT_EQ(value_of(0), 100);
  EXPECT_EQ(value_of(1), -200);
  // Exclusive or of the characters of PYDIR,0,0: 0x50^0x59^0x44^0x49^0x52 = 0x56, and two commas and two zeros cancel.
  EXPECT_EQ(seat.take("$PYDIR,0,0*56", 0).commands.size(), 2U);
  EXPECT_EQ(seat.take("$PYDIR,0,0*57", 0).commands.size(), 0U);
  for (const char* line : {"PYDIR,0,0", "$PYDIR,0", "$PYDIR,a,b", "$PYDEV,0,0", "$", "$*"})
    EXPECT_EQ(seat.take(line, 0).commands.size(), 0U) << line;
  EXPECT_EQ(seat.refused(), 7U);
}

TEST(HeronFrontSeat, ReportsPositionVelocityAndCompass) {
  const HeronFrontSeat seat({"a.port.cmd", "a.starboard.cmd", 1});
  // 42.3584 deg is 42 deg and 21.504 min, 71.0876 deg is 71 deg and 5.256 min; 3661.5 s of the day are 01:01:01.5.
  const std::string state = seat.state(at_sea(), 3'661'500'000);
  EXPECT_THAT(state,
              testing::StartsWith("$CPNVG,010101.50,4221.5040,N,07105.2560,W,1,0,0.00,90.00,0.00,0.00,010101.50*"));
  EXPECT_THAT(state, testing::HasSubstr("\r\n$CPNVR,010101.50,2.000,0.000,0,0,0,0*"));
  EXPECT_THAT(state, testing::HasSubstr("\r\n$CPRCM,010101.50,0,90.00,0.00,0.00,010101.50*"));
}

TEST(LineReader, SplitsAndDropsLinesThatAreTooLong) {
  bridges::LineReader lines;
  EXPECT_THAT(lines.add("a\r\nb"), ElementsAre("a"));
  EXPECT_THAT(lines.add("c\n\n\r\n" + std::string(5000, 'x')), ElementsAre("bc"));
  EXPECT_THAT(lines.add("x\nd\n"), ElementsAre("d"));
}

}  // namespace
