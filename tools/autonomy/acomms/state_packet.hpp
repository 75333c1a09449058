// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>

#include "shoal/acoustic_received_t.hpp"
#include "shoal/modem_received_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "tools/autonomy/acomms/acoustic_frame.hpp"
#include "tools/autonomy/behaviours/helm_behaviour.hpp"

namespace autonomy {

/// Message for an acoustic modem that broadcasts the state.  Nothing when it does not fit into a frame.
std::optional<shoal::modem_send_t> to_everybody(const AcousticState& state);
std::optional<shoal::modem_send_t> to_everybody(const AcousticOrder& order);

/// The state in a packet.  Nothing when it is not a valid frame, or when its time differs by more than a minute from
/// that of sending: it would be useless.
std::optional<AcousticState> state_in(const shoal::acoustic_received_t& packet);
std::optional<AcousticState> state_in(const shoal::modem_received_t& packet);

/// As state_in(), for orders.
std::optional<AcousticOrder> order_in(const shoal::acoustic_received_t& packet);

/// Distinguishes states received directly from their sender from those forwarded by a gateway, whose travel time is
/// unrelated to the sender.  Direct means sent within `newest_s` of the time of the state, by the vehicle first
/// received with this sender's number.  A relayed state is older: its packet was whole
/// before it was passed on, which takes seconds under water.
class DirectStates {
 public:
  static constexpr double newest_s = 3;
  bool is_direct(const shoal::acoustic_received_t& packet, const AcousticState& state);

 private:
  std::map<int, std::string> vehicles_;  ///< by number
};

/// Where the sender was at a time of its clock, by its speed.
Vector2d position_at(const AcousticState& state, std::int64_t utime);

Motion motion_of(const AcousticState& state);

}  // namespace autonomy
