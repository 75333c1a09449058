// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/base/state_hash.hpp"
#include "sim/base/step_memory.hpp"
#include "sim/base/time.hpp"
#include "sim/bus/bus.hpp"
#include "sim/device/field_of_view.hpp"
#include "sim/random/random.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

class Body;
class Vehicle;
class VehicleClock;
class World;

/// Inputs of a sensor at a sample.
struct SenseContext {
  const World& world;      ///< state at `now`
  const Vehicle& vehicle;  ///< the vehicle that carries the sensor
  Time now;                ///< sample time
  double dt_s;             ///< time since the last sample of this sensor; 0 at the first
  Pose X_WS;               ///< pose of the sensor frame S in the world frame W
  Vector3d v_WS_W;         ///< velocity of the origin of S, in W
};

/// One physics step, for sensors that observe continuously (spinning lidar, rolling shutter).
struct SweepContext {
  const World& world;      ///< state at the end of the step
  const Vehicle& vehicle;  ///< the vehicle that carries the sensor
  Time from;               ///< start of the step that just ended
  Time now;                ///< end of the step
  Pose X_WS_from;          ///< pose of the sensor frame at `from`
  Pose X_WS;               ///< pose of the sensor frame at `now`
  Time next_sample;        ///< time of the next measure(); now or later

  /// Returns the pose of the sensor frame at a time in the step, by interpolation.
  Pose X_WS_at(Time at) const;
};

/// Place to which the configuration of a device sends its vehicle.
struct PlannedPlace {
  const char* key;      ///< that gives it, such as `waypoints`
  Eigen::Vector2d p_W;  ///< m
  double depth_m;       ///< below the still surface
};

/// Model of a sensor: reads the physics, and does not depend on message types.
/// A model whose measure(), disturb() and sweep() access only the model itself and the scene declares `static constexpr
/// bool casts_rays = true`: these functions and its reporter are then called from several threads, for different
/// devices concurrently.  A model that has sweep() declares `static constexpr bool sweeps = true`.
///
/// A model without rays whose measure() and disturb() change only the model itself, and read only its vehicle and the
/// world, declares `static constexpr bool measures_alone = true`: the same holds for them.  They may publish on
/// channels of their vehicle's bus, in the order of the devices.
class Sensor {
 public:
  virtual ~Sensor() = default;
  /// Measures without error: sets the reading to the true values.  Called at every sample.
  virtual void measure(const SenseContext& context) = 0;
  /// Observes one physics step.  Called after each step, before measure() when a sample is due; the world is in its
  /// state at the end of the step.
  virtual void sweep(const SweepContext& /*context*/) {}
  /// Called after its vehicle was put elsewhere: a rate or a path from a place before to one after is none.
  virtual void displaced() {}
  /// Adds the measurement errors to the reading in place: noise, quantization.  Called once after every measure().
  virtual void disturb(double dt_s, Random& random) = 0;
  /// Returns the approximate number of rays of a sample, which decides whether the work is shared among threads.
  virtual std::int64_t rays() const { return 0; }
  /// Returns the region that the sensor observes, for viewers; none: it has none.
  virtual std::optional<FieldOfView> field_of_view() const { return std::nullopt; }
  /// Returns the pose in the world of the frame in which it reports the pose of its vehicle; none: it reports none, or
  /// in the world.
  virtual std::optional<Pose> origin() const { return std::nullopt; }
  /// Data rate of an acoustic modem within its packets, bit/s; none for other devices, and when it varies.
  virtual std::optional<double> data_rate_bps() const { return std::nullopt; }
  /// Returns whether the sensor detects the bottom without casting rays as scanners do: a world without a bottom then
  /// causes a warning.
  virtual bool needs_bottom() const { return false; }
  /// Returns what the present reading lacks, such as `bottom lock`; empty: nothing.  A sensor that has lacked it from
  /// its first sample on causes a warning at the end of the run; with an ending ` under water`, where that is usual,
  /// only when a program waits for the sensor.
  virtual std::string_view lacks() const { return {}; }
  /// Returns the places to which it brings its vehicle by itself, with their depths: those below the bottom or in the
  /// air cause a warning.
  virtual std::vector<PlannedPlace> planned_places() const { return {}; }
  /// Receives data scheduled for this device at a simulated time, see DeviceHost::schedule_arrival.
  virtual void arrive(Time /*at*/, std::span<const std::byte> /*payload*/) {}
  /// Visits the reading and all state that is kept between samples.
  virtual void visit_state(StateArchive& archive) = 0;
};

