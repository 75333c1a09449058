// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/acoustics/numbered_pool.hpp"
#include "sim/acoustics/propagation/signal.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// Sound that is present at the receiver.
struct PresentSound {
  FlightId flight;
  double centre_Hz = 0, bandwidth_Hz = 0;
  PowerRatio power{0};   ///< re 1 uPa^2, in its own band
  Time ended{0};         ///< end time, known in advance
  bool message = false;  ///< of a modem: see TakenSignal::protection
  void visit_state(StateArchive& archive);
};

/// Properties of a signal that a receiver tries to lock on to.
struct TakenSignal {
  PresentSound sound;
  PowerRatio noise{0};       ///< re 1 uPa^2, in the band of the signal
  PowerRatio disturbing{0};  ///< late echoes of the signal itself, in its band
  Modulation modulation = Modulation::fsk;
  double bit_rate_bps = 80;
  std::int64_t bits = 0;
  double coding_gain_dB = 0;
  /// Protection ratio over other messages in its band: bits received below it are random.  Weaker messages act as
  /// noise.
  PowerRatio protection{0};
  Time started{0}, ended{0};
  void visit_state(StateArchive& archive) {
    archive(sound, noise, disturbing, modulation, bit_rate_bps, bits, coding_gain_dB, protection, started, ended);
  }
};

/// Receiver of a transducer: determines which of several overlapping signals is received, and with what quality.  It
/// locks on to the first signal that it detects in a band; a much stronger one captures it.  Signals in separate bands
/// are received in parallel.  While the interference is constant all bits have the same error probability, so that the
/// probability of an error-free message is a product over such intervals.
class SignalReceiver {
 public:
  struct Rules {
    double detection_dB = 6;  ///< minimum ratio to noise and other sounds for detection
    double capture_dB = 6;    ///< minimum ratio to the signal being received for capture
  };
  /// Result of a reception.
  struct Outcome {
    double success = 0;        ///< probability that all bits are correct
    double success_alone = 0;  ///< the same without other sounds
    PowerRatio worst_sinr{0};
  };

  /// Adds a sound that starts.  Call before take() of the same sound.
  void begin(const PresentSound& sound, Time at);
  /// Tries to lock on to a signal that has started.  `displaced`: flight from which it captured the receiver, or
  /// none.  A signal that
  /// would capture more than one band is ignored.
  SignalLoss take(const TakenSignal& signal, const Rules& rules, FlightId& displaced);
  /// Sets the noise in the band of a signal being received, from this time on.
  void set_noise(FlightId flight, PowerRatio noise, Time at);
  /// Whether the receiver is locked on to a flight.
  bool takes(FlightId flight) const;
  /// Sets the power of a sound to zero before its end; its reception continues until the end.
  void silence(FlightId flight, Time at);
  /// Removes a sound that ends.  Returns true, with the outcome, when the receiver was locked on to it.
  bool end(FlightId flight, Time at, Outcome& outcome);
  /// Aborts the reception of the last signal; returns its flight, or none.
  FlightId drop();
  bool taking() const { return !taken_.empty(); }
  /// Whether all its flights have numbers in [0, count).
  bool flights_are_below(std::size_t count) const;
  void visit_state(StateArchive& archive);
  /// Adds its content to a hash, with a sum over the sounds that is kept up to date: their order is not in it.
  void add_content(StateArchive& hash);

 private:
  /// Reception in progress.
  struct Taken {
    TakenSignal signal;
    Time counted_until{0};
    double log_success = 0, log_success_alone = 0;
    PowerRatio worst_sinr{0};
    void visit_state(StateArchive& archive) {
      archive(signal, counted_until);
      archive.not_only_finite(log_success, log_success_alone);  // -infinity: zero probability
      archive(worst_sinr);
    }
  };

  struct Others {
    PowerRatio all{0}, messages{0};
  };
  /// Power of all sounds except one, in its band, that end after a time.
  Others others(const PresentSound& but, Time at) const;
  /// Whether a signal exceeds the sum of all other sounds in its band by this ratio.
  bool is_detectable(const TakenSignal& signal, PowerRatio needed) const;
  /// Accumulates the bits of the receptions since the last change.
  void count_bits(Time until);
  void count_bits(Taken& taken, Time until) const;

  static std::uint64_t hash_of(const PresentSound& sound);
  std::span<PresentSound> present() { return std::span(present_).subspan(first_); }
  std::span<const PresentSound> present() const { return std::span(present_).subspan(first_); }
  void drop_ended();

  // In the order of their starts, from `first_` on.  Most sounds end in about this order, so that they are found near
  // the front.
  std::vector<PresentSound> present_;
  std::size_t first_ = 0;
  std::uint64_t present_sum_ = 0;  // of the hashes of present()
  std::vector<Taken> taken_;
};

}  // namespace sim
