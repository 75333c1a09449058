// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/acoustics/acoustics_config.hpp"
#include "sim/acoustics/neighborhood.hpp"
#include "sim/acoustics/propagation.hpp"
#include "sim/acoustics/signal.hpp"
#include "sim/acoustics/sound_observer.hpp"
#include "sim/acoustics/sound_path.hpp"
#include "sim/acoustics/transducer.hpp"
#include "sim/event/event_queue.hpp"
#include "sim/medium/medium.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/random/random.hpp"
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

/// Message that a shadow took from its addressee.
struct ShadowLoss {
  Time sent{0};
  std::string source, receiver;  ///< vehicle and device
  double range_m = 0;
  void visit_state(StateArchive& archive) { archive(sent, source, receiver, range_m); }
};

/// Underwater acoustic channel between transducers, driven by events in simulated time.  A signal travels from the
/// position of the sender at transmission to that of the receiver at arrival: along the straight line at the mean
/// slowness of the water along it, or along a ray.  docs/models/acoustics.md has the equations and their sources.
class AcousticChannel {
 public:
  AcousticChannel(const AcousticsConfig& config, const AcousticSurroundings& surroundings);
  ~AcousticChannel();

  const AcousticsConfig& config() const { return config_; }
  bool has_water() const { return around_.medium.has_water(); }
  /// Handles an event of the channel; `now`: the end of the step that just ended.
  void handle(const Event& event, Time now);
  /// Takes a due event that changes nothing but its receiver, so that threads may handle it with others.  Returns false
  /// for other events: call handle_deferred() before those are handled.
  bool defer(const Event& event, Time now);
  /// Handles the deferred events, and those that follow from them before `until`, in their order at each receiver, in
  /// the threads of a pool; null: none.  The result does not depend on the threads.  Returns whether there were any.
  bool handle_deferred(Time until, Time now, ThreadPool* threads);
  /// Sets an observer of all signals; null: none.  It must outlive the channel or be removed.
  void set_observer(SoundObserver* observer) { observer_ = observer; }
  /// Discards the list of neighbors.  Call after a transducer was moved.
  void discard_places();
  /// Discards the minimum signal levels and the list of neighbors.  Call after a receiver changed.
  void clear_receivers();
  /// Number of messages sent to this address, since the last transducer with it was removed, or to its whole group
  /// since the start.
  std::int64_t messages_for(const Audience& own) const;
  /// Counts of all removed transducers.
  const Transducer::Counts& counts_of_removed() const { return removed_; }

  /// Messages lost in shadows: the first `max_shadow_losses`.
  const std::vector<ShadowLoss>& shadow_losses() const { return shadow_losses_; }
  static constexpr std::size_t max_shadow_losses = 100;
  /// Keys of `acoustics:` whose effects are on: refraction, leaks into shadows, echo locks.
  std::vector<std::string> effects() const;

  /// Transducers in device order; null where one was removed.
  const std::vector<Transducer*>& transducers() const { return transducers_; }
  /// Assigns these numbers to the next transducers, to rebuild a world.  Returns false when a number is invalid or in
  /// use.
  bool prescribe(std::vector<int> numbers);
  /// Whether all prescribed numbers have been assigned.
  bool as_prescribed() const { return prescribed_.empty(); }
  const Propagation& propagation() const { return propagation_; }
  /// Number of receptions since the start, successful or not: a measure of the work.
  std::int64_t flights() const { return flights_made_; }
  /// Number of events deferred since the start.
  std::int64_t deferred() const { return deferred_events_; }
  /// Number of transducers examined in the search for receivers, since the start.
  std::int64_t examined() const { return examined_; }
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
  enum EventKind { emission_event, emission_end_event, near_event, start_event, end_event, watch_event, silence_event };

