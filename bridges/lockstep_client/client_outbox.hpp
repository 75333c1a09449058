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

/// What a lockstep client publishes: its answers name it, and it is kept until the next tick, to be sent again.
class ClientOutbox {
 public:
  using Send = std::function<void(std::string_view channel, std::span<const std::byte> payload)>;

  ClientOutbox(std::string client, Send send) : client_(std::move(client)), send_(std::move(send)) {}

  /// At once while a tick is open, else with release().  Throws BusError when there are more than an answer may name.
  void publish(std::string_view channel, std::span<const std::byte> payload);
  /// A tick is handled.
  void open() { open_ = true; }
  bool is_open() const { return open_; }
  /// What was published between ticks goes out.
  void release();
  /// The tick is answered: the answer names what was published since open().
  void close();
  void name_all(shoal::sim_ack_t& ack) const;
  /// What the last answer named, from a place in its list on.
  void send_again(const shoal::sim_resent_t& head, std::int32_t first,
                  const std::function<void(const shoal::sim_resent_t& bundle)>& send) const;
  /// Restarts the answers; messages for the next tick are kept.
  void restart();
  /// Nothing was published.
  void clear();

 private:
  struct Published {
    std::string channel;
    std::uint32_t crc;
    sim::Bytes payload;
  };

  std::string client_;
  Send send_;
  bool open_ = false;                                  // a tick is handled and not answered
  std::vector<Published> published_, sent_, delayed_;  // since the tick; with the last answer; before the next tick
};

}  // namespace bridges
