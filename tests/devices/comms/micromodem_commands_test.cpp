// SPDX-License-Identifier: BSD-3-Clause
// What a Micro-Modem promises of its commands beyond a plain session (docs/models/modems.md).
#include <gmock/gmock.h>

#include "tests/devices/comms/micromodem_host.hpp"

namespace {

using devices::MicromodemPacket;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

using Modem = test::HostedMicromodem;

TEST(MicromodemCommands, EveryTransponderPingIsEchoedAndReported) {
  Modem modem;
  modem.host("$CCCFG,TAT,50");
  for (const std::string fields : {"PDT,1,1,0,0,2000,1,0,0,1", "PNT,26000,5,5,2000,25000,0,0,27000,1",
                                   "PGT,26000,28,3E5A,2000,25000,1f,0,0,8000000000000000,2000,0"}) {
    EXPECT_THAT(modem.host("$CC" + fields), ElementsAre("SN" + fields));
    EXPECT_THAT(modem.host("$CCMPC,1,2"), ElementsAre(HasSubstr("MPC,4,busy")));
    modem.protocol.beacon_answered(0, modem.now + sim::from_seconds(0.45));
    modem.protocol.beacon_answered(1, modem.now + sim::from_seconds(0.55));  // was not asked
    modem.protocol.beacon_answered(3, modem.now + sim::from_seconds(0.65));
    const auto reported = modem.wait(2.01);
    ASSERT_FALSE(reported.empty());
    // One way, without the turnaround of 50 ms.
    EXPECT_THAT(reported.back(), StartsWith("SNTTA,0.2000,,,0.3000,0506")) << fields;
  }
}

TEST(MicromodemCommands, TransponderPingsWaitForThePulseWhenAsked) {
  Modem modem;
  for (const char* line :
       {"$CCPDT,1,1,0,0,2000,1,0,0,1", "$CCPDT,1,1,1,0,2000,1,0,0,1", "$CCPNT,26000,5,5,2000,25000,0,0,0,1",
        "$CCPNT,26000,5,5,2000,25000,0,0,0,0", "$CCPGT,26000,28,3E5A,2000,25000,1f,0,0,0,2000,0"}) {
    modem.host(line);
    modem.wait(2.01);
  }
  EXPECT_THAT(modem.recorder.beacons_on_the_second, ElementsAre(false, true, false, true, false));
}

TEST(MicromodemCommands, BadFieldsOfATransponderPingAreRefused) {
  Modem modem;
  for (const char* line :
       {"$CCPGT", "$CCPGT,26000,28,xyz,2000,25000,1,0,0,0,2000,0", "$CCPGT,26000,65,1,2000,25000,1,0,0,0,2000,0",
        "$CCPGT,26000,28,1,0,25000,1,0,0,0,2000,0", "$CCPGT,26000,28,1,2000,25000,1,0,0,,2000,0",
        "$CCPGT,26000,28,1,2000,25000,1,0,0,123456789012345678901,2000,0"})
    EXPECT_THAT(modem.host(line), ElementsAre("CAERR,050607,NMEA,3,PGT has a field out of range")) << line;
  EXPECT_TRUE(modem.recorder.beacons_on_the_second.empty());
}

TEST(MicromodemCommands, DataForAnotherDestinationThanTheCyclesIsRefused) {
  Modem modem;
  modem.host("$CCCYC,0,1,2,0,0,1");
  EXPECT_THAT(modem.host("$CCTXD,1,3,0,aabb"), ElementsAre("CAERR,050607,TXD,3,the cycle is for 2 and the data for 3"));
  EXPECT_TRUE(modem.recorder.sent.empty());
  EXPECT_THAT(modem.host("$CCTXD,1,2,0,aabb"), ElementsAre("CATXD,1,2,0,2"));  // it still waits for it
  EXPECT_EQ(modem.recorder.sent.size(), 2u);
}

TEST(MicromodemCommands, SynchronousPacketsAndPingsWaitForTheSecondButAnswersDoNot) {
  Modem modem;
  modem.host("$CCCFG,SNV,1");
  modem.host("$CCMPC,1,2");
  modem.wait(9);
  modem.host("$CCMUC,1,2,0001");
  modem.wait(9);
  modem.host("$CCCYC,0,2,1,0,0,1");  // asks another to send
  EXPECT_THAT(modem.recorder.seconds, ElementsAre(true, true, true));
  modem.wait(30);
  modem.recorder.seconds.clear();
  MicromodemPacket ping;
  ping.kind = MicromodemPacket::Kind::ping;
  ping.source = 2, ping.destination = 1;
  devices::MicromodemArrival arrival;
  arrival.started = modem.now, arrival.ended = modem.now + sim::from_seconds(0.7);
  modem.protocol.receive(ping, arrival);
  EXPECT_THAT(modem.recorder.seconds, ElementsAre(false));
}

TEST(MicromodemCommands, OnlyAResetOfThisModemIsTaken) {
  Modem modem;
  EXPECT_THAT(modem.host("$CCMSC,1,2,0"), ElementsAre(StartsWith("CAERR,050607,MSC,3,only this modem")));
  EXPECT_THAT(modem.host("$CCMSC,2,1,0"), ElementsAre(StartsWith("CAERR,050607,MSC,3,only this modem")));
  for (const char* line : {"$CCMSC,1,1,-1", "$CCMSC,1,1,6", "$CCMSC,1,1"})
    EXPECT_THAT(modem.host(line), ElementsAre(StartsWith("CAERR,050607,MSC,3,the time to sleep"))) << line;
  EXPECT_THAT(modem.host("$CCMSC,1,1,0"), ElementsAre("CAMSC,1,1,0"));
}

}  // namespace
