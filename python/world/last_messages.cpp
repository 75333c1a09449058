// SPDX-License-Identifier: BSD-3-Clause
#include "python/world/last_messages.hpp"

namespace python {

void LastMessages::publish(std::string_view channel, std::span<const std::byte> payload, sim::Time at) {
  auto found = last_.find(channel);
  if (found == last_.end()) found = last_.emplace(channel, sim::Bytes()).first;
  found->second.assign(payload.begin(), payload.end());
  bus_.publish(channel, payload, at);
}

const sim::Bytes* LastMessages::find(std::string_view channel) const {
  const auto found = last_.find(channel);
  return found == last_.end() ? nullptr : &found->second;
}

}  // namespace python
