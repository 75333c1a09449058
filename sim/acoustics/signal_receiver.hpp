// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/acoustics/signal.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// A sound that is at the receiver now.
struct PresentSound {
  std::int64_t flight = -1;  ///< its number in the channel
  double centre_Hz = 0, bandwidth_Hz = 0;
  PowerRatio power{0};   ///< re 1 uPa^2, in its own band
  Time ended{0};         ///< it is known when it will
  bool message = false;  ///< of a modem: no noise to another one's receiver, see TakenSignal::protection
  void visit_state(StateArchive& archive) { archive(flight, centre_Hz, bandwidth_Hz, power, ended, message); }
};

/// The properties of a signal that a receiver tries to lock on to.
struct TakenSignal {
  PresentSound sound;
  PowerRatio noise{0};       ///< re 1 uPa^2, in the band of the signal
  PowerRatio disturbing{0};  ///< echoes of the signal itself that come too late to help, in its band
  Modulation modulation = Modulation::fsk;
  double bit_rate_bps = 80;
  std::int64_t bits = 0;
  double coding_gain_dB = 0;
  /// Over other messages in its band: bits received below it are random.  Weaker messages act as noise.
  PowerRatio protection{0};
  Time started{0}, ended{0};
  void visit_state(StateArchive& archive) {
    archive(sound, noise, disturbing, modulation, bit_rate_bps, bits, coding_gain_dB, protection, started, ended);
  }
};

/// The receiver of a transducer: which of several overlapping signals it receives, and with what quality.  It locks
/// on to the first signal that it detects in a band; a much stronger one captures it.  Signals in bands apart from each
/// other are taken side by side.  While the interference is constant all bits have the same error probability, so the
/// probability of an error-free message is a product over such spans.
class SignalReceiver {
 public:
  struct Rules {
    double detection_dB = 6;  ///< signal over noise and other sounds, to notice a signal
    double capture_dB = 6;    ///< by which a signal must be stronger than the one that is taken
  };
  /// What came of a signal.
  struct Outcome {
    double success = 0;        ///< probability that all bits came through
    double success_alone = 0;  ///< the same if there had been no other sounds
    PowerRatio worst_sinr{0};
  };

  /// A sound begins.  Before take() of the same one.
  void begin(const PresentSound& sound, Time at);
  /// Tries to take a signal that has begun.  `displaced`: the flight that lost its band to it, or -1.  One that would
  /// capture more than one band is ignored.
  SignalLoss take(const TakenSignal& signal, const Rules& rules, std::int64_t& displaced);
  /// From now on the noise in the band of a signal that is taken is this.
  void set_noise(std::int64_t flight, PowerRatio noise, Time at);
  bool takes(std::int64_t flight) const;
  /// A sound stops before its end; its receiver continues until then.
  void silence(std::int64_t flight, Time at);
  /// A sound ends.  True, with the outcome, when it was taken.
  bool end(std::int64_t flight, Time at, Outcome& outcome);
  /// Releases the last signal being received; its flight, or -1 when there was none.
  std::int64_t drop();
  bool taking() const { return !taken_.empty(); }
  /// All flights it knows of have numbers from 0 to below this.
  bool flights_are_below(std::size_t count) const;
  void visit_state(StateArchive& archive);

 private:
  /// A signal being received, and its state so far.
  struct Taken {
    TakenSignal signal;
    Time counted_until{0};
    double log_success = 0, log_success_alone = 0;
    PowerRatio worst_sinr{0};
    void visit_state(StateArchive& archive) {
      archive(signal, counted_until);
      archive.not_only_finite(log_success, log_success_alone);  // -infinity: no bit is left
      archive(worst_sinr);
    }
  };

  struct Others {
    PowerRatio all{0}, messages{0};
  };
  /// Of all sounds but one, in its band, that last beyond a time.
  Others others(const PresentSound& but, Time at) const;
  /// Whether a signal is so much stronger than all else in its band.
  bool is_detectable(const TakenSignal& signal, PowerRatio needed) const;
  /// Counts the bits of what is taken since the last change.
  void count_bits(Time until);
  void count_bits(Taken& taken, Time until) const;

  std::vector<PresentSound> present_;
  std::vector<std::int64_t> present_flights_;  // of each of them: where many overlap, looked through often
  std::vector<Taken> taken_;
};

}  // namespace sim