  /// Transmission in progress.
  struct Sending {
    Signal signal;
    Transducer* from = nullptr;  // null: removed
    std::string source;
    int number = -1;
    int group = -1;
    std::int64_t sequence = 0;  // of the sender's signals
    Time sent{0};
    Vector3d p_W = Vector3d::Zero(), v_W = Vector3d::Zero();
    Matrix3d R_WS = Matrix3d::Identity();
    DirectivityConfig directivity;
    SignalLoss cut = SignalLoss::none;        // cause of an early end
    Time cut_after{0};                        // duration sent until then
    int users = 0;                            // flights and events that refer to it
    std::vector<int> flights;                 // all that were made; numbers of ended ones may have other signals now
    void visit_state(StateArchive& archive);  // except `from`
  };
  /// Propagation of a signal to one receiver.
  struct Flight {
    int sending = -1;
    int to = -1;  // number of the transducer; -1: removed
    Time started{0}, ended{0};
    double travel_time_s = 0;
    Vector3d p_started_W = Vector3d::Zero();
    double closing_mps = 0;
    Decibels level{0}, snr{0};
    SignalLoss loss = SignalLoss::none;
    std::uint32_t to_join = 0;  // differs from the transducer's when its number was reused
    bool listened = false, present = false, detected = false, delayed = false;
    bool meant = false;                       // addressed to the receiver
    bool shadow = false;                      // no ray without a bounce reaches the receiver
    bool bent = false;                        // arrives_W is that of a ray
    Vector3d arrives_W = Vector3d::Zero();    // unit vector along the sound at the receiver
    double lock_later_s = 0;                  // delay of the echo that the receiver takes for the first arrival
    std::uint64_t hash = 0;                   // as in flights_sum_
    void visit_state(StateArchive& archive);  // except `to`
  };

  /// Strength of a signal at a receiver, by paths and directivity.
  struct Level {
    Decibels level{0};
    PowerRatio disturbing;  // of interfering echoes, re 1 uPa^2
    Time ended{0};
    double closing_mps = 0;
    double later_s = 0;  // delay of the first arrival when it is an echo
    bool bent = false, shadow = false, blocked = false;
    Vector3d arrives_W = Vector3d::Zero();
    std::vector<Propagation::Gain::Echo> echoes;
  };
  /// What follows from an event at a receiver, outside of it.
  struct Consequences {
    struct Due {
      Time at{0};
      EventKind kind = near_event;
    };
    std::array<Due, 2> events;  // of the same flight
    int count = 0;
    bool ended = false;     // the flight
    std::uint64_t sum = 0;  // change of flights_sum_
    void schedule(Time at, EventKind kind) { events[static_cast<std::size_t>(count++)] = {at, kind}; }
  };
  /// Event that is handled with others.
  struct Deferred {
    Time due{0};
    EventKind kind = near_event;
    int flight = -1;
    int next = -1;  // at the same receiver
    Consequences consequences;
  };

  /// Add and remove transducers and continuous sounds.
  void join(Transducer& transducer);
  void leave(Transducer& transducer);
  /// Erases the count of an address that no transducer has any more.
  void discard_messages_for(const Audience& removed);
  void join(ContinuousSound& sound);
  void leave(ContinuousSound& sound);
  void transmit(Transducer& from, Signal signal, Time at);
  /// Cancels the signals that have not started.  Returns the end of the present transmission.
  Time call_back(Transducer& from);

