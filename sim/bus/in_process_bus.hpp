// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include "sim/bus/bus.hpp"

namespace sim {

/// Bus within the process: delivers immediately, in the order of publication.  Not thread-safe.
class InProcessBus final : public Bus {
 public:
  InProcessBus();
  ~InProcessBus() override;
  void publish(std::string_view channel, std::span<const std::byte> payload, Time at) override;
  std::unique_ptr<Mailbox> open_mailbox(const std::string& channel, std::size_t capacity) override;
  BusCounts counts() const override;

 private:
  struct Queue;
  class QueueMailbox;
  // Ordered by name; std::less<> looks up a string_view without constructing a string.
  std::map<std::string, std::vector<std::shared_ptr<Queue>>, std::less<>> queues_;
  BusCounts counts_;
};

}  // namespace sim
