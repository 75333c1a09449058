// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "sim/acoustics/propagation/signal.hpp"
#include "sim/base/math.hpp"
#include "sim/base/time.hpp"

namespace sim {

/// Start of a transmission, as reported to an observer.
struct SoundSent {
  const Signal& signal;
  const std::string& source;  ///< sending vehicle and device, such as `auv1/modem`
  std::int64_t sequence = 0;  ///< number of the signal among those of its source
  Time sent{0};
  Vector3d p_W = Vector3d::Zero();  ///< position of the sender at `sent`
  double sound_speed_mps = 0;       ///< of the water at the sender
};

/// Result of a signal at one receiver, as reported to an observer.
struct SoundArrived {
  const std::string& source;  ///< see SoundSent
  std::int64_t sequence = 0;
  const std::string& receiver;      ///< receiving vehicle and device
  bool addressed = false;           ///< the signal was addressed to the receiver, or broadcast to its group
  Time started{0}, ended{0};        ///< at the receiver; for SignalLoss::range the time of transmission
  double travel_time_s = 0;         ///< 0 for SignalLoss::range
  Vector3d p_W = Vector3d::Zero();  ///< position of the receiver at `started`
  double snr_dB = 0;                ///< signal-to-noise ratio in the band of the signal
  SignalLoss loss = SignalLoss::none;
};

/// Observer of the acoustic channel, for viewers and records.  It must not change the world, and is not state.
class SoundObserver {
 public:
  virtual ~SoundObserver() = default;
  /// Is called when a transmission starts.
  virtual void sound_sent(const SoundSent& sent) = 0;
  /// Is called for each receiver that listens to a signal, at its end there, and for each addressed receiver beyond the
  /// range of reception.
  virtual void sound_arrived(const SoundArrived& arrived) = 0;
};

}  // namespace sim