  /// Receiver of a flight; null when it was removed.
  Transducer* receiver_of(const Flight& flight) const {
    Transducer* const to = flight.to < 0 ? nullptr : transducers_[static_cast<std::size_t>(flight.to)];
    return to != nullptr && to->join_ == flight.to_join ? to : nullptr;
  }
  static void set_receiver(Flight& flight, const Transducer* to);
  void begin_handling(Time now);
  void fetch_ahead() const;
  void emit(int sending, Time now);
  void send_to(int sending, Transducer& to);
  /// Updates the neighbors when they are outdated, for the audible range of this signal.  Returns that range, m.
  double update_neighbors(const Signal& signal, Time now);
  void end_emission(int sending, Time at);
  /// Ends a transmission early.
  void cut(int sending, SignalLoss why, Time at);
  /// Time of the early end of a cut signal at a receiver; empty: it ends before.
  std::optional<Time> silent_from(int flight, const Sending& sending, Time now) const;
  void follow_ray(Arrival& arrival, const Sending& sending, const Vector3d& velocity_W) const;
  /// Arrival at a receiver that moves on at constant velocity; empty: it is faster than sound.
  std::optional<Arrival> arrival_at(const Transducer& to, const Sending& sending) const;
  // Events at a receiver.
  void approach(int flight, Time due, Consequences& out);
  void begin(int flight, Consequences& out);
  /// Ends a flight without a call of the listener.
  void end_quietly(int flight, Consequences& out);
  void end(int flight);
  void fall_silent(int flight, Time due);
  void handle_at_receiver(int first, Time until);
  void handle_at_receiver(int flight, EventKind kind, Time due, Consequences& out);
  void carry_out(int flight, const Consequences& consequences);
  /// Determines the result of a reception, and counts it.  Returns the minimum ratio of the signal to all else.
  Decibels end_at(Transducer& to, int flight);
  void notify(Transducer& to, const Flight& flight, const Sending& sending, Decibels sinr);
  /// Reports a flight that has ended.
  void conclude(int flight);
  void discard(int flight);
  /// Checks whether active senders and receivers still have power and are in the water.
  void watch();
  bool can(const Transducer& transducer) const;
  /// Aborts all receptions of a transducer.
  void drop_receptions(Transducer& of, SignalLoss why);
  /// Updates the noise of receptions after a continuous sound started, ended or changed.
  void noise_changed();
  /// Margin below the noise within which a signal can affect a receiver.
  Decibels min_level(double frequency_Hz) const;
  Decibels compute_min_level(double frequency_Hz) const;
  // Reports to the observer; they change nothing.
  void report_sent(const Sending& sending) const;
  void report_beyond_range(const Sending& sending, double reach_m) const;
  void report_arrival(const Flight& flight, const Sending& sending, const Transducer& to) const;
  /// Computes the level of a flight at its receiver, which is at `p_W` when it starts.
  Level level_at(const Transducer& to, const Vector3d& p_W, const Flight& flight, const Sending& sending) const;
  /// Reason why a signal cannot be decoded, independent of other signals.
  SignalLoss obstacle(const Flight& flight) const;
  /// Draws whether the receiver takes an echo for the first arrival.
  void lock(Flight& flight, const Sending& sending, const std::vector<Propagation::Gain::Echo>& echoes) const;
  Decibels link_loss(const Transducer& to, const Sending& sending, double& loss_probability) const;
  /// Noise of the sea and of continuous sounds in the band of a signal, as received.
  PowerRatio noise_at(const Transducer& to, const Vector3d& p_W, const Signal& signal) const;
  void take(int number, Flight& flight, const Sending& sending, PowerRatio power, PowerRatio disturbing,
            Consequences& out);
  void finish(const Transducer& to, Flight& flight, const Sending& sending, const SignalReceiver::Outcome& outcome);
  /// Random stream of a signal at a receiver, for its start or its end.
  Random stream(const Transducer& to, const Sending& sending, bool at_end) const;
  void schedule(Time due, EventKind kind, int item);
  Transducer* visit_transducer(StateArchive& archive, const Transducer* transducer);
  void check_numbers(const StateArchive& archive) const;
  std::uint64_t hash_of(int number, const Flight& flight) const;
  /// Must be called after a flight has changed.  `sum`: flights_sum_, or a change of it.
  void update_hash(int number, std::uint64_t& sum);
  int new_sending();
  int new_flight();
  void release(int sending);
  Time step_end() const { return step_end_; }
  /// Number of the present state of motion, while events are handled; else negative.  It changes when bodies may have
  /// moved.
  std::int64_t look() const { return handling_ ? polls_ : -1; }

  AcousticsConfig config_;
  AcousticSurroundings around_;
  Propagation propagation_;
  std::vector<Transducer*> transducers_;
  std::vector<int> prescribed_;  // numbers of transducers, the next one last
  std::vector<ContinuousSound*> sounds_;
  std::vector<std::unique_ptr<Sending>> sendings_;
  std::vector<int> free_sendings_;
  std::vector<Flight> flights_;
  std::vector<int> free_flights_;
  std::uint64_t flights_sum_ = 0;  // of the hashes of the flights in use
  bool sum_outdated_ = false;
  std::int64_t flights_made_ = 0;
  Time step_end_{0};
  std::uint32_t joins_ = 0;
  std::int64_t polls_ = 0;
  bool handling_ = false;
  Neighborhood neighbors_;
  double neighbors_age_ = -1;                                            // time of the last search, s; negative: none
  double lowest_m_ = 0;                                                  // z of the lowest transducer at that time
  std::map<std::string, std::map<std::string, std::int64_t>> messages_;  // sent, by group and address
  mutable std::vector<std::pair<double, Decibels>> min_levels_;          // cache by frequency
  mutable std::int64_t examined_ = 0;
  SoundObserver* observer_ = nullptr;
  bool watching_ = false;  // a watch_event is scheduled
  Transducer::Counts removed_;
  std::vector<ShadowLoss> shadow_losses_;
  std::vector<int> near_;
  // While events are deferred: the first and last at each receiver, or -1, and the receivers that have any.
  std::vector<Deferred> deferred_;
  std::vector<std::array<int, 2>> deferred_at_;
  std::vector<std::size_t> receivers_;
  std::int64_t deferred_events_ = 0;
};

}  // namespace sim
