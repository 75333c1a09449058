// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace bridges {

/// Quota of requests of each client.  A run grants a number to each client, and ten times that to all clients together,
/// because a client can choose any name.  Not part of the state of the world.
class ClientAccounts {
 public:
  /// `what`: name in the error, such as `spawn requests`; `key`: key of `limits` in the world file.
  ClientAccounts(std::string what, std::string key, std::int64_t per_client)
      : what_(std::move(what)), key_(std::move(key)), per_client_(per_client) {}

  /// Throws std::runtime_error when the client has none left.
  void check(const std::string& client) const;
  void use(const std::string& client);

 private:
  static constexpr std::size_t max_clients = 1000;  // further clients share one account
  const std::string& account_of(const std::string& client) const;

  std::string what_, key_;
  std::int64_t per_client_;
  std::int64_t all_ = 0;
  std::map<std::string, std::int64_t, std::less<>> used_;
};

}  // namespace bridges
