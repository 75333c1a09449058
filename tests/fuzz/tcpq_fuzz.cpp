// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/tcpq_server.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// Bytes of a client to the server of tcpq, after its greeting.

SHOAL_FUZZ_TARGET(tcpq) {
  using bridges::TcpqRequest;
  std::string_view bytes = fuzz::text_of(input);
  bridges::ChannelPatterns patterns;
  for (std::optional<TcpqRequest> request;; bytes.remove_prefix(request->size)) {
    if (bridges::read_tcpq_request(bytes, request)) return;
    if (!request) return;
    fuzz::require(request->size <= bytes.size() && request->size >= 8, "a request is within its bytes");
    const std::string channel(request->channel);
    switch (request->kind) {
      case TcpqRequest::Kind::publish:
        fuzz::require(channel.size() <= 63, "a channel has a limit");
        patterns.matches(channel);
        break;
      case TcpqRequest::Kind::subscribe:
        if (!patterns.add(channel) && channel.find_first_not_of("abc.") == std::string::npos && !channel.empty())
          fuzz::require(patterns.matches(channel), "a plain name matches itself");
        break;
      case TcpqRequest::Kind::unsubscribe:
        patterns.remove(channel);
    }
  }
}
