// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/acoustics/acoustic_events.hpp"
#include "sim/acoustics/flights.hpp"
#include "sim/acoustics/motion_clock.hpp"
#include "sim/acoustics/propagation/acoustics_config.hpp"
#include "sim/acoustics/propagation/sound_path.hpp"
#include "sim/acoustics/sonar_equation.hpp"
#include "sim/acoustics/transmissions.hpp"
#include "sim/medium/medium.hpp"

namespace sim {

/// Reception of signals: what an event of a flight does at its receiver.  This class owns nothing; it changes flights
/// and the receivers and counts of transducers.  Life of a flight:
/// 1. predict(), shortly before its arrival: time and place of the arrival, from the present motion of the receiver,
/// 2. start(): level and noise; the sound becomes an interferer of others, and the receiver may lock on to it.  If the
///    receiver was moved meanwhile, the arrival is predicted again; if the direct path is blocked, the start is delayed
///    until the first echo,
/// 3. silence(), only if the transmission was truncated: the sound ends early, the reception does not,
/// 4. end(): the result, and notify() if the device is to know.
/// abort_all() and update_noise() may come between.
///
/// Threads may handle events at different receivers: an event changes its receiver and flights to it, and all else goes
/// to ArrivalEffects.  notify() alone calls a device, which may transmit, and is never called by a thread.
class Receptions {
 public:
  /// The arguments must outlive the object.
  Receptions(const AcousticsConfig& config, const Medium& medium, const SonarEquation& sonar, const MotionClock& clock,
             const Transmissions& transmissions, Flights& flights)
      : config_(config),
        medium_(medium),
        sonar_(sonar),
        clock_(clock),
        transmissions_(transmissions),
        flights_(flights) {}

  /// Handles an event of AcousticEvent::near, start or end, the last without notify().
  void handle(FlightId id, AcousticEvent kind, Time due, ArrivalEffects& effects);
  /// Determines the result of a reception, and counts it.  Returns the minimum ratio of the signal to all else.
  Decibels end(FlightId id, Transducer& to);
  /// Whether the device is called at the end of a flight; see notify().
  bool notifies(const Flight& flight, const Transducer& to) const;
  /// Notifies the device unless the receiver itself cannot receive.  It may transmit.
  void notify(Transducer& to, const Flight& flight, Decibels sinr) const;
  void silence(FlightId id, Time due);
  /// Time of the early end of a truncated signal at a receiver, not before `now`; empty: it ends before.
  std::optional<Time> silent_from(FlightId id, const Transmission& transmission, Time now) const;
  /// Aborts all receptions of a transducer.
  void abort_all(Transducer& of, SignalLoss why);
  /// Updates the noise of all receptions, after a continuous sound started, ended or changed.
  void update_noise();

 private:
  void predict(FlightId id, Time due, ArrivalEffects& effects);
  void start(FlightId id, ArrivalEffects& effects);
  /// Arrival at a receiver that moves on at constant velocity; empty: it is faster than sound.
  std::optional<Arrival> arrival_at(const Transducer& to, const Transmission& transmission) const;
  void follow_ray(Arrival& arrival, const Transmission& transmission, const Vector3d& velocity_W) const;
  void receive(FlightId id, const SonarEquation::Level& found, Transducer& to, ArrivalEffects& effects);
  void lock_on(FlightId id, const SonarEquation::Level& found, Transducer& to, ArrivalEffects& effects);
  SignalLoss obstacle(const Flight& flight, const Transducer& to) const;

  const AcousticsConfig& config_;
  const Medium& medium_;
  const SonarEquation& sonar_;
  const MotionClock& clock_;
  const Transmissions& transmissions_;
  Flights& flights_;
};

}  // namespace sim
