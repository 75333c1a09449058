// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/acoustics/acoustics_config.hpp"
#include "sim/acoustics/neighbourhood.hpp"
#include "sim/acoustics/propagation.hpp"
#include "sim/acoustics/signal.hpp"
#include "sim/acoustics/transducer.hpp"
#include "sim/event/event_queue.hpp"
#include "sim/medium/medium.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/random/random.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// What the channel knows of the world.
struct AcousticSurroundings {
  const Medium& medium;
  const PhysicsWorld& physics;
  EventQueue& events;
  std::uint64_t seed;
};

/// Carries sound through the water from transducer to transducer, by events in simulated time.  A signal goes along
/// the straight line from where the sender was to where the receiver is when it arrives, at the mean slowness of the
/// water along it.  docs/models/acoustics.md has the equations and their sources.
class AcousticChannel {
 public:
  AcousticChannel(const AcousticsConfig& config, const AcousticSurroundings& surroundings);
  ~AcousticChannel();

  const AcousticsConfig& config() const { return config_; }
  bool has_water() const { return around_.medium.has_water(); }
  /// An event of the channel is due; `now` is the end of the step that just ended.
  void handle(const Event& event, Time now);
  /// A transducer was moved: neighbours are searched again.
  void discard_places() { neighbours_age_ = -1; }
  /// A receiver changed: how faint a sound may be and matter is looked up again.
  void clear_receivers();
  /// Messages that were sent to this one, since the last with its address left, or all of its group since the start.
  std::int64_t messages_for(const Audience& own) const;
  /// What transducers that have left sent and received.
  const Transducer::Counts& counts_of_removed() const { return removed_; }

  /// In device order; null where one has left.
  const std::vector<Transducer*>& transducers() const { return transducers_; }
  /// For rebuilding a world: the transducers that join next get these numbers.  False: one is taken or cannot
  /// be.
  bool prescribe(std::vector<int> numbers);
  bool as_prescribed() const { return prescribed_.empty(); }
  const Propagation& propagation() const { return propagation_; }
  /// Receptions, received or not, since the start: what the work grows with.
  std::int64_t flights() const { return flights_made_; }
  /// Number of transducers examined in the search for receivers, since the start.
  std::int64_t examined() const { return examined_; }
  /// With the transducers and continuous sounds, whose devices do not.
  void visit_state(StateArchive& archive);
  /// `events`: all that are due later, of whomever.  Throws SnapshotError when those of the channel do not fit its
  /// signals.
  void check_events(std::span<const Event> events, const StateArchive& archive) const;

 private:
  friend class Transducer;
  friend class ContinuousSound;
  enum EventKind { emission_event, emission_end_event, near_event, start_event, end_event, watch_event, silence_event };

  /// A signal under way.
  struct Sending {
    Signal signal;
    Transducer* from = nullptr;  // null: it left
    std::string source;
    int number = -1;
    int group = -1;
    std::int64_t sequence = 0;  // of the sender's signals
    Time sent{0};
    Vector3d p_W = Vector3d::Zero(), v_W = Vector3d::Zero();
    Matrix3d R_WS = Matrix3d::Identity();
    DirectivityConfig directivity;
    SignalLoss cut = SignalLoss::none;        // why the sender stopped before the end
    Time cut_after{0};                        // of what it sent until then
    int users = 0;                            // flights and events that still need it
    void visit_state(StateArchive& archive);  // but for `from`
  };
  /// A signal on its way to one receiver.
  struct Flight {
    int sending = -1;
    int to = -1;  // number of the transducer; -1: it left
    Time started{0}, ended{0};
    double travel_time_s = 0;
    Vector3d p_begun_W = Vector3d::Zero();
    double closing_mps = 0;
    Decibels level{0}, snr{0};
    SignalLoss loss = SignalLoss::none;
    std::uint32_t to_join = 0;  // else another has its number now
    bool listened = false, present = false, detected = false, delayed = false;
    bool meant = false;                       // it is for the receiver
    void visit_state(StateArchive& archive);  // but for `to`
  };

