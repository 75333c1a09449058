// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "sim/base/time.hpp"
#include "sim/bus/bus.hpp"
#include "sim/device/shared_by_devices.hpp"

namespace devices {

/// Interface of a modem that transmits byte messages between vehicles, for gateways.
class MessageModem {
 public:
  /// Callback for each message that arrives.
  using Tap = std::function<void(sim::Time at, const std::string& source, const sim::Bytes& data)>;

  virtual ~MessageModem() = default;
  /// Queues a message; empty destination: broadcast.  Throws std::runtime_error when it cannot be sent.
  virtual void send(sim::Time now, std::string destination, sim::Bytes data) = 0;
  virtual std::size_t message_limit_bytes() const = 0;
  /// Returns the number of messages dropped because the queue was full.
  virtual std::int64_t dropped_from_queue() const = 0;
  /// Sets the only tap.
  void set_tap(Tap tap) { tap_ = std::move(tap); }

 protected:
  void report_to_tap(sim::Time at, const std::string& source, const sim::Bytes& data) const {
    if (tap_) tap_(at, source, data);
  }

 private:
  Tap tap_;
};

/// Message modems of a world by full name, such as `buoy/radio`.
class MessageModems {
 public:
  void join(const std::string& full_name, MessageModem& modem) { modems_[full_name] = &modem; }
  void leave(const std::string& full_name) {
    const auto modem = modems_.find(full_name);
    if (modem == modems_.end()) return;
    dropped_by_removed_ += modem->second->dropped_from_queue();
    modems_.erase(modem);
  }
  /// Returns a modem by full name; null when there is none.
  MessageModem* find(const std::string& full_name) const {
    const auto found = modems_.find(full_name);
    return found == modems_.end() ? nullptr : found->second;
  }

  /// Returns the number of messages dropped from full queues by all modems, including removed ones.
  std::int64_t dropped_from_queues() const {
    std::int64_t dropped = dropped_by_removed_;
    for (const auto& [name, modem] : modems_) dropped += modem->dropped_from_queue();
    return dropped;
  }

 private:
  std::map<std::string, MessageModem*, std::less<>> modems_;
  std::int64_t dropped_by_removed_ = 0;
};

/// The registry of modems of each world.
inline const sim::SharedKind<MessageModems> message_modems;

}  // namespace devices
