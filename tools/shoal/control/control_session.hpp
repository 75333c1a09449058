// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "bridges/lcm/lcm_listener.hpp"
#include "bridges/lockstep_client/wait_warning.hpp"
#include "bridges/signing/signed_message.hpp"
#include "shoal/sim_control_reply_t.hpp"

namespace tools {

/// Requests on `sim.control` and their replies.  A request is sent again only if it was lost, because it might be
/// executed twice: a run that has not started yet does not receive it.
class ControlSession {
 public:
  struct Options {
    std::string client;
    std::string lcm_url;
    std::string run;  ///< folder with the key of the run; empty: the key of SHOAL_RUN_KEY, if it is set
    double timeout_s = 5;
  };

  /// Throws BusError.
  explicit ControlSession(const Options& options);

  /// Returns the reply; std::nullopt if none arrived in time, or a signal did.
  std::optional<shoal::sim_control_reply_t> send_request(const std::string& command, const std::string& text,
                                                         double value);
  /// Returns the error of a request without a reply.
  std::string no_answer() const;

 private:
  using Clock = std::chrono::steady_clock;

  void send(std::int32_t id, const std::string& command, const std::string& text, double value);
  /// Returns the reply to one of two requests.
  std::optional<shoal::sim_control_reply_t> await_reply(std::int32_t id, std::int32_t other_id,
                                                        Clock::time_point deadline, bridges::WaitWarning& audit_entry);

  const Options options_;
  bridges::LcmListener lcm_;
  std::optional<bridges::MessageSigner> signer_;  // unset: there is no key
  std::int32_t id_;
};

}  // namespace tools
