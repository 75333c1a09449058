// SPDX-License-Identifier: BSD-3-Clause
// What a Micro-Modem promises of its commands beyond a plain session (docs/models/modems.md).
#include <gmock/gmock.h>

#include "tests/devices/comms/micromodem_host.hpp"
#include "tests/devices/comms/sentence_field.hpp"

namespace {

using devices::MicromodemPacket;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;
using Modem = test::HostedMicromodem;

Modem modem_of(const std::string& revision) {
  auto config = Modem::at_address(1);
  config.revision = revision;
  return Modem(config);
}

using test::field;

/// Clock mode in $CACST of a packet that comes now.
std::string clock_mode(Modem& modem) {
  MicromodemPacket packet;
  packet.source = 9, packet.destination = 1;
  modem.protocol.receive(packet, {});
  for (const std::string& reported : modem.recorder.take())
    if (reported.starts_with("CACST")) return field(reported, 3);
  return "no statistics";
}

TEST(MicromodemCommands, ConfigurationOfAllGivesFactorySettings) {
  auto config = Modem::at_address(5);
  config.synchronous = true;
  Modem modem(config);
  for (const char* line : {"$CCCFG,RXP,1", "$CCCFG,DTO,60", "$CCCFG,AGN,50"}) modem.host(line);
  EXPECT_THAT(modem.host("$CCCFG,ALL,0"), ElementsAre("CACFG,ALL,0"));
  EXPECT_EQ(modem.protocol.address(), 0);
  auto all = modem.host("$CCCFQ,ALL");
  std::vector<std::string> factory;
  const devices::MicromodemSettings settings;
  for (const auto& [name, value] : settings.all()) factory.push_back("CACFG," + name + "," + std::to_string(value));
  EXPECT_EQ(all, factory);
  EXPECT_THAT(all, Contains("CACFG,SNV,0"));
  EXPECT_THAT(modem.host("$CCCFG,ALL,1"), ElementsAre(StartsWith("CAERR,050607,NMEA,3,")));
  EXPECT_THAT(modem.host("$CCCFG,SRC,5"), ElementsAre("CACFG,SRC,5"));  // as a driver continues
}

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

TEST(MicromodemCommands, ClockModesAreThoseOfThePage) {
  Modem modem;
  EXPECT_EQ(clock_mode(modem), "0");
  modem.host("$CCCLK,2030,12,31,23,59,58");
  EXPECT_EQ(clock_mode(modem), "1");
  modem.host("$CCCFG,SNV,1");
  EXPECT_EQ(clock_mode(modem), "3");
  modem.protocol.restart(modem.now);
  modem.wait(0);
  EXPECT_EQ(clock_mode(modem), "2");  // settings stay, the time does not
  modem.host("$CCCLK,2030,12,31,23,59,58");
  EXPECT_EQ(clock_mode(modem), "3");

  auto config = Modem::at_address(1);
  config.synchronous = true;
  Modem synchronous(config);
  EXPECT_EQ(clock_mode(synchronous), "3");
  synchronous.host("$CCCLK,2030,12,31,23,59,58");
  synchronous.protocol.restart(synchronous.now);
  EXPECT_THAT(synchronous.wait(0), Contains(StartsWith("CAREV,050607,INIT")));  // the vehicle's time again
  EXPECT_EQ(clock_mode(synchronous), "3");
}

TEST(MicromodemCommands, WithThePulseTheClockLearnsWhichSecondItIsOnly) {
  for (const bool pulse : {false, true}) {
    Modem modem;
    if (pulse) modem.host("$CCCFG,SNV,1");
    modem.wait(0.4);
    modem.host("$CCCLK,2026,3,4,5,6,20");  // 12.6 s later than the vehicle's clock: with the pulse 13 s
    modem.wait(0.55);
    EXPECT_THAT(modem.host("$CCXYZ"), ElementsAre(StartsWith("CAERR,050620,")));  // 20.55 s, or 20.95
    modem.wait(0.1);
    EXPECT_THAT(modem.host("$CCXYZ"), ElementsAre(StartsWith(pulse ? "CAERR,050621," : "CAERR,050620,")));
  }
}

TEST(MicromodemCommands, ClockModesOfASecondGenerationAreBits) {
  Modem modem = modem_of("2.0.26038");
  EXPECT_EQ(clock_mode(modem), "4");  // no time; pulse of its own
  modem.host("$CCTMS,2030-12-31T23:59:58Z,0");
  EXPECT_EQ(clock_mode(modem), "6");  // set by the host
  modem.host("$CCCFG,SNV,1");
  EXPECT_EQ(clock_mode(modem), "14");  // and the pulse comes from outside
  Modem older = modem_of("2.0.26037");
  older.host("$CCTMS,2030-12-31T23:59:58Z,0");
  EXPECT_EQ(clock_mode(older), "1");
}

TEST(MicromodemCommands, ASecondGenerationTakesTheTimeByTms) {
  Modem modem = modem_of("2.0.16421");
  EXPECT_THAT(modem.host("$CCTMQ,0"), ElementsAre("CATMQ,2026-03-04T05:06:07Z,NONE,RTC"));
  EXPECT_THAT(modem.host("$CCTMS,2030-12-31T23:59:58Z,0"), ElementsAre("CATMS,0,2030-12-31T23:59:58Z"));
  modem.wait(1.2);
  EXPECT_THAT(modem.host("$CCTMQ,0"), ElementsAre("CATMQ,2030-12-31T23:59:59Z,USER_CMD,RTC"));
  EXPECT_THAT(modem.host("$CCTMS,2030-06-01T12:00:00.25Z,0"), ElementsAre("CATMS,0,2030-06-01T12:00:00Z"));
  // With the pulse: from the next whole second of the vehicle's clock on, 0.8 s from now.
  EXPECT_THAT(modem.host("$CCTMS,2031-01-01T00:00:00Z,1"), ElementsAre());
  EXPECT_THAT(modem.wait(0.79), ElementsAre());
  EXPECT_THAT(modem.wait(0.02), ElementsAre("CATMS,0,2031-01-01T00:00:00Z"));
  EXPECT_THAT(modem.host("$CCTMQ,0"), ElementsAre("CATMQ,2031-01-01T00:00:00Z,USER_CMD,RTC"));
  modem.wait(0.985);
  EXPECT_THAT(modem.host("$CCTMQ,0"), ElementsAre("CATMQ,2031-01-01T00:00:00Z,USER_CMD,RTC"));
  modem.wait(0.01);
  EXPECT_THAT(modem.host("$CCTMQ,0"), ElementsAre("CATMQ,2031-01-01T00:00:01Z,USER_CMD,RTC"));
}

TEST(MicromodemCommands, BadTimesAreRefused) {
  Modem modem = modem_of("2.0.16421");
  for (const char* line : {"$CCTMS", "$CCTMS,2030-12-31T23:59:58,0", "$CCTMS,2030-02-30T23:59:58Z,0",
                           "$CCTMS,2030-12-31T24:59:58Z,0", "$CCTMS,2030-12-31 23:59:58Z,0",
                           "$CCTMS,2030-12-31T23:59:58.Z,0", "$CCTMS,2030-12-31T23:59:58Z,2", "$CCTMQ", "$CCTMQ,1"})
    EXPECT_THAT(modem.host(line), ElementsAre(StartsWith("CAERR,050607,NMEA,3,"))) << line;
  EXPECT_EQ(clock_mode(modem), "0");
}

TEST(MicromodemCommands, AFirstGenerationDoesNotKnowTms) {
  Modem modem;  // 0.93.0.48
  EXPECT_THAT(modem.host("$CCTMS,2030-12-31T23:59:58Z,0"), ElementsAre("CAERR,050607,NMEA,1,unknown sentence CCTMS"));
  EXPECT_THAT(modem.host("$CCTMQ,0"), ElementsAre("CAERR,050607,NMEA,1,unknown sentence CCTMQ"));
}

TEST(MicromodemCommands, GenerationsAreReadFromTheRevision) {
  EXPECT_EQ(devices::micromodem_generation("0.93.0.48"), (std::array<int, 3>{0, 93, 0}));
  EXPECT_EQ(devices::micromodem_generation("2.0.26038"), devices::micromodem_clock_bits);
  EXPECT_EQ(devices::micromodem_generation("3"), (std::array<int, 3>{3, 0, 0}));
  EXPECT_EQ(devices::micromodem_generation("beta"), (std::array<int, 3>{0, 0, 0}));
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

TEST(MicromodemCommands, ATimeThatWaitsForThePulseIsState) {
  const auto hash_after = [](const std::vector<std::string>& lines) {
    Modem modem = modem_of("2.0.16421");
    for (const auto& line : lines) modem.host(line);
    auto archive = sim::StateArchive::hasher();
    archive(modem.protocol);
    return archive.hash();
  };
  EXPECT_NE(hash_after({}), hash_after({"$CCTMS,2031-01-01T00:00:00Z,1"}));
  EXPECT_NE(hash_after({"$CCTMS,2031-01-01T00:00:01Z,1"}), hash_after({"$CCTMS,2031-01-01T00:00:00Z,1"}));
}

}  // namespace
