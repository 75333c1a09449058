// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "shoal/sim_ack_t.hpp"
#include "shoal/sim_resent_t.hpp"
#include "sim/bus/bus.hpp"

namespace bridges {

/// Outbox of a lockstep client: its answers name the published messages, which are kept until the next tick for
/// repetition.
class ClientOutbox {
 public:
  using Send = std::function<void(std::string_view channel, std::span<const std::byte> payload)>;

  ClientOutbox(std::string client, Send send) : client_(std::move(client)), send_(std::move(send)) {}

  /// Publishes a message, immediately while a tick is open, otherwise at release().  Throws BusError when there are
  /// more messages than an answer may name.
  void publish(std::string_view channel, std::span<const std::byte> payload);
  /// Opens a tick, which is being handled.
  void open() { open_ = true; }
  bool is_open() const { return open_; }
  /// Sends the messages published between ticks.
  void release();
  /// Closes the tick: its answer names the messages published since open().
  void close();
  void name_all(shoal::sim_ack_t& ack) const;
  /// Sends the messages named by the last answer again, from index `first` of its list on.
  void send_again(const shoal::sim_resent_t& head, std::int32_t first,
                  const std::function<void(const shoal::sim_resent_t& bundle)>& send) const;
  /// Restarts the answers; messages for the next tick are kept.
  void restart();
  /// Discards all messages.
  void clear();

 private:
  struct Published {
    std::string channel;
    std::uint32_t crc;
    sim::Bytes payload;
  };

  std::string client_;
  Send send_;
  bool open_ = false;                                  // a tick is being handled and not answered
  std::vector<Published> published_, sent_, delayed_;  // since the tick; with the last answer; before the next tick
};

}  // namespace bridges