  void join(Transducer& transducer);
  void leave(Transducer& transducer);
  /// When no other transducer has that address.
  void discard_messages_for(const Audience& removed);
  void join(ContinuousSound& sound);
  void leave(ContinuousSound& sound);
  void transmit(Transducer& from, Signal signal, Time at);
  /// Of signals that have not begun.  Until when it sends.
  Time call_back(Transducer& from);

  /// Null when it left.
  Transducer* receiver_of(const Flight& flight) const {
    Transducer* const to = flight.to < 0 ? nullptr : transducers_[static_cast<std::size_t>(flight.to)];
    return to != nullptr && to->join_ == flight.to_join ? to : nullptr;
  }
  static void set_receiver(Flight& flight, const Transducer* to);
  void fetch_ahead() const;
  void emit(int sending, Time now);
  void send_to(int sending, Transducer& to);
  /// Updates the neighbours when they are outdated, for signals of this range.  Returns that range, m.
  double update_neighbours(const Signal& signal, Time now);
  void end_emission(int sending, Time at);
  /// The sender stops before the end.
  void cut(int sending, SignalLoss why, Time at);
  /// The receiver will be notified, if the signal still exists then.
  void schedule_silence(int flight, const Sending& sending, Time now);
  void approach(int flight, Time due);
  void begin(int flight);
  void fall_silent(int flight, Time due);
  /// Checks whether senders and receivers of signals are still able to.
  void watch();
  bool can(const Transducer& transducer) const;
  /// A continuous sound began, ended or changed.
  void noise_changed();
  /// Margin below the noise within which a signal may still matter to a receiver.
  Decibels min_level(double frequency_Hz) const;
  Decibels compute_min_level(double frequency_Hz) const;
  void end(int flight);
  /// Level, end and Doppler.  Returns the power of echoes that disturb, re 1 uPa^2.
  /// `later_s`: by which the first sound is an echo's.
  PowerRatio compute_level(Flight& flight, const Sending& sending, double& later_s);
  /// The reason why it cannot be decoded, independent of other signals.
  SignalLoss obstacle(const Flight& flight) const;
  Decibels link_loss(const Transducer& to, const Sending& sending, double& loss_probability) const;
  /// Of the sea and of continuous sounds, in the band of a signal, as a receiver receives it.
  PowerRatio noise_at(const Transducer& to, const Vector3d& p_W, const Signal& signal) const;
  void take(int number, Flight& flight, const Sending& sending, PowerRatio power, PowerRatio disturbing);
  void finish(const Transducer& to, Flight& flight, const Sending& sending, const SignalReceiver::Outcome& outcome);
  /// Its draws when a signal begins, and when it ends.
  Random stream(const Transducer& to, const Sending& sending, bool at_end) const;
  void schedule(Time due, EventKind kind, int item);
  Transducer* visit_transducer(StateArchive& archive, const Transducer* transducer);
  void check_numbers(const StateArchive& archive) const;
  int new_sending();
  int new_flight();
  void release(int sending);
  Time step_end() const { return step_end_; }
  /// While events are handled: its own number for each time that bodies may have moved.  Else negative.
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
  std::int64_t flights_made_ = 0;
  Time step_end_{0};
  std::uint32_t joins_ = 0;
  std::int64_t polls_ = 0;
  bool handling_ = false;
  Neighbourhood neighbours_;
  double neighbours_age_ = -1;                                           // when they were looked up, s; negative: not
  double lowest_m_ = 0;                                                  // z of the lowest of them then
  std::map<std::string, std::map<std::string, std::int64_t>> messages_;  // sent, by group and address
  mutable std::vector<std::pair<double, Decibels>> min_levels_;          // of a frequency, computed before
  mutable std::int64_t examined_ = 0;
  bool watching_ = false;  // a watch_event is under way
  Transducer::Counts removed_;
  std::vector<int> near_;
};

}  // namespace sim
