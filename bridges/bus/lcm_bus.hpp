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
  std::shared_ptr<Arrivals> arrivals;  ///< shared with other buses, to wait for a message on any; null: its own
};

/// The bus over LCM.  One thread sends, one receives: publish() and take() only move messages, and the
/// physics loop never waits for the network.  Messages go out at end_of_step(), earlier when many wait.  The caller
/// of wait_for_message() does the work of both threads while it waits; over tcpq, which may block, it only wakes the
/// sender.
/// Messages of one sender arrive in the order it sent them, over all channels: when a later one is in a mailbox, the
/// earlier ones are too.  A subscriber also receives what this process publishes: immediately, and not again when the
/// network echoes it.
class LcmBus final : public sim::Bus {
 public:
  /// An empty URL means LCM_DEFAULT_URL, else default_lcm_url.  Throws BusError when LCM cannot be used.
  explicit LcmBus(const std::string& url = {}, const LcmBusOptions& options = {});
  /// Sends what is queued, for at most one second.
  ~LcmBus() override;

  void publish(std::string_view channel, std::span<const std::byte> payload, sim::Time at) override;
  std::unique_ptr<sim::Mailbox> open_mailbox(const std::string& channel,
                                             std::size_t capacity = default_mailbox_capacity) override;
  void end_of_step() override;
  sim::BusCounts counts() const override;

  /// Has what is queued sent, and sleeps until a message arrived (on any bus that shares the arrivals) after the last
  /// call returned; at once if one did already.  Drain the mailboxes, then call: nothing is missed.  False on time-out.
  bool wait_for_message(std::chrono::milliseconds timeout);
  /// Sends all that is queued.  False on time-out.
  bool flush(std::chrono::milliseconds timeout);
  const std::string& url() const;
  /// False once the server of a tcpq URL has gone away.  Everything is dropped then.
  bool connected() const;

 private:
  struct Threads;
  std::unique_ptr<Threads> threads_;
};

}  // namespace bridges
