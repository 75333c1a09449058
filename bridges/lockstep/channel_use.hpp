// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace bridges {

/// Use of each channel by the clients of a lockstep, for warnings at the end of the run.
class ChannelUse {
 public:
  struct Use {
    std::int64_t published = 0;  ///< messages that it listed
    bool is_read = false;        ///< the world or a client received some of them; the record does not count
    bool is_subscribed = false;
    bool has_received = false;
  };
  using OfClient = std::map<std::string, Use, std::less<>>;  // by channel

  /// Limit of the channels of all clients; further ones are not kept.
  static constexpr std::size_t max_channels = 2000;

  void add_published(std::string_view client, std::string_view channel, bool is_read) {
    if (Use* use = find(client, channel)) {
      ++use->published;
      use->is_read |= is_read;
    }
  }
  void add_subscribed(std::string_view client, std::string_view channel, bool has_received) {
    if (Use* use = find(client, channel)) {
      use->is_subscribed = true;
      use->has_received |= has_received;
    }
  }
  const std::map<std::string, OfClient, std::less<>>& clients() const { return clients_; }

 private:
  /// Returns the entry of a channel, perhaps a new one; null beyond the limit.
  Use* find(std::string_view client, std::string_view channel) {
    auto of_client = clients_.find(client);
    if (of_client != clients_.end())
      if (const auto known = of_client->second.find(channel); known != of_client->second.end()) return &known->second;
    if (count_ >= max_channels) return nullptr;
    ++count_;
    if (of_client == clients_.end()) of_client = clients_.emplace(client, OfClient{}).first;
    return &of_client->second.emplace(channel, Use{}).first->second;
  }

  std::map<std::string, OfClient, std::less<>> clients_;
  std::size_t count_ = 0;
};

}  // namespace bridges
