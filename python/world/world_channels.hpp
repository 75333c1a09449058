// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"

namespace python {

/// Names of the channels of a world, for checks of those that a program names.
struct WorldChannels {
  explicit WorldChannels(const sim::World& world);

  /// Channels of devices and events that publish.
  std::set<std::string, std::less<>> published;
  /// Channels that devices, metrics and conditions read, with the types that a device accepts, comma separated; empty:
  /// any type.
  std::map<std::string, std::string, std::less<>> received;
  /// Truth channels that are off, with the names of their devices.
  std::map<std::string, std::string, std::less<>> silent;

  /// Returns `; did you mean 'NAME'?` for a name that is close to a channel, or to a part of one that ends at a dot;
  /// empty when none is close.  `received_only`: only to channels that have a reader.
  std::string meant(const std::string& channel, bool received_only) const;
};

/// Returns whether a command of this type may have NaN, which leaves a value as it is.
bool may_have_nan(const std::string& type);

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
