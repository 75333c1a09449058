// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "sim/acoustics/decibels.hpp"
#include "sim/acoustics/modulation.hpp"
#include "sim/base/math.hpp"
#include "sim/base/time.hpp"
#include "sim/bus/bus.hpp"

namespace sim {

/// Addressees and addresses, by which delivery is counted.
struct Audience {
  std::string group;    ///< group that understands each other, such as kind and network of modems
  std::string address;  ///< in the group; of a message, empty: for all of the group

  template <typename Archive>
  void visit_state(Archive& archive) {
    archive(group, address);
  }
};

/// A sound with a beginning and an end, as a transducer gives it to the water.
struct Signal {
  /// What it is, so that a listener knows what it listens to.
  enum class Kind {
    message,  ///< bits of a modem
    ping,     ///< asks transponders
    answer,   ///< of a transponder
    noise,    ///< carries no information
  };

  Kind kind = Kind::message;
  Decibels source_level{185};  ///< re 1 uPa at 1 m, on the axis of the transducer
  double centre_Hz = 25000;
  double bandwidth_Hz = 4000;  ///< that its power fills evenly
  Time duration{0};            ///< of the sound as it is sent
  Modulation modulation = Modulation::fsk;
  double bit_rate_bps = 80;   ///< Eb/N0 is the ratio of signal and noise times bandwidth / bit rate
  std::int64_t bits = 0;      ///< that must all come through; 0: it need only be detected
  double coding_gain_dB = 0;  ///< added to Eb/N0
  std::string network;        ///< listeners of another network do not understand it
  std::string code;           ///< defined by the listener: a frame type, the addressee of a ping
  Bytes payload;              ///< the listener's own
  Audience to;                ///< of a message: who it is for

  /// Above what any device sends.
  static constexpr double max_Hz = 1e9;

  /// Its numbers are within what any sound in water can have: levels and rates computed of them are finite.
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

/// Why a signal was not understood where it was received.
enum class SignalLoss {
  none,          ///< it was understood
  noise,         ///< too weak against the noise
  interference,  ///< too weak against other sounds
  half_duplex,   ///< the receiver was sending
  busy,          ///< the receiver was taking another signal
  captured,      ///< a stronger signal took the receiver over
  doppler,       ///< sender and receiver approach or separate too fast
  blocked,       ///< something stands between
  out_of_water,  ///< sender or receiver left the water
  receiver_off,  ///< without power, or silent by a fault
  link,          ///< `links:` of the world lost it
  range,         ///< too far away to be received
  sender_off,    ///< the sender lost its power, or was removed, in the middle of it
};
inline constexpr int signal_losses = 13;
/// The word of a cause, such as `half_duplex`.
const char* signal_loss_word(SignalLoss loss);

/// A signal as it came to a transducer that listens to it.
struct Reception {
  const Signal& signal;
  std::string source;                     ///< vehicle and device that sent it, such as `auv1/modem`
  int from = -1;                          ///< number of the sending transducer
  Time sent{0};                           ///< begin of sending
  Time started{0}, ended{0};              ///< of the sound at the receiver
  double travel_time_s = 0;               ///< from `sent` to `begun`, not rounded
  Vector3d p_sent_W = Vector3d::Zero();   ///< where the sender was at `sent`
  Vector3d p_begun_W = Vector3d::Zero();  ///< where the receiver was at `begun`
  Decibels level{0};                      ///< re 1 uPa, at the receiver, its directivity included
  Decibels snr{0};                        ///< in the band of the signal, against noise
  Decibels sinr{0};                       ///< against noise and other sounds, at its worst
  double closing_mps = 0;                 ///< Doppler: how fast sender and receiver came nearer
  SignalLoss loss = SignalLoss::none;
  bool detected = false;  ///< the receiver locked on to it, successfully or not

  bool understood() const { return loss == SignalLoss::none; }
};

}  // namespace sim
