// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/dds/dds_network.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <stdexcept>

namespace {

using bridges::cyclone_config;
using bridges::dds_network;
using bridges::DdsNetwork;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

DdsNetwork network_of(const std::map<std::string, std::string>& environment, std::vector<std::string> peers = {}) {
  return dds_network(std::move(peers), [&](const char* name) -> const char* {
    const auto found = environment.find(name);
    return found == environment.end() ? nullptr : found->second.c_str();
  });
}

std::string error_of(const std::map<std::string, std::string>& environment, std::vector<std::string> peers = {}) {
  try {
    network_of(environment, std::move(peers));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(DdsNetworkTest, WithoutOptionsItIsDomainZeroOfThisMachine) {
  const DdsNetwork network = network_of({});
  EXPECT_EQ(network.domain, 0);
  EXPECT_TRUE(network.searches);
  EXPECT_THAT(network.peers, IsEmpty());
  const std::string config = cyclone_config(network);
  EXPECT_THAT(config, HasSubstr("<AllowMulticast>spdp</AllowMulticast>"));
  EXPECT_THAT(config, HasSubstr(R"(<Peer address="127.0.0.1"/>)"));
}

TEST(DdsNetworkTest, KnowsTheInterfaceThatProgramsWithDefaultSettingsAnnounce) {
  DdsNetwork network;
  const std::string loopback = R"(<Interfaces><NetworkInterface name="lo" multicast="true"/>)";
  EXPECT_THAT(cyclone_config(network), HasSubstr(loopback + "</Interfaces>"));
  network.interface = "eth0";
  EXPECT_THAT(cyclone_config(network),
              HasSubstr(loopback + R"(<NetworkInterface name="eth0" multicast="true"/></Interfaces>)"));
  network.peers = {"192.0.2.1"};  // is searched by the interface that comes first
  EXPECT_THAT(cyclone_config(network), HasSubstr(R"(<NetworkInterface name="eth0" multicast="true" priority="10"/>)"));
  EXPECT_NE(network_of({}).interface, "lo");
}

TEST(DdsNetworkTest, ReadsTheVariablesOfRos2) {
  EXPECT_EQ(network_of({{"ROS_DOMAIN_ID", "42"}}).domain, 42);
  EXPECT_THAT(network_of({{"ROS_STATIC_PEERS", "192.0.2.7;;robot.local"}}, {"192.0.2.1"}).peers,
              ElementsAre("192.0.2.1", "192.0.2.7", "robot.local"));
  EXPECT_TRUE(network_of({{"ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET"}}).peers.empty());
  const DdsNetwork off = network_of({{"ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF"}}, {"192.0.2.1"});
  EXPECT_FALSE(off.searches);
  EXPECT_THAT(cyclone_config(off), Not(HasSubstr(R"(<Peer address="127.0.0.1"/>)")));
  EXPECT_THAT(cyclone_config(off), HasSubstr("<AllowMulticast>false</AllowMulticast>"));
}

TEST(DdsNetworkTest, NamesOfThisMachineAreNoPeers) {
  EXPECT_THAT(network_of({}, {"localhost", "127.0.1.1"}).peers, IsEmpty());
  EXPECT_THAT(cyclone_config(network_of({}, {"192.0.2.1"})), HasSubstr(R"(<Peer address="192.0.2.1"/></Peers>)"));
}

TEST(DdsNetworkTest, RefusesWhatIsNotAValue) {
  EXPECT_EQ(error_of({{"ROS_DOMAIN_ID", "233"}}), "ROS_DOMAIN_ID must be a whole number from 0 to 232, got '233'");
  EXPECT_EQ(error_of({{"ROS_DOMAIN_ID", "1x"}}), "ROS_DOMAIN_ID must be a whole number from 0 to 232, got '1x'");
  EXPECT_EQ(error_of({{"ROS_LOCALHOST_ONLY", "yes"}}), "ROS_LOCALHOST_ONLY must be 0 or 1, got 'yes'");
  EXPECT_EQ(error_of({{"ROS_AUTOMATIC_DISCOVERY_RANGE", "WORLD"}}),
            "ROS_AUTOMATIC_DISCOVERY_RANGE must be OFF, LOCALHOST, SUBNET or SYSTEM_DEFAULT, got 'WORLD'");
  EXPECT_EQ(error_of({}, {"a\"/><b"}), "--peer must be the name or address of a host, got 'a\"/><b'");
  EXPECT_EQ(error_of({{"ROS_LOCALHOST_ONLY", "1"}}, {"192.0.2.1"}),
            "ROS_LOCALHOST_ONLY=1 contradicts the peer '192.0.2.1'");
}

}  // namespace
