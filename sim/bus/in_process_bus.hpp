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
  std::unique_ptr<OpenChannel> open_channel(const std::string& channel) override;
  std::unique_ptr<Mailbox> open_mailbox(const std::string& channel, std::size_t capacity) override;
  BusCounts counts() const override;

 private:
  struct Queue;
  class QueueMailbox;
  class QueuesChannel;
  using Queues = std::vector<std::shared_ptr<Queue>>;
  void give(const std::string& channel, Queues& queues, std::span<const std::byte> payload);

  // Ordered by name; std::less<> looks up a string_view without constructing a string.
  std::map<std::string, Queues, std::less<>> queues_;  // grows only: an open channel refers to its entry
  BusCounts counts_;
};

}  // namespace sim
