// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/listen_addresses.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <memory>

#include "bridges/web/web_error.hpp"

namespace bridges {

namespace {

std::string numeric_address(const addrinfo& info) {
  std::array<char, NI_MAXHOST> text{};
  if (getnameinfo(info.ai_addr, info.ai_addrlen, text.data(), text.size(), nullptr, 0, NI_NUMERICHOST) != 0) return {};
  return text.data();
}

bool is_loopback(const std::string& address) {
  return address.starts_with("127.") || address == "::1";
}

}  // namespace

ListenAddresses find_listen_addresses(const std::string& host) {
  if (host == "localhost" || host == "127.0.0.1") return {{"127.0.0.1", "::1"}, true};

  // Ask the system
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* list = nullptr;
  const int error = host.empty() ? EAI_NONAME : getaddrinfo(host.c_str(), nullptr, &hints, &list);
  if (error != 0) throw WebError("host '" + host + "' to listen on: " + gai_strerror(error));
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(list, freeaddrinfo);

  // Each address once
  ListenAddresses result;
  for (const addrinfo* each = list; each != nullptr; each = each->ai_next) {
    std::string address = numeric_address(*each);
    if (!address.empty() && std::find(result.numeric.begin(), result.numeric.end(), address) == result.numeric.end())
      result.numeric.push_back(std::move(address));
  }
  if (result.numeric.empty()) throw WebError("host '" + host + "' to listen on: has no address");
  result.only_this_machine = std::all_of(result.numeric.begin(), result.numeric.end(), is_loopback);
  return result;
}

}  // namespace bridges
