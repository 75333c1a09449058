#include "sim/run/lockstep.hpp"

#include <algorithm>

namespace sim {

void Lockstep::join(const std::string& client, std::int64_t period_steps, std::int64_t step) {
  if (Client* known = find(client)) {
    if (known->period_steps == period_steps) return;  // a request that was sent twice moves no tick
    known->period_steps = period_steps;
    known->joined = step;
    known->acknowledged = -1;
    return;
  }
  const auto at = std::lower_bound(clients_.begin(), clients_.end(), client,
                                   [](const Client& each, const std::string& name) { return each.name < name; });
  clients_.insert(at, {client, period_steps, step, -1});
}

bool Lockstep::leave(const std::string& client) {
  return std::erase_if(clients_, [&](const Client& each) { return each.name == client; }) > 0;
}

bool Lockstep::has(const std::string& client) const {
  return const_cast<Lockstep*>(this)->find(client) != nullptr;
}

std::vector<std::string> Lockstep::due(std::int64_t step) const {
  std::vector<std::string> names;
  for (const Client& client : clients_)
    if (client.due(step)) names.push_back(client.name);
  return names;
}

bool Lockstep::acknowledge(const std::string& client, std::int64_t step) {
  Client* known = find(client);
  if (known == nullptr || !known->due(step)) return false;
  known->acknowledged = std::max(known->acknowledged, step);
  return true;
}

std::vector<std::string> Lockstep::missing(std::int64_t step) const {
  std::vector<std::string> names;
  for (const Client& client : clients_)
    if (client.due(step) && client.acknowledged < step) names.push_back(client.name);
  return names;
}

Lockstep::Client* Lockstep::find(const std::string& client) {
  const auto found =
      std::find_if(clients_.begin(), clients_.end(), [&](const Client& each) { return each.name == client; });
  return found == clients_.end() ? nullptr : &*found;
}

}  // namespace sim
