// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep_client/client_outbox.hpp"

#include <utility>

#include "bridges/base/bus_error.hpp"
#include "bridges/lockstep_client/resend.hpp"
#include "sim/base/crc32.hpp"
#include "sim/run/lockstep.hpp"

namespace bridges {

void ClientOutbox::publish(std::string_view channel, std::span<const std::byte> payload) {
  if (published_.size() + delayed_.size() >= sim::max_named_messages)
    throw BusError("'" + client_ + "' publishes more than " + std::to_string(sim::max_named_messages) +
                   " messages between two ticks");
  Published message{std::string(channel), sim::crc32(payload), sim::Bytes(payload.begin(), payload.end())};
  // Between acknowledgment and tick the list of what was published is closed; what comes in between belongs to the
  // next tick.
  if (!open_) {
    delayed_.push_back(std::move(message));
    return;
  }
  send_(channel, payload);
  published_.push_back(std::move(message));
}

void ClientOutbox::release() {
  for (Published& message : std::exchange(delayed_, {})) {
    send_(message.channel, message.payload);
    published_.push_back(std::move(message));
  }
}

void ClientOutbox::close() {
  sent_ = std::exchange(published_, {});
  open_ = false;
}

void ClientOutbox::name_all(shoal::sim_ack_t& ack) const {
  ack.listed = 1;
  ack.count = static_cast<std::int32_t>(sent_.size());
  for (const Published& message : sent_) {
    ack.channel.push_back(message.channel);
    ack.crc.push_back(message.crc);
  }
}

void ClientOutbox::send_again(const shoal::sim_resent_t& head, std::int32_t first,
                              const std::function<void(const shoal::sim_resent_t& bundle)>& send) const {
  if (first < 0) return;
  send_bundles(
      head, static_cast<std::size_t>(first), sent_.size(),
      [this](std::size_t place) {
        return ResentMessage{sent_[place].channel, sent_[place].payload};
      },
      send);
}

void ClientOutbox::restart() {
  open_ = false;
  published_.clear();
  sent_.clear();
}

void ClientOutbox::clear() {
  published_.clear();
  sent_.clear();
  delayed_.clear();
}

}  // namespace bridges
