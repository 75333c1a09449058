// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/replay/player_requests.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "bridges/signing/signed_message.hpp"
#include "experiment/replay/recorded_steps.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "sim/base/log.hpp"
#include "sim/config/message_text.hpp"
#include "sim/run/lockstep.hpp"

namespace experiment {

namespace {

constexpr std::size_t max_warnings = 1000;

bool needs_a_world(const std::string& command) {
  static constexpr std::array<const char*, 8> names{"describe", "do",       "remove", "restore",
                                                    "rewind",   "snapshot", "spawn",  "until"};
  return std::find(names.begin(), names.end(), command) != names.end();
}

}  // namespace

PlayerRequests::PlayerRequests(const ReplayLog& log, sim::RunControl& control, sim::Bus& network,
                               std::function<std::string()> where)
    : log_(log), control_(control), where_(std::move(where)), joins_(network.open_mailbox("sim.control")) {}

bool PlayerRequests::has(const std::string& channel) const {
  return log_.events.contains(channel) && !is_of_the_handshake(channel);
}

void PlayerRequests::check_channels(const std::string& text) const {
  const sim::LockstepTerms terms = sim::read_lockstep_terms(text, {});
  if (terms.receives.empty() ||
      std::any_of(terms.receives.begin(), terms.receives.end(), [&](const auto& channel) { return has(channel); }))
    return;
  throw std::runtime_error("the record has no message on any channel that the client asks for, such as '" +
                           sim::shortened(sim::printable(terms.receives.front())) + "'");
}

void PlayerRequests::check_joins() {
  while (const auto message = joins_->take()) {
    try {
      const auto request =
          shoal::decode<shoal::sim_control_request_t>(bridges::content_of(message->payload), shoal::Finite::any);
      if (request.command != "join") continue;
      const sim::LockstepTerms terms = sim::read_lockstep_terms(request.text, {});
      for (const std::string& channel : terms.receives)
        if (!has(channel) && warned_.size() < max_warnings && warned_.emplace(request.client, channel).second)
          sim::log_warn("client '{}' asks for '{}', of which the record has no message",
                        sim::shortened(sim::printable(request.client)), sim::shortened(sim::printable(channel)));
    } catch (const std::exception&) {
      // The reply to the request contains the error.
    }
  }
}

std::optional<std::string> PlayerRequests::execute(const std::string& command, const std::string& text, double value) {
  // Served requests.
  if (command == "join") {
    check_channels(text);
  } else if (command == "pause" || command == "resume") {
    control_.set_paused(command == "pause");
    return where_();
  } else if (command == "step") {
    if (!(value >= 1) || value > 1e9 || value != std::floor(value))
      throw std::runtime_error(fmt::format("'step' needs a whole number of steps from 1 on, got {:g}", value));
    control_.add_steps(static_cast<std::int64_t>(value));
    return where_();
  } else if (command == "speed") {
    if (!(value >= 0) || value > 1e6)
      throw std::runtime_error(fmt::format("'speed' must be 0 (as fast as possible) to 1e6, got {:g}", value));
    control_.set_speed(value);
    return where_();
  } else if (command == "where") {
    return where_();
    // Requests that require a world.
  } else if (needs_a_world(command)) {
    throw std::runtime_error("a record is being played, so there is no world: '" + command + "' is not possible");
  }
  return std::nullopt;
}

}  // namespace experiment
