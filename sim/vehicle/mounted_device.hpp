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

/// The data that a step needs to run an actuator, separate from the rest of its device.
struct Acting : VisitedInSteps {
  Actuator* actuator = nullptr;
  VehicleSystems* systems = nullptr;
  Time watchdog{0};          ///< 0: none
  Time last_command{-1};     ///< the last one that was good; -1: none yet
  double effectiveness = 1;  ///< by faults
  SafeState safe_state = SafeState::stop;
  bool is_actuator = false;  ///< has safe states
  bool always_on = false;
  bool stuck = false;
  bool safe = false;  ///< the actuator was made safe, and no command came since

  void act(Time now, double step_s);
};

/// A device in its vehicle, with what the framework puts around every device: the schedule of samples, latency,
/// jitter, dropout, the truth channel, the mailbox, faults, the watchdog, power and emergency stop.
class MountedDevice {
 public:
  /// What its events are about: Event::kind.
  enum EventKind { report_event, command_event, arrival_event };

  /// `config` must outlive the device (the vehicle keeps it).
  MountedDevice(Vehicle& vehicle, const DeviceConfig& config, DeviceHost& host, int number);
  ~MountedDevice();
  MountedDevice(const MountedDevice&) = delete;
  MountedDevice& operator=(const MountedDevice&) = delete;

  /// Hands the controller the messages that have come; with a latency they become events.
  void take_messages(Time now, std::int64_t step_number);
  /// Of the step after which it samples next.
  std::int64_t next_sample_step() const { return next_sample_step_; }
  /// See Sensor::sweep; called after each step of a sensor that sweeps.
  void sweep(Time now);
  /// Samples; the reports wait for publish().  Sensors that cast rays may do so at the same time in several threads.
  void sample(Time now, std::int64_t step_number);
  /// Publishes or schedules what sample() found.
  void publish_reports();
  /// An event of this device is due.
  void handle(const Event& event);

  /// From now on; a fault of the same kind (and quantity) is replaced.
  void set_fault(const FaultConfig& fault);
  void clear_faults();
  const DeviceFaults& faults() const { return faults_; }
  /// Takes the values of `changed` that may change while it runs: rate, latency, jitter, dropout, power, watchdog, and
  /// the type's own keys when the type allows it (see can_change).  Name, mounting and channels stay.
  void change(const DeviceConfig& changed, Time now);
  /// Its own keys can change while it runs.
  bool can_change() const { return static_cast<bool>(built_.change); }

  bool senses() const { return built_.sensor != nullptr; }
  bool sweeps() const { return type_.sweeps; }
  bool casts_rays() const { return type_.casts_rays; }
  std::int64_t rays() const { return built_.sensor->rays(); }
  /// Its actuator is null when it has none.
  Acting* acting() const { return acting_.get(); }
  /// Null when it takes no messages.
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
  std::optional<Pose> X_WS_before_;  ///< at the end of the last step, for sweep()
  /// What a stuck sensor repeats, and the time stamp in it.
  std::optional<std::vector<Bytes>> frozen_;
  std::int64_t frozen_utime_ = 0;
};

}  // namespace sim
