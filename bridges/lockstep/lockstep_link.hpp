// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bridges/lockstep/lockstep_service.hpp"
#include "shoal/message_codec.hpp"

namespace bridges {

/// Bus on which clients may be.
struct LockstepService::Link {
  Link(sim::Bus& bus, sim::MessageGate& message_gate, const std::string& name)
      : network(bus),
        gate(message_gate),
        called(name.empty() ? "the world's bus" : "bus '" + name + "'"),
        messages(message_gate),
        acks(bus.open_mailbox("sim.ack")),
        resend_requests(bus.open_mailbox("sim.resend")),
        bundles(bus.open_mailbox("sim.resent")) {}

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
  sim::ClientMessages messages;
  std::unique_ptr<sim::Mailbox> acks, resend_requests, bundles;
  std::vector<std::unique_ptr<sim::Mailbox>> passed_on;  // opened only to forward messages to other clients
  sim::Bytes buffer;
};

}  // namespace bridges
