// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "sim/acoustics/propagation/decibels.hpp"
#include "sim/acoustics/propagation/modulation.hpp"
#include "sim/base/math.hpp"
#include "sim/base/time.hpp"
#include "sim/bus/bus.hpp"

namespace sim {

class StateArchive;

/// Address of a message or of its receiver, by which deliveries are counted.
struct Audience {
  std::string group;    ///< interoperable group, such as kind and network of modems
  std::string address;  ///< in the group; of a message, empty: broadcast to the group
  bool operator==(const Audience&) const = default;

  template <typename Archive>
  void visit_state(Archive& archive) {
    archive(group, address);
  }
};

/// Sound of finite duration, as transmitted by a transducer.
struct Signal {
  /// Kind of a signal, by which listeners select.
  enum class Kind {
    message,  ///< bits of a modem
    ping,     ///< interrogation of transponders
    answer,   ///< reply of a transponder
    noise,    ///< carries no information
  };

  Kind kind = Kind::message;
  Decibels source_level{185};  ///< re 1 uPa at 1 m, on the axis of the transducer
  double centre_Hz = 25000;
  double bandwidth_Hz = 4000;  ///< band with constant spectral density
  Time duration{0};            ///< as transmitted
  Modulation modulation = Modulation::fsk;
  double bit_rate_bps = 80;   ///< Eb/N0 is the ratio of signal and noise times bandwidth / bit rate
  std::int64_t bits = 0;      ///< that must all be correct; 0: detection suffices
  double coding_gain_dB = 0;  ///< added to Eb/N0
  std::string network;        ///< listeners of other networks cannot decode it
  std::string code;           ///< defined by the listener: a frame type, the addressee of a ping
  Bytes payload;              ///< defined by the listener
  Audience to;                ///< addressee of a message

  /// Upper limit of frequencies, above that of any device.
  static constexpr double max_Hz = 1e9;

  /// Whether all numbers are physically possible, so that levels and rates computed from them are finite.
  bool possible() const {
    const auto within = [](double value) { return value > 0 && value <= max_Hz; };
    return within(centre_Hz) && within(bandwidth_Hz) && within(bit_rate_bps) && bits >= 0 &&
           std::abs(coding_gain_dB) <= 1000 && std::abs(source_level.dB()) <= 1000;
  }

  template <typename Archive>
  void visit_state(Archive& archive) {
    archive(kind, source_level, centre_Hz, bandwidth_Hz, duration, modulation, bit_rate_bps, bits, coding_gain_dB,
            network, code, payload, to);
    if (archive.restoring() && !possible()) archive.fail("an invalid signal");
  }
};

/// Cause of loss of a signal at a receiver.
enum class SignalLoss {
  none,          ///< decoded
  noise,         ///< signal-to-noise ratio too low
  interference,  ///< too weak relative to other sounds
  half_duplex,   ///< the receiver was sending
  busy,          ///< the receiver was receiving another signal
  captured,      ///< a stronger signal captured the receiver
  doppler,       ///< closing or opening speed above the limit
  blocked,       ///< path blocked by an obstacle
  out_of_water,  ///< sender or receiver left the water
  receiver_off,  ///< no power, or silenced by a fault
  link,          ///< random loss by `links:` of the world
  range,         ///< beyond the range of reception
  sender_off,    ///< the sender lost power or was removed during transmission
  shadow,        ///< no ray without a bounce reaches the receiver, and what does is too weak
};
inline constexpr int signal_losses = 14;
/// Name of a cause, such as `half_duplex`.
const char* signal_loss_word(SignalLoss loss);
/// Checks a restored loss, which is used as an index of counts.  Throws SnapshotError.
void check_loss(SignalLoss loss, const StateArchive& archive);

/// Reception of a signal by a listening transducer.
struct Reception {
  const Signal& signal;
  std::string source;                       ///< sending vehicle and device, such as `auv1/modem`
  int from = -1;                            ///< number of the sending transducer
  Time sent{0};                             ///< start of transmission
  Time started{0}, ended{0};                ///< start and end at the receiver
  double travel_time_s = 0;                 ///< from `sent` to `started`, not rounded
  Vector3d p_sent_W = Vector3d::Zero();     ///< position of the sender at `sent`
  Vector3d p_started_W = Vector3d::Zero();  ///< position of the receiver at `started`
  /// Displacement to where the sender appears to be: its distance, in the direction from which the sound comes.
  Vector3d apparent_W = Vector3d::Zero();
  Decibels level{0};       ///< re 1 uPa at the receiver, including its directivity
  Decibels snr{0};         ///< signal-to-noise ratio in the band of the signal
  Decibels sinr{0};        ///< minimum signal to interference-plus-noise ratio
  double closing_mps = 0;  ///< closing speed of sender and receiver (Doppler)
  SignalLoss loss = SignalLoss::none;
  bool detected = false;  ///< the receiver locked on to it, decoded or not

  bool understood() const { return loss == SignalLoss::none; }
};

}  // namespace sim