/// Publishes the messages of a reporter on the channel that the framework has chosen.
class Publisher {
 public:
  virtual ~Publisher() = default;
  /// Publishes an encoded message.
  virtual void publish(std::span<const std::byte> payload) = 0;
  /// Returns the time stamp of a message: the epoch of the run plus the time of the vehicle clock, in microseconds;
  /// true time on a truth channel.
  std::int64_t utime(Time at) const;
  /// Returns the time stamp of data stamped by another clock, such as a message stamped by its sender: the `reading` of
  /// that clock; true time on a truth channel.
  std::int64_t utime_elsewhere(Time at, Time reading) const {
    return epoch_us_ + (clock_ ? reading.count() : at.count());
  }
  /// Returns the time stamp in true time, as received from GNSS.
  std::int64_t true_utime(Time at) const { return epoch_us_ + at.count(); }
  /// Returns whether this is a truth channel.
  bool is_truth() const { return clock_ == nullptr; }
  /// Returns the encoding buffer, reused by all messages of this thread.
  static Bytes& buffer();

 protected:
  /// `clock` must outlive the publisher; null: truth channel.
  explicit Publisher(std::int64_t epoch_us, const VehicleClock* clock) : epoch_us_(epoch_us), clock_(clock) {}

 private:
  std::int64_t epoch_us_;
  const VehicleClock* clock_;
};

/// Converts the reading of a sensor to messages.
class Reporter {
 public:
  virtual ~Reporter() = default;
  /// Publishes the reading that was sampled at `sampled_at`.
  virtual void report(Time sampled_at, Publisher& out) const = 0;
};

/// Inputs of an actuator in a step.
struct ActContext {
  Time now;              ///< at the start of the step
  double step_s;         ///< length of the step
  double effectiveness;  ///< available share of the effort: 1 healthy, 0 failed or without power
};

/// Behavior of an actuator without valid commands: at an emergency stop, after a command timeout, after a power
/// failure.
enum class SafeState {
  stop,   ///< neutral command: no speed, no thrust, rudder amidships
  coast,  ///< no effort
  hold,   ///< holds the present position
  park,   ///< moves to the parking position, see the device
};

/// Model of an actuator: acts on the physics, and does not depend on message types.
///
/// A model whose act(), make_safe() and power_W() change only the model itself and the bodies, joints and systems of
/// its vehicle, and read only these and the world, declares `static constexpr bool acts_alone = true`: they are then
/// called from several threads, for different vehicles concurrently.  So is the receive() of its controller, which
/// changes the model only.
///
/// A model that is also a sensor and has `bool idle() const` sleeps: while idle() is true nothing is to do, and neither
/// act() nor, if it samples in every step, measure() is called until it is woken (DeviceContext::wake_flag).
class Actuator : public VisitedInSteps {
 public:
  virtual ~Actuator() = default;
  /// Applies the effort of a step.  Called before each physics step.
  virtual void act(const ActContext& context) = 0;
  /// Replaces the command until the next one arrives.
  virtual void make_safe(SafeState safe) = 0;
  /// Returns the power currently drawn from the battery, in addition to `power_W` of the device.
  virtual double power_W() const { return 0; }
  /// Returns whether a model that sleeps has nothing to do, see above.
  virtual bool idle() const { return false; }
  /// Visits all state that is kept between steps, as Sensor::visit_state.
  virtual void visit_state(StateArchive& archive) = 0;
};

/// Decodes command messages and commands the actuator.
class Controller {
 public:
  virtual ~Controller() = default;
  /// Executes a command.  `payload`: unchecked bytes.  Throws std::runtime_error with the reason when they are invalid;
  /// nothing has then changed.
  virtual void receive(Time now, std::span<const std::byte> payload) = 0;
};

/// Sensor that has no effect until something uses it, such as lights that were never switched.  Until then it publishes
/// nothing, and is not part of hashes: a vehicle that gets such a device keeps the run hashes of its worlds.  Snapshots
/// have it always.
class UnhashedUntilUsed {
 public:
  virtual ~UnhashedUntilUsed() = default;
  /// Returns whether it was used since the start of the run.
  virtual bool used() const = 0;
};

/// Returns whether the device of a sensor is not part of hashes.  `sensor`: null for a device that has none.
inline bool is_unused(const Sensor* sensor) {
  const auto* const quiet = dynamic_cast<const UnhashedUntilUsed*>(sensor);
  return quiet != nullptr && !quiet->used();
}

}  // namespace sim
