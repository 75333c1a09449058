#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sim {

/// Which clients the world waits for, and at which steps.  Knows no message and no clock.
class Lockstep {
 public:
  /// From `step` on the world waits for this client every `period_steps` (at least 1).  Joining again changes the
  /// period.
  void join(const std::string& client, std::int64_t period_steps, std::int64_t step);
  /// False when there is no such client.
  bool leave(const std::string& client);
  bool has(const std::string& client) const;
  bool empty() const { return clients_.empty(); }

  /// The clients that get a tick at this step, in the order of their names.
  std::vector<std::string> due(std::int64_t step) const;
  /// The client is done with `step`.  False when there is no such client or it was not asked.
  bool acknowledge(const std::string& client, std::int64_t step);
  /// Those due at this step that have not acknowledged it.
  std::vector<std::string> missing(std::int64_t step) const;

 private:
  struct Client {
    std::string name;
    std::int64_t period_steps = 1;
    std::int64_t joined = 0;
    std::int64_t acknowledged = -1;
    bool due(std::int64_t step) const { return step >= joined && (step - joined) % period_steps == 0; }
  };
  Client* find(const std::string& client);

  std::vector<Client> clients_;
};

}  // namespace sim
