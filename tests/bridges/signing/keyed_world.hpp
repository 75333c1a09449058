// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "bridges/signing/signed_message.hpp"
#include "shoal/sim_audit_t.hpp"
#include "tests/bridges/lockstep/lockstep_fixture.hpp"

namespace keyed_world {

inline const bridges::RunKey run_key = bridges::RunKey::from_text(std::string(64, 'a'), "test");

/// A world that is controlled with its key only, and a program that has it.
struct KeyedWorld : lcm_test::LockstepWorld {
  explicit KeyedWorld(const std::string& terms = "{timeout_s: 0.02, on_timeout: continue}")
      : lcm_test::LockstepWorld(terms) {
    lockstep.guard().require(run_key);
  }
  template <typename Message>
  sim::Bytes signed_payload(const std::string& channel, const Message& message) {
    return signer.sign(channel, shoal::encode(message));
  }
  /// What the service answers to a payload; nothing when it does not.
  std::optional<shoal::sim_control_reply_t> answer_to(const sim::Bytes& payload) {
    replies.take_all();
    test.bus.publish("sim.control", payload, test.world.now());
    answering->handle_requests();
    const auto all = replies.take_all();
    if (all.empty()) return std::nullopt;
    return all.back();
  }
  static shoal::sim_control_request_t request(const std::string& command, const std::string& text = "",
                                              double value = 0, const std::string& client = "pilot") {
    shoal::sim_control_request_t made{};
    made.client = client;
    made.command = command;
    made.text = text;
    made.value = value;
    return made;
  }
  static shoal::sim_ack_t ack(std::int64_t sequence, std::int64_t step, const std::string& command = "") {
    shoal::sim_ack_t made{};
    made.client = "pilot";
    made.session = 5;
    made.sequence = sequence;
    made.step = step;
    made.listed = 1;
    if (!command.empty()) {
      made.count = 1;
      made.channel = {"a.cmd"};
      made.crc = {sim::crc32(lcm_test::bytes_of(command))};
    }
    return made;
  }

  bridges::MessageSigner signer{run_key, "pilot-program"};
  test::Listener<shoal::sim_audit_t> audit{test, "sim.audit"};
};

}  // namespace keyed_world
