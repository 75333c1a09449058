// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/micromodem_settings.hpp"

#include <gmock/gmock.h>

#include "devices/comms/micromodem_protocol.hpp"
#include "tests/devices/comms/micromodem_host.hpp"

namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

using Modem = test::HostedMicromodem;

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

TEST(MicromodemProtocol, KeepsItsSettings) {
  Modem modem;
  EXPECT_THAT(modem.host("$CCCFG,SRC,5"), ElementsAre("CACFG,SRC,5"));
  EXPECT_THAT(modem.host("$CCCFQ,SRC"), ElementsAre("CACFG,SRC,5"));
  EXPECT_EQ(modem.protocol.address(), 5);
  EXPECT_THAT(modem.host("$CCCFG,SNV,1"), ElementsAre("CACFG,SNV,1"));
  EXPECT_THAT(modem.host("$CCCFG,SNV,7"), ElementsAre(HasSubstr("out of range")));
  EXPECT_THAT(modem.host("$CCCFQ,SNV"), ElementsAre("CACFG,SNV,1"));
  const auto all = modem.host("$CCCFQ,ALL");
  EXPECT_GT(all.size(), 30u);
  for (const auto& line : all) EXPECT_THAT(line, StartsWith("CACFG,"));
}

}  // namespace
