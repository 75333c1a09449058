// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/bus/bus.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/device/fault.hpp"
#include "sim/event/event_queue.hpp"
#include "sim/vehicle/device_host.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

struct VehicleSystems;

/// Data that a step needs to run an actuator, stored apart from its device.
struct Acting : VisitedInSteps {
  Actuator* actuator = nullptr;
  VehicleSystems* systems = nullptr;
  Time watchdog{0};          ///< 0: none
  Time last_command{-1};     ///< time of the last valid command; -1: none yet
  double effectiveness = 1;  ///< share of the effort that faults leave
  SafeState safe_state = SafeState::stop;
  bool is_actuator = false;  ///< has safe states
  bool always_on = false;
  bool stuck = false;
  bool silent = false;
  bool safe = false;  ///< the actuator is in its safe state, without a command since

  void act(Time now, double step_s);
  /// Prepares a command of another device of the vehicle.  Returns whether the actuator takes commands now: it is
  /// powered and without a fault, and the emergency stop is released.
  bool take_command(Time now);
};

/// Device in its vehicle, with the framework functions of every device: schedule of samples, latency, jitter, dropout,
/// truth channel, mailbox, faults, watchdog, power and emergency stop.
class MountedDevice {
 public:
  /// Kinds of its events: Event::kind.
  enum EventKind { report_event, command_event, arrival_event };

  /// `config` must outlive the device (the vehicle keeps it).
  MountedDevice(Vehicle& vehicle, const DeviceConfig& config, DeviceHost& host, int number);
  ~MountedDevice();
  MountedDevice(const MountedDevice&) = delete;
  MountedDevice& operator=(const MountedDevice&) = delete;

  /// Passes the messages that have arrived to the controller; with a latency they become events.
  void take_messages(Time now, std::int64_t step_number);
  /// Returns the number of the step after which it samples next.
  std::int64_t next_sample_step() const { return next_sample_step_; }
  /// Calls Sensor::sweep; called after each step for a sensor that sweeps.
  void sweep(Time now);
  /// Samples; reports are published by publish_reports().  May be called concurrently for sensors that cast rays.
  void sample(Time now, std::int64_t step_number);
  /// Publishes or schedules the reports of sample().
  void publish_reports();
  /// Handles an event of this device that is due.
  void handle(const Event& event);

  /// Sets a fault from now on; replaces a fault of the same kind (and quantity).
  void set_fault(const FaultConfig& fault);
  void clear_faults();
  const DeviceFaults& faults() const { return faults_; }
  /// Applies the values of `changed` that may change at run time: rate, latency, jitter, dropout, power, watchdog, and
  /// the keys of the type when it allows that (see can_change).  Name, mounting and channels are kept.  Throws
  /// std::runtime_error when the values do not fit the vehicle; nothing has changed then.
  void change(const DeviceConfig& changed, Time now);
  /// Returns whether the keys of its type can change at run time.
  bool can_change() const { return static_cast<bool>(built_.change); }

  bool senses() const { return built_.sensor != nullptr; }
  bool sweeps() const { return type_.sweeps; }
  bool casts_rays() const { return type_.casts_rays; }
  std::int64_t rays() const { return built_.sensor->rays(); }
  /// Returns the data of its actuator; their `actuator` is null when it has none.
  Acting* acting() const { return acting_.get(); }
  /// Returns its mailbox; null when it receives no messages.
  Mailbox* mailbox() const { return mailbox_.get(); }
  int number() const { return number_; }
  const std::string& full_name() const { return full_name_; }
  const std::string& report_channel() const { return report_channel_; }
  const std::string& command_channel() const { return command_channel_; }
  const DeviceConfig& config() const { return config_; }
  const Vehicle& vehicle() const { return vehicle_; }
  /// For tests and tools.
  const Sensor* sensor() const { return built_.sensor.get(); }
  const Actuator* actuator() const { return built_.actuator.get(); }
  void visit_state(StateArchive& archive);

 private:
  class Outlet;

  void receive(Time now, std::span<const std::byte> payload);
  void report(Time now);
  bool works() const;
  Time next_latency();
  void plan_schedule();
  void plan_again(Time now);
  void plan_next_sample();
  std::int64_t step_of_sample(std::int64_t sample) const;
  void check_schedule(const StateArchive& archive) const;

  DeviceConfig config_;
  const DeviceType& type_;
  DeviceHost& host_;
  Bus& bus_;
  Vehicle& vehicle_;
  const Body& body_;
  int number_;
  std::string full_name_;
  std::string report_channel_, truth_channel_, command_channel_;
  Pose X_BS_;
  DeviceFaults faults_;
  BuiltDevice built_;
  std::unique_ptr<Acting> acting_ = std::make_unique<Acting>();
  std::unique_ptr<Mailbox> mailbox_;
  std::unique_ptr<Outlet> report_outlet_, truth_outlet_;
  Random noise_random_, link_random_;
  double period_us_ = 0;
  double phase_us_ = 0;
  std::int64_t samples_planned_ = 0;
  std::int64_t next_sample_step_ = 0;
  Time last_sample_{-1};
  std::optional<Pose> X_WS_before_;  ///< pose at the end of the last step, for sweep()
  /// Messages that a stuck sensor repeats, and their time stamp.
  std::optional<std::vector<Bytes>> frozen_;
  std::int64_t frozen_utime_ = 0;
};

}  // namespace sim
