// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/control/client_accounts.hpp"

#include <stdexcept>

#include "sim/config/message_text.hpp"

namespace bridges {

const std::string& ClientAccounts::account_of(const std::string& client) const {
  static const std::string others;
  return used_.contains(client) || used_.size() < max_clients ? client : others;
}

void ClientAccounts::check(const std::string& client) const {
  const auto used = used_.find(account_of(client));
  const std::string limit = "; see limits." + key_ + " of the world";
  if ((used == used_.end() ? 0 : used->second) >= per_client_)
    throw std::runtime_error("client '" + sim::shortened(sim::printable(client)) + "' has used up its " +
                             std::to_string(per_client_) + " " + what_ + limit);
  if (all_ >= 10 * per_client_)
    throw std::runtime_error("all clients together have made " + std::to_string(all_) + " " + what_ + limit);
}

void ClientAccounts::use(const std::string& client) {
  ++used_[account_of(client)];
  ++all_;
}

}  // namespace bridges
