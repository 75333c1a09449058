#pragma once

#include <optional>
#include <string>

#include "shoal/acoustic_received_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "tools/autonomy/acoustic_frame.hpp"
#include "tools/autonomy/helm_behaviour.hpp"

namespace autonomy {

/// What to give an acoustic modem, so that everybody hears the state.  Nothing when it does not fit into a frame.
std::optional<shoal::modem_send_t> to_everybody(const AcousticState& state);

/// The state in a packet.  Nothing when it is no good frame, or when it is of more than a minute before or after the
/// sending: such a one helps nobody.
std::optional<AcousticState> state_in(const shoal::acoustic_received_t& packet);

/// Where the sender was at a time of its clock, by its speed.
Vector2d position_at(const AcousticState& state, std::int64_t utime);

Motion motion_of(const AcousticState& state);

}  // namespace autonomy
