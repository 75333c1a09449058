#pragma once

#include <memory>
#include <string>

#include "sim/bus/bus.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/world/event_queue.hpp"
#include "sim/world/world_config.hpp"

namespace sim {

/// A message that a device could not use.
struct BadMessage {
  std::string channel;
  std::string text;
};

/// What the mounted devices of a world have in common.
struct DeviceHost {
  Bus& bus;
  EventQueue& events;
  std::int64_t epoch_us;
  Time step;
  std::uint64_t seed;
  std::function<void(BadMessage)> complain;
};

/// A device in its vehicle, with what the framework puts around every device: the schedule of samples, latency,
/// jitter, dropout, the truth channel, the mailbox.
class MountedDevice {
 public:
  MountedDevice(const DeviceContext& context, const WorldConfig& world_config, DeviceHost& host, int number);
  ~MountedDevice();
  MountedDevice(const MountedDevice&) = delete;
  MountedDevice& operator=(const MountedDevice&) = delete;

  /// Hands the controller the messages that have come; with a latency they become events.
  void take_mail(Time now, std::int64_t step_number);
  void act(Time now, double step_s) {
    if (built_.actuator) built_.actuator->act(now, step_s);
  }
  bool sample_is_due(std::int64_t step_number) const { return step_number >= next_sample_step_; }
  /// Samples, and publishes or schedules the report.
  void sample(const World& world, Time now, std::int64_t step_number);
  /// An event of this device is due.
  void handle(const Event& event);

  bool senses() const { return built_.sensor != nullptr; }
  bool acts() const { return built_.actuator != nullptr; }
  bool has_mailbox() const { return mailbox_ != nullptr; }
  const std::string& full_name() const { return full_name_; }
  const std::string& report_channel() const { return report_channel_; }
  const std::string& command_channel() const { return command_channel_; }
  const DeviceConfig& config() const { return config_; }
  const Vehicle& vehicle() const { return vehicle_; }
  /// For tests and tools.
  const Sensor* sensor() const { return built_.sensor.get(); }
  void hash_state(StateHash& hash) const;

 private:
  enum EventKind { report_event, truth_event, command_event, arrival_event };
  class Outlet;
  friend class World;

  void receive(Time now, std::span<const std::byte> payload);
  Time next_latency();
  void plan_next_sample();

  const DeviceConfig& config_;
  DeviceHost& host_;
  const Vehicle& vehicle_;
  const Body& body_;
  int number_;
  std::string full_name_;
  std::string report_channel_, truth_channel_, command_channel_;
  Pose X_BS_;
  BuiltDevice built_;
  std::unique_ptr<Mailbox> mailbox_;
  std::unique_ptr<Outlet> report_outlet_, truth_outlet_;
  Random noise_random_, link_random_;
  double period_us_ = 0;
  double phase_us_ = 0;
  std::int64_t samples_planned_ = 0;
  std::int64_t next_sample_step_ = 1;
  Time last_sample_{-1};
};

}  // namespace sim
