// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <string>

#include "sim/bus/in_process_bus.hpp"

namespace python {

/// Bus within the process that also keeps the last payload of every channel.  Not thread-safe.
class LastMessages final : public sim::Bus {
 public:
  void publish(std::string_view channel, std::span<const std::byte> payload, sim::Time at) override;
  std::unique_ptr<sim::Mailbox> open_mailbox(const std::string& channel, std::size_t capacity) override {
    return bus_.open_mailbox(channel, capacity);
  }
  sim::BusCounts counts() const override { return bus_.counts(); }

  /// Returns the last payload of a channel; null when nothing was published on it.
  const sim::Bytes* find(std::string_view channel) const;
  const std::map<std::string, sim::Bytes, std::less<>>& all() const { return last_; }
  /// Forgets the payloads: after a restore they are those of another future.
  void clear() { last_.clear(); }

 private:
  sim::InProcessBus bus_;
  std::map<std::string, sim::Bytes, std::less<>> last_;
};

}  // namespace python
