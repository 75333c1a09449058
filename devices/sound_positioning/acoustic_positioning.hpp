// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/acoustics/transducer.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

class Transponder;

/// That of pings and answers: a tone of 26 kHz that fills 1 kHz is still in its band at 20 m/s.
sim::ReceiverConfig receiver_of_tones();

/// Payload of a ping: a number that the answers repeat, so that late answers are not attributed to a later ping.
sim::Bytes encode_ping(std::int64_t number);
/// 0 when there is none.
std::int64_t decode_ping(const sim::Bytes& payload);

/// Payload of an answer.  The code of its signal is the full name of the interrogator.
struct PingAnswer {
  std::int64_t ping = 0;    ///< its number
  double turnaround_s = 0;  ///< from the first sound of the ping to that of the answer, if the ping is not longer
  double out_m = 0;         ///< what the ping has come, for the truth
  std::string code;         ///< of the transponder
};
sim::Bytes encode_answer(const PingAnswer& answer);
/// Nothing when it is not an answer of a transponder.
std::optional<PingAnswer> decode_answer(const sim::Bytes& payload);

/// All transponders of a world, in the order in which they came.
class TransponderNetwork {
 public:
  void join(Transponder& transponder) { members_.push_back(&transponder); }
  void leave(Transponder& transponder) { std::erase(members_, &transponder); }
  const std::vector<Transponder*>& members() const { return members_; }
  /// The lowest of 28 kHz, 29 kHz, ... (or wider apart) whose band no answer of this network uses.
  double free_answer_Hz(const std::string& network, double bandwidth_Hz) const;

 private:
  std::vector<Transponder*> members_;
};

/// Of each world.
inline const sim::SharedKind<TransponderNetwork> transponder_network;

}  // namespace devices
