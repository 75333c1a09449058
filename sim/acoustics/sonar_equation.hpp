// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "sim/acoustics/propagation/acoustics_config.hpp"
#include "sim/acoustics/propagation/propagation.hpp"
#include "sim/acoustics/transducer.hpp"
#include "sim/acoustics/transmissions.hpp"
#include "sim/medium/medium.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/random/random.hpp"

namespace sim {

/// Level and noise of a signal at its receiver: source level, less the losses of path and link, plus the directivity of
/// both ends; noise of the sea and of continuous sounds.  This class owns
/// - the propagation through the water of the world,
/// - the list of continuous sounds, which belong to devices.
///
/// It changes nothing: Receptions stores the results, in the order of level_at() at the start of a signal, noise_at(),
/// echo_lock(), and lost() at its end.  Random numbers are those of the pair of source and receiver, by the number of
/// the signal, so that another modem changes no other link and the order of calls does not matter.  Threads may share
/// it.
class SonarEquation {
 public:
  /// Signal at a receiver, by paths, links and directivity.
  struct Level {
    Decibels level{0};
    PowerRatio disturbing;  ///< of interfering echoes, re 1 uPa^2
    Time ended{0};
    double closing_mps = 0;
    double later_s = 0;  ///< delay of the first arrival when it is an echo
    bool bent = false, shadow = false, blocked = false;
    Vector3d arrives_W = Vector3d::Zero();
    std::vector<Propagation::Gain::Echo> echoes;
  };

  /// The arguments must outlive the object.
  SonarEquation(const AcousticsConfig& config, const Medium& medium, const PhysicsWorld& physics, std::uint64_t seed)
      : config_(config), medium_(medium), seed_(seed), propagation_(config, medium, physics) {}

  const Propagation& propagation() const { return propagation_; }
  void add(ContinuousSound& sound) { sounds_.push_back(&sound); }
  void remove(ContinuousSound& sound) { std::erase(sounds_, &sound); }

  /// Level at a receiver that is at `p_W` when the signal starts.
  Level level_at(const Transducer& to, const Vector3d& p_W, Time started, const Transmission& transmission) const;
  /// Noise of the sea and of continuous sounds in the band of a signal, as received.
  PowerRatio noise_at(const Transducer& to, const Vector3d& p_W, const Signal& signal) const;
  /// Draws the echo that the receiver takes for the first arrival; null: none.
  const Propagation::Gain::Echo* echo_lock(Decibels snr, const Transducer& to, const Transmission& transmission,
                                           const std::vector<Propagation::Gain::Echo>& echoes) const;
  /// Draws whether a signal that the receiver was locked on to until its end is lost, and why; `before`: if it is not.
  SignalLoss lost(const Transducer& to, const Transmission& transmission, const SignalReceiver::Outcome& outcome,
                  SignalLoss before) const;

  /// Visits the continuous sounds, which their devices do not visit.
  void visit_state(StateArchive& archive) {
    for (ContinuousSound* sound : sounds_) archive(*sound);
  }

 private:
  double doppler(Level& at, const Vector3d& leaves_W, double c_mps, const Transducer& to,
                 const Transmission& transmission) const;
  /// Random stream of a signal at a receiver, for its start or its end.
  Random stream(const Transducer& to, const Transmission& transmission, bool at_end) const;

  const AcousticsConfig& config_;
  const Medium& medium_;
  const std::uint64_t seed_;
  Propagation propagation_;
  std::vector<ContinuousSound*> sounds_;
};

}  // namespace sim
