// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
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
class MountedDevice : public VisitedInSteps {
 public:
  /// Kinds of its events: Event::kind.
  enum EventKind { report_event, command_event, arrival_event };

  /// `config` must outlive the device (the vehicle keeps it).
  MountedDevice(Vehicle& vehicle, const DeviceConfig& config, DeviceHost& host, int number);
  ~MountedDevice();
  MountedDevice(const MountedDevice&) = delete;
  MountedDevice& operator=(const MountedDevice&) = delete;

  /// Passes the messages that have arrived to the controller; with a latency they become events.  `bad`: gets the
  /// errors of bad messages, for report_bad_messages(); null: they are reported at once.
  void take_messages(Time now, std::int64_t step_number, std::vector<std::string>* bad = nullptr);
  void report_bad_messages(const std::vector<std::string>& bad);
  /// Returns whether take_messages() may be called for several devices concurrently, with `bad`.
  bool takes_messages_alone() const;
  /// Returns the number of the step after which it samples next.
  std::int64_t next_sample_step() const { return next_sample_step_; }
  /// Calls Sensor::sweep; called after each step for a sensor that sweeps.
  void sweep(Time now);
  /// Samples, and publishes or schedules the reports, unless they are held until publish_reports(); then it may be
  /// called concurrently for sensors that cast rays or measure alone.
  void sample(Time now, std::int64_t step_number, bool hold);
  /// Called after its vehicle was put elsewhere.
  void displaced();
  /// Publishes or schedules the reports that sample() held.
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

  bool senses() const { return sensor_ != nullptr; }
  bool every_step() const { return period_us_ == 0; }
  /// Returns whether it samples in every step in which it is awake.
  bool sleeps() const { return type_.sleeps && every_step(); }
  bool sweeps() const { return type_.sweeps; }
  bool casts_rays() const { return type_.casts_rays; }
  std::int64_t rays() const { return sensor_->rays(); }
  bool measures_alone() const { return type_.measures_alone; }
  bool acts_alone() const { return type_.acts_alone; }
  /// Returns the flag that is false while it sleeps; null for a type that never does.
  std::atomic<bool>* awake() const { return type_.sleeps ? awake_.get() : nullptr; }
  /// Returns the data of its actuator; their `actuator` is null when it has none.
  Acting* acting() const { return acting_.get(); }
  /// Returns the mailbox of its commands; null if it receives no messages.
  Mailbox* mailbox() const { return mailbox_.get(); }
  int number() const { return number_; }
  const std::string& full_name() const { return full_name_; }
  const std::string& report_channel() const { return report_channel_; }
  const std::string& command_channel() const { return command_channel_; }
  const DeviceConfig& config() const { return *config_; }
  /// What all its readings lacked, and the time from the first to the last; std::nullopt when some lacked nothing
  /// or none was taken.  See Sensor::lacks().
  struct Lack {
    std::string_view what;
    Time span;
  };
  std::optional<Lack> lack() const;
  const Vehicle& vehicle() const { return vehicle_; }
  /// Used by tests and tools.
  const Sensor* sensor() const { return sensor_; }
  const Actuator* actuator() const { return built_.actuator.get(); }
  void visit_state(StateArchive& archive);

 private:
  class Outlet;

  void take_config();
  void wake() { awake_->store(true, std::memory_order_relaxed); }
  void receive(Time now, std::span<const std::byte> payload, std::vector<std::string>* bad = nullptr);
  void report(Time now);
  bool works() const;
  Time next_latency();
  void plan_schedule();
  void plan_again(Time now);
  void plan_next_sample();
  std::int64_t step_of_sample(std::int64_t sample) const;
  void check_schedule(const StateArchive& archive) const;

  // Members used by each sample, adjacent in memory.
  const Body& body_;
  Vehicle& vehicle_;
  Sensor* sensor_ = nullptr;      // of built_
  Reporter* reporter_ = nullptr;  // of built_; may be null
  std::unique_ptr<Outlet> report_outlet_, truth_outlet_;
  double period_us_ = 0;  // 0: every step
  double phase_us_ = 0;
  std::int64_t samples_planned_ = 0;
  std::int64_t next_sample_step_ = 0;
  Time last_sample_{-1};
  Time lacking_since_{-1};  ///< its first sample, while all lacked something; -1: none was taken
  bool complete_ = false;   ///< one lacked nothing
  double latency_s_ = 0, jitter_s_ = 0, dropout_ = 0;  // of config_
  bool truth_ = false;
  Pose X_BS_;
  DeviceHost& host_;
  DeviceFaults faults_;
  const std::string full_name_;
  Random noise_random_, link_random_;

  const int number_;
  const DeviceType& type_;
  Bus& bus_;
  const DeviceConfig* config_;             // of the vehicle, or changed_
  std::unique_ptr<DeviceConfig> changed_;  // at run time; null: not changed
  const std::string report_channel_, command_channel_;
  const std::shared_ptr<std::atomic<bool>> awake_;
  std::unique_ptr<Acting> acting_ = std::make_unique<Acting>();
  BuiltDevice built_;
  std::unique_ptr<Mailbox> mailbox_;
  std::optional<Pose> X_WS_before_;  ///< pose at the end of the last step, for sweep()
  /// Messages that a stuck sensor repeats, and their time stamp.
  std::optional<std::vector<Bytes>> frozen_;
  std::int64_t frozen_utime_ = 0;
};

}  // namespace sim
