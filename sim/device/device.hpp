// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "sim/base/math.hpp"
#include "sim/base/state_hash.hpp"
#include "sim/base/step_memory.hpp"
#include "sim/base/time.hpp"
#include "sim/bus/bus.hpp"
#include "sim/random/random.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

class Body;
class Vehicle;
class VehicleClock;
class World;

/// Where and when a sensor samples.
struct SenseContext {
  const World& world;      ///< as it stands at `now`
  const Vehicle& vehicle;  ///< the vehicle that carries the sensor
  Time now;                ///< the time sampled
  double dt_s;             ///< since this sensor's last sample; 0 at the first
  Pose X_WS;               ///< the sensor frame, as mounted
  Vector3d v_WS_W;         ///< velocity of its origin
};

/// One physics step, for sensors that observe continuously (spinning lidar, rolling shutter).
struct SweepContext {
  const World& world;      ///< as it stands at the end of the step
  const Vehicle& vehicle;  ///< the vehicle that carries the sensor
  Time from;               ///< start of the step that just ended
  Time now;                ///< its end
  Pose X_WS_from;          ///< the sensor frame at `from`
  Pose X_WS;               ///< the sensor frame at `now`
  Time next_sample;        ///< when measure() is called next; now or later

  /// Between the ends of the step.
  Pose X_WS_at(Time at) const;
};

/// The model of a sensor: reads physics, knows no message.
///
/// A model whose measure(), disturb() and sweep() touch nothing but itself and the scene says `static constexpr bool
/// casts_rays = true`: those are then called from several threads, for different devices at once, and so is its
/// reporter.  A model that has sweep() says `static constexpr bool sweeps = true`.
class Sensor {
 public:
  virtual ~Sensor() = default;
  /// Measures without error: the truth becomes the reading.  Called at every sample.
  virtual void measure(const SenseContext& context) = 0;
  /// Called after each step, before measure() when that is due; the world is in its state at the end of the step.
  virtual void sweep(const SweepContext& /*context*/) {}
  /// Turns the truth into a measurement, in place: noise, quantisation.  Called once after every measure().
  virtual void disturb(double dt_s, Random& random) = 0;
  /// About how many rays a sample takes: whether it is worth sharing the work among threads.
  virtual std::int64_t rays() const { return 0; }
  /// It looks for the bottom though it does not cast rays as the scanners do: a world without one is worth a warning.
  virtual bool needs_bottom() const { return false; }
  /// Something sent to this device at a simulated time arrives, see DeviceHost::schedule_arrival.
  virtual void arrive(Time /*at*/, std::span<const std::byte> /*payload*/) {}
  /// The reading and everything that outlasts a sample.
  virtual void visit_state(StateArchive& archive) = 0;
};

/// Takes the messages a reporter makes.  The channel is the framework's business.
class Publisher {
 public:
  virtual ~Publisher() = default;
  /// Publishes an encoded message.
  virtual void publish(std::span<const std::byte> payload) = 0;
  /// The time stamp of messages: the run's epoch plus the time by the clock of the vehicle, in microseconds; true time
  /// on a truth channel.
  std::int64_t utime(Time at) const;
  /// Of what another clock stamped, such as a message by its sender: that clock's `reading`; true time on a truth
  /// channel.
  std::int64_t utime_elsewhere(Time at, Time reading) const {
    return epoch_us_ + (clock_ ? reading.count() : at.count());
  }
  /// By true time, as satellites tell it.
  std::int64_t true_utime(Time at) const { return epoch_us_ + at.count(); }
  /// It is the truth that is being reported.
  bool is_truth() const { return clock_ == nullptr; }
  /// Space to encode into, reused from message to message.
  Bytes& buffer() { return buffer_; }

 protected:
  /// `clock` must outlive the publisher; null: for truth.
  explicit Publisher(std::int64_t epoch_us, const VehicleClock* clock) : epoch_us_(epoch_us), clock_(clock) {}

 private:
  std::int64_t epoch_us_;
  const VehicleClock* clock_;
  Bytes buffer_;
};

/// Turns a sensor's reading into messages.
class Reporter {
 public:
  virtual ~Reporter() = default;
  /// Publishes the reading that was sampled at `sampled_at`.
  virtual void report(Time sampled_at, Publisher& out) const = 0;
};

/// What an actuator works with in a step.
struct ActContext {
  Time now;              ///< at the start of the step
  double step_s;         ///< length of the step
  double effectiveness;  ///< the share of its effort it can give: 1 sound, 0 dead or without power
};

/// What an actuator does without valid commands: at an emergency stop, when commands time out, when the power fails.
enum class SafeState {
  stop,   ///< the command that stands for rest: no speed, no thrust, rudder amidships
  coast,  ///< no effort at all
  hold,   ///< the position of this moment is kept
  park,   ///< it goes to its parking position, see the device
};

/// The model of an actuator: acts on physics, knows no message.
class Actuator : public VisitedInSteps {
 public:
  virtual ~Actuator() = default;
  /// Called before each physics step.
  virtual void act(const ActContext& context) = 0;
  /// Replaces the command until the next one arrives.
  virtual void make_safe(SafeState safe) = 0;
  /// Power that it currently draws from the battery, in addition to the device's `power_W`.
  virtual double power_W() const { return 0; }
  /// Everything that outlasts a step, as Sensor::visit_state.
  virtual void visit_state(StateArchive& archive) = 0;
};

/// Takes messages and sets the actuator.
class Controller {
 public:
  virtual ~Controller() = default;
  /// `payload` is unchecked bytes.  An invalid one throws std::runtime_error with the reason, and changes nothing.
  virtual void receive(Time now, std::span<const std::byte> payload) = 0;
};

}  // namespace sim
