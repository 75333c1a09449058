// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/acoustics/deferred_arrivals.hpp"
#include "sim/acoustics/flights.hpp"
#include "sim/acoustics/message_counts.hpp"
#include "sim/acoustics/motion_clock.hpp"
#include "sim/acoustics/propagation/acoustics_config.hpp"
#include "sim/acoustics/propagation/propagation.hpp"
#include "sim/acoustics/propagation/signal.hpp"
#include "sim/acoustics/receiver_search.hpp"
#include "sim/acoustics/receptions.hpp"
#include "sim/acoustics/sonar_equation.hpp"
#include "sim/acoustics/sound_observer.hpp"
#include "sim/acoustics/sound_reports.hpp"
#include "sim/acoustics/transducer.hpp"
#include "sim/acoustics/transducers.hpp"
#include "sim/acoustics/transmissions.hpp"
#include "sim/event/event_queue.hpp"
#include "sim/medium/medium.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

class ThreadPool;

/// Parts of the world that the channel uses.
struct AcousticSurroundings {
  const Medium& medium;
  const PhysicsWorld& physics;
  EventQueue& events;
  std::uint64_t seed;
};

/// Underwater acoustic channel between transducers, driven by events in simulated time.  A signal travels from the
/// position of the sender at transmission to that of the receiver at arrival: along the straight line at the mean
/// slowness of the water along it, or along a ray.  docs/models/acoustics.md has the equations and their sources.
///
/// The channel handles the events, and notifies its objects of added and removed transducers.  Each header begins with
/// what it owns:
///
///     Transducers     by number; counts of removed ones     MotionClock       the step of the events
///     Transmissions   from their request to the last use    MessageCounts     sent, by address
///     Flights         of a transmission to each receiver    ReceiverSearch    who is in range
///     SonarEquation   levels and noise; continuous sounds   DeferredArrivals  events that threads share
///     Receptions      what a flight does at its receiver    SoundReports      observer; losses in shadows
///
/// Events of a transmission: its start adds a flight to each transducer in range, its end follows after its duration.
/// Events of each flight: one shortly before its arrival, its start and its end at the receiver.  Every 0.1 s all that
/// transmit or receive are checked for power and water.
///
/// The order in the snapshot is that of visit_state(); each object visits its own part of it.
class AcousticChannel {
 public:
  AcousticChannel(const AcousticsConfig& config, const AcousticSurroundings& surroundings);
  ~AcousticChannel();

  const AcousticsConfig& config() const { return config_; }
  bool has_water() const { return around_.medium.has_water(); }
  /// The step whose events are handled.
  const MotionClock& clock() const { return clock_; }
  /// Handles an event of the channel; `now`: the end of the step that just ended.
  void handle(const Event& event, Time now);
  /// Takes a due event that changes nothing but its receiver, so that threads may handle it with others.  Returns false
  /// for other events: call handle_deferred() before those are handled.
  bool defer(const Event& event, Time now);
  /// Handles the deferred events, and those that follow from them before `until`, in their order at each receiver, in
  /// the threads of a pool; null: none.  The result does not depend on the threads.  Returns whether there were any.
  bool handle_deferred(Time until, Time now, ThreadPool* threads);
  /// Sets an observer of all signals; null: none.  It must outlive the channel or be removed.
  void set_observer(SoundObserver* observer) { reports_.set_observer(observer); }
  /// Discards the list of neighbors.  Call after a transducer was moved.
  void discard_places() { search_.discard_places(); }
  /// Discards the minimum signal levels and the list of neighbors.  Call after a receiver changed.
  void clear_receivers() { search_.discard_all(); }
  /// Number of messages sent to this address, since the last transducer with it was removed, or to its whole group
  /// since the start.
  std::int64_t messages_for(const Audience& own) const { return messages_.sent_to(own); }
  /// Counts of all removed transducers.
  const Transducer::Counts& counts_of_removed() const { return transducers_.counts_of_removed(); }

  /// Messages lost in shadows: the first `SoundReports::max_shadow_losses`.
  const std::vector<ShadowLoss>& shadow_losses() const { return reports_.shadow_losses(); }
  /// Keys of `acoustics:` whose effects are on: refraction, leaks into shadows, echo locks.
  std::vector<std::string> effects() const;

  /// Transducers in device order; null where one was removed.
  const std::vector<Transducer*>& transducers() const { return transducers_.all(); }
  /// Assigns these numbers to the next transducers, to rebuild a world.  Throws std::out_of_range when a number is
  /// invalid or in use.
  void prescribe(const std::vector<int>& numbers) { transducers_.prescribe(numbers); }
  /// Whether all prescribed numbers have been assigned.
  bool as_prescribed() const { return transducers_.as_prescribed(); }
  const Propagation& propagation() const { return sonar_.propagation(); }
  /// Number of receptions since the start, successful or not: a measure of the work.
  std::int64_t flights() const { return flights_.made(); }
  /// Number of events deferred since the start.
  std::int64_t deferred() const { return deferred_.handled(); }
  /// Number of transducers examined in the search for receivers, since the start.
  std::int64_t examined() const { return search_.examined(); }
  /// Visits the state, including transducers and continuous sounds; their devices do not visit them.
  void visit_state(StateArchive& archive);
  /// Returns a hash of the state that costs little with many signals in flight: it has sums over them that are kept up
  /// to date.  The order of the sounds at a receiver, which their sum depends on in the last bits, is not in it.
  std::uint64_t content_hash();
  /// Checks restored events against the signals.  `events`: all queued events of the world.  Throws SnapshotError when
  /// events and signals of the channel do not match.
  void check_events(std::span<const Event> events, const StateArchive& archive) const;

 private:
  friend class Transducer;
  friend class ContinuousSound;
  void add(Transducer& transducer);
  void remove(Transducer& transducer);
  void add(ContinuousSound& sound);
  void remove(ContinuousSound& sound);
  /// Updates the noise of receptions after a continuous sound started, ended or changed.
  void noise_changed() { receptions_.update_noise(); }
  void transmit(Transducer& from, Signal signal, Time at);
  /// Cancels the transmissions that have not started.  Returns the end of the present one.
  Time cancel_pending(Transducer& from);

  // Events of transmissions.
  void start_transmission(TransmissionId id, Time now);
  void end_transmission(TransmissionId id, Time at);
  void add_flight(TransmissionId id, Transducer& to);
  /// Ends a transmission early.
  void truncate(TransmissionId id, SignalLoss why, Time at);
  /// Checks whether active senders and receivers still have power and are in the water.
  void watch();
  // Events of flights.
  void end_flight(FlightId id);
  void apply(FlightId id, const ArrivalEffects& effects);
  void report_arrival(FlightId id);
  void remove_flight(FlightId id);

  void schedule_event(Time due, AcousticEvent kind, int number) { schedule(around_.events, due, kind, number); }
  void prefetch() const;
  void check_numbers(const StateArchive& archive) const;

  AcousticsConfig config_;
  AcousticSurroundings around_;
  MotionClock clock_;
  Transducers transducers_;
  Transmissions transmissions_;
  Flights flights_;
  SonarEquation sonar_;
  Receptions receptions_;
  ReceiverSearch search_;
  MessageCounts messages_;
  SoundReports reports_;
  DeferredArrivals deferred_;
  bool watching_ = false;  // an event of AcousticEvent::watch is scheduled
};

}  // namespace sim
