// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "bridges/bus/arrivals.hpp"
#include "bridges/bus/outgoing_queue.hpp"
#include "bridges/lcm/lcm_connection.hpp"
#include "sim/bus/bus.hpp"

namespace bridges {

struct LcmBusOptions {
  OutgoingQueue::Limits outgoing;
  std::size_t max_message_bytes = max_lcm_message_bytes;
  std::shared_ptr<Arrivals>
      arrivals;  ///< shared with other buses, to wait for a message on any of them; null: not shared
};

/// Bus over LCM.  One thread sends and one receives: publish() and take() only move messages, and the physics loop
/// never waits for the network.  Messages are sent at end_of_step(), or earlier when many are queued.  The caller of
/// wait_for_message() does the work of both threads while it waits; over tcpq, which may block, it only wakes the
/// sender. Messages of one sender arrive in the order of sending, over all channels: when a later one is in a mailbox,
/// the earlier ones are too.  A subscriber also receives the messages published by this process: immediately, and not
/// again when the network echoes them.
class LcmBus final : public sim::Bus {
 public:
  /// An empty URL means LCM_DEFAULT_URL, else default_lcm_url.  Throws BusError when LCM cannot be used.
  explicit LcmBus(const std::string& url = {}, const LcmBusOptions& options = {});
  /// Sends the queued messages, for at most one second.
  ~LcmBus() override;

  void publish(std::string_view channel, std::span<const std::byte> payload, sim::Time at) override;
  std::unique_ptr<sim::OpenChannel> open_channel(const std::string& channel) override;
  std::unique_ptr<sim::Mailbox> open_mailbox(const std::string& channel,
                                             std::size_t capacity = default_mailbox_capacity) override;
  void end_of_step() override;
  sim::BusCounts counts() const override;

  /// Sends the queued messages, and waits until a message has arrived (on any bus that shares the arrivals) since the
  /// last call returned; returns immediately when one has.  No message is missed when the mailboxes are drained before
  /// the call.  Returns false on time-out.
  bool wait_for_message(std::chrono::milliseconds timeout);
  /// Sends all queued messages.  Returns false on time-out.
  bool flush(std::chrono::milliseconds timeout);
  const std::string& url() const;
  /// Returns false when the server of a tcpq URL has disconnected; all messages are then dropped.
  bool connected() const;

 private:
  struct Threads;
  class LookedUpChannel;
  std::unique_ptr<Threads> threads_;
};

/// Returns the version of the LCM library, such as `1.3.1`.
std::string lcm_version();

}  // namespace bridges
