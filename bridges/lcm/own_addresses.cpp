// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/own_addresses.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netinet/in.h>

#include <algorithm>

namespace bridges {

OwnAddresses::OwnAddresses() {
  read();
}

bool OwnAddresses::contain(std::uint32_t address) {
  if (address >> 24 == IN_LOOPBACKNET) return true;
  const auto known = [&] { return std::find(addresses_.begin(), addresses_.end(), address) != addresses_.end(); };
  if (known()) return true;
  if (std::chrono::steady_clock::now() - read_at_ < std::chrono::seconds(1)) return false;
  read();
  return known();
}

void OwnAddresses::read() {
  read_at_ = std::chrono::steady_clock::now();
  addresses_.clear();
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next)
    if (entry->ifa_addr != nullptr && entry->ifa_addr->sa_family == AF_INET)
      addresses_.push_back(ntohl(reinterpret_cast<const sockaddr_in*>(entry->ifa_addr)->sin_addr.s_addr));
  freeifaddrs(list);
}

}  // namespace bridges
