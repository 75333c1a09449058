// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/dds/dds_network.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <stdexcept>
#include <string_view>

namespace bridges {
namespace {

std::string_view value_of(const Environment& environment, const char* name) {
  const char* value = environment(name);
  return value == nullptr ? std::string_view() : std::string_view(value);
}

[[noreturn]] void refuse(const std::string& name, const std::string& rule, std::string_view value) {
  throw std::invalid_argument(name + " must be " + rule + ", got '" + std::string(value.substr(0, 100)) + "'");
}

/// The ports of domain 232 are the last below 65536; see DDSI-RTPS 2.3, section 9.6.1.
int domain_of(std::string_view text) {
  constexpr int last = 232;
  int domain = 0;
  if (text.empty()) return domain;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), domain);
  if (error != std::errc{} || end != text.data() + text.size() || domain < 0 || domain > last)
    refuse("ROS_DOMAIN_ID", "a whole number from 0 to 232", text);
  return domain;
}

/// A name or an address; nothing that has a meaning in XML.
void check_host(const std::string& source, std::string_view host) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view(".:-_%[]").find(c) != std::string_view::npos;
  };
  if (host.empty() || host.size() > 253 || !std::all_of(host.begin(), host.end(), allowed))
    refuse(source, "the name or address of a host", host);
}

/// Hosts with a semicolon between them.
void add_static_peers(std::string_view text, std::vector<std::string>& peers) {
  while (!text.empty()) {
    const std::string_view host = text.substr(0, text.find(';'));
    text.remove_prefix(std::min(text.size(), host.size() + 1));
    if (host.empty()) continue;
    check_host("ROS_STATIC_PEERS", host);
    peers.emplace_back(host);
  }
}

bool is_this_machine(std::string_view host) {
  return host == "localhost" || host.starts_with("127.") || host == "::1";
}

/// Returns the first interface with an address of IPv4 that other machines may know; empty: there is none.
std::string first_interface() {
  constexpr std::uint32_t link_local = 0xa9fe0000, first_two_bytes = 0xffff0000;
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return "";
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(all, freeifaddrs);
  for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    const std::uint32_t address = ntohl(reinterpret_cast<const sockaddr_in*>(each->ifa_addr)->sin_addr.s_addr);
    const bool is_up = (each->ifa_flags & IFF_UP) != 0 && (each->ifa_flags & IFF_LOOPBACK) == 0;
    if (is_up && (address & first_two_bytes) != link_local) return each->ifa_name;
  }
  return "";
}

}  // namespace

DdsNetwork dds_network(std::vector<std::string> peers, const Environment& environment) {
  constexpr std::array ranges{"", "OFF", "LOCALHOST", "SUBNET", "SYSTEM_DEFAULT"};
  DdsNetwork network;
  network.domain = domain_of(value_of(environment, "ROS_DOMAIN_ID"));
  for (const std::string& peer : peers) check_host("--peer", peer);
  network.peers = std::move(peers);
  add_static_peers(value_of(environment, "ROS_STATIC_PEERS"), network.peers);
  std::erase_if(network.peers, is_this_machine);
  const std::string_view range = value_of(environment, "ROS_AUTOMATIC_DISCOVERY_RANGE");
  if (std::find(ranges.begin(), ranges.end(), range) == ranges.end())
    refuse("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF, LOCALHOST, SUBNET or SYSTEM_DEFAULT", range);
  network.searches = range != "OFF";
  const std::string_view local = value_of(environment, "ROS_LOCALHOST_ONLY");
  if (!local.empty() && local != "0" && local != "1") refuse("ROS_LOCALHOST_ONLY", "0 or 1", local);
  if (local == "1" && !network.peers.empty())
    throw std::invalid_argument("ROS_LOCALHOST_ONLY=1 contradicts the peer '" + network.peers.front() + "'");
  network.interface = first_interface();
  return network;
}

std::string cyclone_config(const DdsNetwork& network) {
  // Fast DDS and Cyclone DDS take the first free of these ports on a machine.
  constexpr int participants_of_a_machine = 32;
  // Cyclone DDS searches peers by the first interface, and the loopback interface does not reach other machines.
  const std::string first = network.peers.empty() ? "" : R"( priority="10")";
  std::string interfaces = R"(<NetworkInterface name="lo" multicast="true"/>)";
  if (!network.interface.empty())
    interfaces += "<NetworkInterface name=\"" + network.interface + R"(" multicast="true")" + first + "/>";
  std::string peers;
  if (network.searches) peers = R"(<Peer address="127.0.0.1"/>)";
  for (const std::string& peer : network.peers) peers += "<Peer address=\"" + peer + "\"/>";
  // Only the search is by multicast: others would send theirs to their own interface.  It is repeated each second, for
  // a program at another interface does not search here.  A writer holds the last ten messages for a reader that lost
  // some, images too.
  return "<CycloneDDS><Domain id=\"any\"><General><Interfaces>" + interfaces + "</Interfaces><AllowMulticast>" +
         (network.searches ? "spdp" : "false") +
         "</AllowMulticast><MulticastRecvNetworkInterfaceAddresses>127.0.0.1</MulticastRecvNetworkInterfaceAddresses>"
         "<MaxMessageSize>65500B</MaxMessageSize><FragmentSize>16000B</FragmentSize></General>"
         "<Discovery><SPDPInterval>1s</SPDPInterval><ParticipantIndex>auto</"
         "ParticipantIndex><MaxAutoParticipantIndex>" +
         std::to_string(participants_of_a_machine) + "</MaxAutoParticipantIndex><Peers>" + peers +
         "</Peers></Discovery><Internal><SocketReceiveBufferSize min=\"default\" max=\"4MB\"/>"
         "<Watermarks><WhcHigh>64MB</WhcHigh></Watermarks></Internal></Domain></CycloneDDS>";
}

}  // namespace bridges
