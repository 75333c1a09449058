// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/time.hpp"

namespace sim {

using Bytes = std::vector<std::byte>;

struct Message {
  std::string channel;
  Bytes payload;
  bool from_outside = false;  ///< received over the network, not published by this process

  template <typename Archive>
  void visit_state(Archive& archive) {
    archive(channel, payload, from_outside);
  }
};

/// Queue of the unread messages of one subscriber.  Bounded: when it is full, the oldest message is dropped and
/// counted.
class Mailbox {
 public:
  virtual ~Mailbox() = default;
  /// Removes and returns the oldest unread message.  Never blocks.
  virtual std::optional<Message> take() = 0;
  virtual std::uint64_t dropped() const = 0;
  /// Sets `flag` whenever a message arrives, so that a reader of thousands of mailboxes can skip the empty ones.  The
  /// reader clears the flag first, then takes all messages.  Supports one flag.
  virtual void raise_on_arrival(std::shared_ptr<std::atomic<bool>> flag) = 0;
  /// Returns the unread messages, oldest first, for a snapshot.  A mailbox that only the network fills may return none.
  virtual std::vector<Message> unread() const { return {}; }
  /// Replaces the unread messages.
  virtual void set_unread(std::vector<Message> /*messages*/) {
    while (take()) {
    }
  }
};

/// Channel of a bus that was looked up once, for many publications.  It must not outlive its bus.
class OpenChannel {
 public:
  virtual ~OpenChannel() = default;
  /// Publishes a message, as Bus::publish() does on this channel.
  virtual void publish(std::span<const std::byte> payload, Time at) = 0;
};

struct BusCounts {
  std::uint64_t published = 0;
  std::uint64_t received = 0;
  std::uint64_t dropped_outgoing = 0;
  std::uint64_t dropped_incoming = 0;
};

/// Publish/subscribe interface: byte payloads on named channels.  A channel name has 1 to 63 characters.
class Bus {
 public:
  static constexpr std::size_t max_channel_length = 63;
  static constexpr std::size_t default_mailbox_capacity = 1000;

  virtual ~Bus() = default;
  /// Publishes a message without waiting for the network.  `at`: simulated time, recorded as its time stamp.
  virtual void publish(std::string_view channel, std::span<const std::byte> payload, Time at) = 0;
  /// Opens a channel for publications: its name is checked and looked up only here.  Throws as open_mailbox() does.
  virtual std::unique_ptr<OpenChannel> open_channel(const std::string& channel);
  /// Opens a new mailbox for a channel at every call.  The mailbox must not outlive the bus.  Throws
  /// std::invalid_argument for a channel name that is empty or too long.
  virtual std::unique_ptr<Mailbox> open_mailbox(const std::string& channel,
                                                std::size_t capacity = default_mailbox_capacity) = 0;
  /// Is called once after the reports of each step, so that a bus can send the messages of a step in one batch.
  virtual void end_of_step() {}
  virtual BusCounts counts() const = 0;
};

// Messages start with 8 bytes of fingerprint, followed in Shoal's types by `int64_t utime`, big-endian.

/// Returns the value at the position of utime in a message; none when the message is too short.
std::optional<std::int64_t> utime_of(std::span<const std::byte> payload);
/// Writes the utime of a message.  The message must be long enough.
void set_utime(Bytes& payload, std::int64_t utime);

}  // namespace sim
