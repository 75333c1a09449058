// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/devices/comms/micromodem_host.hpp"
#include "tests/devices/comms/sentence_field.hpp"

namespace {

using devices::MicromodemPacket;
using testing::Contains;
using testing::ElementsAre;
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
