// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>

#include "bridges/lockstep/lockstep_service.hpp"
#include "shoal/message_codec.hpp"

namespace bridges {

/// Bus on which clients may be.
struct LockstepService::Link {
  explicit Link(const LockstepBus& bus)
      : network(bus.network),
        gate(bus.gate),
        called(bus.name.empty() ? "the world's bus" : "bus '" + bus.name + "'"),
        is_recorded(bus.is_recorded),
        messages(bus.gate),
        acks(bus.network.open_mailbox("sim.ack")),
        resend_requests(bus.network.open_mailbox("sim.resend")),
        bundles(bus.network.open_mailbox("sim.resent")) {}

  /// Publishes a message on the network, bypassing the gate.  It is sent when the world waits for the answer, or at the
  /// end of the step.
  template <typename Message>
  void publish(const char* channel, const Message& message, sim::Time at) {
    shoal::encode_into(message, buffer);
    network.publish(channel, buffer, at);
  }

  sim::Bus& network;
  sim::MessageGate& gate;
  const std::string called;  // name in texts
  const bool is_recorded;
  sim::ClientMessages messages;
  std::unique_ptr<sim::Mailbox> acks, resend_requests, bundles;
  // Mailboxes by channel, opened only for other clients or for the record.
  std::map<std::string, std::unique_ptr<sim::Mailbox>, std::less<>> passed_on;
  std::set<std::string, std::less<>> lost;  // channels with messages that did not arrive, closed for the record
  sim::Bytes buffer;
};

}  // namespace bridges
