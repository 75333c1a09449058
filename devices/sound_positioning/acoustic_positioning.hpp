// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/acoustics/rays/eigenrays.hpp"
#include "sim/acoustics/transducer.hpp"
#include "sim/medium/medium_config.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

class Transponder;

/// Returns the receiver settings for pings and answers: with Doppler shift at 20 m/s, a tone of 26 kHz with 1 kHz
/// bandwidth is still in the band.
sim::ReceiverConfig receiver_of_tones();

/// Payload of a ping: a number that the answers repeat, so that late answers are not attributed to a later ping.
sim::Bytes encode_ping(std::int64_t number);
/// Returns the number of a ping; 0 when there is none.
std::int64_t decode_ping(const sim::Bytes& payload);

/// Payload of an answer.  The code of its signal is the full name of the interrogator.
struct PingAnswer {
  std::int64_t ping = 0;    ///< number of the ping
  double turnaround_s = 0;  ///< from the start of the ping to the start of the answer, if the ping is not longer
  double out_m = 0;         ///< path length of the ping, for the truth
  std::string code;         ///< code of the transponder
};
sim::Bytes encode_answer(const PingAnswer& answer);
/// Decodes an answer; none when it is not an answer of a transponder.
std::optional<PingAnswer> decode_answer(const sim::Bytes& payload);

/// Lowest frequency of answers that are not configured.
inline constexpr double lowest_answer_Hz = 28000;

/// Transponders of a world, in the order in which they were added.
class TransponderNetwork {
 public:
  void join(Transponder& transponder) { members_.push_back(&transponder); }
  void leave(Transponder& transponder) { std::erase(members_, &transponder); }
  const std::vector<Transponder*>& members() const { return members_; }
  /// Returns the lowest free answer frequency of this network: 28 kHz, 29 kHz, ..., or with a wider spacing for a wider
  /// band.
  double free_answer_Hz(const std::string& network, double bandwidth_Hz) const;

 private:
  std::vector<Transponder*> members_;
};

/// The transponder network of each world.
inline const sim::SharedKind<TransponderNetwork> transponder_network;

/// Warns of rows of its `profile_file` that are skipped or unusual.
void warn_of_assumed_water(const std::optional<sim::WaterConfig>& water, const sim::DeviceContext& context);

/// Water as the user of a device knows it, through which the device follows the sound.
class AssumedWater {
 public:
  explicit AssumedWater(const sim::WaterConfig& config);
  const sim::SoundProfile& profile() const { return rays_.profile(); }
  /// Distance (m) of a point at a known depth whose first arrival takes this time, one way; depths below the surface.
  /// Where no ray arrives, as in a shadow, sound goes along the straight line.
  double distance_m(double own_depth_m, double depth_m, double time_s) const;

 private:
  double first_arrival_s(double own_depth_m, double depth_m, double across_m) const;

  sim::Eigenrays rays_;
};

}  // namespace devices
