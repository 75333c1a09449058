// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>

#include "autonomy/acomms/acoustic_frame.hpp"
#include "autonomy/behaviors/helm_behavior.hpp"
#include "shoal/acoustic_received_t.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/modem_received_t.hpp"
#include "shoal/modem_send_t.hpp"

namespace autonomy {

/// Returns the message for an acoustic modem that broadcasts the state; std::nullopt when it cannot be encoded.
std::optional<shoal::modem_send_t> to_everybody(const AcousticState& state);
std::optional<shoal::modem_send_t> to_everybody(const AcousticOrder& order);

/// Returns the state in a packet; std::nullopt when it is not a valid frame, or when its time differs by more than a
/// minute from the time of sending, which makes it useless.
std::optional<AcousticState> state_in(const shoal::acoustic_received_t& packet);
std::optional<AcousticState> state_in(const shoal::modem_received_t& packet);

/// Returns an order, as state_in() does a state.
std::optional<AcousticOrder> order_in(const shoal::acoustic_received_t& packet);

/// Distinguishes states received directly from their sender from those forwarded by a gateway, whose travel time is
/// unrelated to the sender.  Direct means sent within `newest_s` of the time of the state, by the vehicle first
/// received with this sender's number.  A relayed state is older: its packet was received completely before it was
/// forwarded, which takes seconds under water.
class DirectStates {
 public:
  static constexpr double newest_s = 3;
  bool is_direct(const shoal::acoustic_received_t& packet, const AcousticState& state);

 private:
  std::map<int, std::string> vehicles_;  ///< by number
};

/// Sound travels 90 km in this time, beyond the range of any modem: a longer travel time is not that of a range.
inline constexpr double max_travel_s = 60;

/// Returns the position of the sender at a time of its clock, extrapolated with its speed.
Vector2d position_at(const AcousticState& state, std::int64_t utime);

Motion motion_of(const AcousticState& state);
/// Returns the covariance of the position, m^2; a correlation of 1 or -1 makes it singular.
Eigen::Matrix2d covariance_of(const AcousticState& state);

/// Returns the message of a horizontal position, with its velocity and its covariance; all else in it is 0.
shoal::estimate_t estimate_message(std::int64_t utime, const Vector2d& p_W, const Vector2d& v_W,
                                   const Eigen::Matrix2d& P);
/// Adds the depth that was measured by pressure, with its error.
void set_depth(shoal::estimate_t& estimate, double depth_m);
/// Returns the state that a vehicle with this estimate and this number reports; above the surface its depth is 0.
AcousticState state_of(const shoal::estimate_t& estimate, int sender);

}  // namespace autonomy
