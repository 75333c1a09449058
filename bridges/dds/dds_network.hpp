// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace bridges {

/// What a participant of DDS may reach: this machine, by loopback, and the hosts that the user names.
struct DdsNetwork {
  int domain = 0;                  ///< ROS_DOMAIN_ID
  bool searches = true;            ///< finds participants of this machine without being told their ports
  std::vector<std::string> peers;  ///< names or addresses of other hosts
  std::string interface;           ///< with addresses of this machine beside 127.0.0.1; empty: there is none
};

/// Value of a variable of the environment, or null.
using Environment = std::function<const char*(const char* name)>;

/// Adds to `peers` what ROS 2 reads from the environment:
///
/// - ROS_DOMAIN_ID: the domain
/// - ROS_STATIC_PEERS: further hosts, with semicolons between them
/// - ROS_AUTOMATIC_DISCOVERY_RANGE: OFF ends the search; no value widens it, since a subnet is never searched
/// - ROS_LOCALHOST_ONLY: 1 contradicts peers
///
/// and finds the interface.
///
/// Throws std::invalid_argument with the name of the variable or option, the rule and the value.
DdsNetwork dds_network(std::vector<std::string> peers, const Environment& environment);

/// Configuration of Cyclone DDS, in XML.  The interface is part of it also without peers: programs with default
/// settings announce only its addresses, and Cyclone DDS uses none of another interface.  DdsParticipant keeps the
/// sockets at the loopback interface, which reaches them too.
std::string cyclone_config(const DdsNetwork& network);

}  // namespace bridges
