#include "sim/world/mounted_device.hpp"

#include <algorithm>
#include <cmath>

#include "sim/world/vehicle.hpp"
#include "sim/world/world.hpp"

namespace sim {

/// Publishes at once, or at a later simulated time by way of an event.
class MountedDevice::Outlet final : public Publisher {
 public:
  Outlet(MountedDevice& device, EventKind kind, const std::string& channel)
      : Publisher(device.host_.epoch_us), device_(device), kind_(kind), channel_(channel) {}

  void set(Time now, Time latency) {
    now_ = now;
    latency_ = latency;
  }

  void publish(std::span<const std::byte> payload) override {
    if (latency_.count() == 0) {
      device_.host_.bus.publish(channel_, payload, now_);
      return;
    }
    Event event;
    event.due = now_ + latency_;
    event.device = device_.number_;
    event.kind = kind_;
    event.stamp = now_;
    event.payload.assign(payload.begin(), payload.end());
    device_.host_.events.schedule(std::move(event));
  }

 private:
  MountedDevice& device_;
  EventKind kind_;
  const std::string& channel_;
  Time now_{0};
  Time latency_{0};
};

MountedDevice::MountedDevice(const DeviceContext& context, const WorldConfig& world_config, DeviceHost& host,
                             int number)
    : config_(context.config),
      host_(host),
      vehicle_(context.vehicle),
      body_(context.body),
      number_(number),
      full_name_(context.full_name()),
      report_channel_(channel_name(config_.channel.empty() ? world_config.channels.report : config_.channel,
                                   vehicle_.name(), config_.name)),
      truth_channel_(channel_name(world_config.channels.truth, vehicle_.name(), config_.name)),
      command_channel_(channel_name(world_config.channels.command, vehicle_.name(), config_.name)),
      X_BS_(config_.X_BS()),
      built_(config_.device_type->build(*config_.params, context)),
      noise_random_(host.seed, full_name_),
      link_random_(host.seed, full_name_ + "#link") {
  if (built_.controller) mailbox_ = host.bus.open_mailbox(command_channel_, Bus::default_mailbox_capacity);
  report_outlet_ = std::make_unique<Outlet>(*this, report_event, report_channel_);
  truth_outlet_ = std::make_unique<Outlet>(*this, truth_event, truth_channel_);
  if (config_.rate_hz > 0) {
    period_us_ = 1e6 / config_.rate_hz;
    // The top 32 bits of the name's hash as a fraction of the period.
    const double fraction = static_cast<double>(hash_text(full_name_) >> 32) / 4294967296.0;
    phase_us_ = config_.phase_s ? *config_.phase_s * 1e6 : fraction * period_us_;
  }
  plan_next_sample();
}

MountedDevice::~MountedDevice() = default;

void MountedDevice::plan_next_sample() {
  if (config_.rate_hz <= 0) {
    next_sample_step_ = samples_planned_ == 0 ? 1 : next_sample_step_ + 1;
    ++samples_planned_;
    return;
  }
  // Sample k is due at phase + k * period, so that a rate which does not divide the step is right on average.  Two
  // samples never share a step, and none is before the first step.
  const std::int64_t earliest = samples_planned_ == 0 ? 1 : next_sample_step_ + 1;
  const auto step_us = static_cast<double>(host_.step.count());
  const auto step_of = [&](std::int64_t sample) {
    const double due_us = phase_us_ + static_cast<double>(sample) * period_us_;
    return static_cast<std::int64_t>(std::ceil(due_us / step_us - 1e-9));
  };
  // Where many samples fall into one step, all but one are skipped at once.
  const double skip = (static_cast<double>(earliest - 1) * step_us - phase_us_) / period_us_;
  std::int64_t sample = std::max(samples_planned_, static_cast<std::int64_t>(std::floor(skip)));
  while (step_of(sample) < earliest) ++sample;
  samples_planned_ = sample + 1;
  next_sample_step_ = step_of(sample);
}

Time MountedDevice::next_latency() {
  double latency_s = config_.latency_s;
  if (config_.jitter_s > 0) latency_s += link_random_.uniform() * config_.jitter_s;
  return from_seconds(latency_s);
}

void MountedDevice::take_mail(Time now, std::int64_t step_number) {
  bool first = true;
  while (const std::optional<Message> message = mailbox_->take()) {
    if (first) link_random_.begin_step(step_number);
    first = false;
    if (config_.dropout > 0 && link_random_.uniform() < config_.dropout) continue;
    const Time latency = next_latency();
    // A sensor's latency delays its reports, not what it is told (a modem is both).
    if (latency.count() == 0 || built_.sensor) {
      receive(now, message->payload);
      continue;
    }
    host_.events.schedule({now + latency, 0, number_, command_event, now, message->payload});
  }
}

void MountedDevice::receive(Time now, std::span<const std::byte> payload) {
  try {
    built_.controller->receive(now, payload);
  } catch (const std::runtime_error& error) {
    host_.complain({command_channel_, error.what()});
  }
}

void MountedDevice::sample(const World& world, Time now, std::int64_t step_number) {
  const double dt_s = last_sample_.count() < 0 ? 0.0 : to_seconds(now - last_sample_);
  last_sample_ = now;
  const Pose X_WB = body_.X_WB();
  const SenseContext context{world, vehicle_, now, dt_s, X_WB * X_BS_, body_.velocity_at_W(X_BS_.translation())};
  plan_next_sample();
  built_.sensor->measure(context);
  if (config_.truth) {
    truth_outlet_->set(now, Time{0});
    built_.reporter->report(now, *truth_outlet_);
  }
  noise_random_.begin_step(step_number);
  built_.sensor->disturb(dt_s, noise_random_);
  link_random_.begin_step(-step_number);  // apart from the draws of take_mail in the same step
  if (config_.dropout > 0 && link_random_.uniform() < config_.dropout) return;
  report_outlet_->set(now, next_latency());
  built_.reporter->report(now, *report_outlet_);
}

void MountedDevice::handle(const Event& event) {
  switch (event.kind) {
    case report_event:
      host_.bus.publish(report_channel_, event.payload, event.due);
      break;
    case command_event:
      receive(event.due, event.payload);
      break;
    case arrival_event:
      built_.sensor->arrive(event.due, event.payload);
      break;
    default:
      break;
  }
}

void MountedDevice::hash_state(StateHash& hash) const {
  hash.add(samples_planned_);
  hash.add(next_sample_step_);
  hash.add(static_cast<std::int64_t>(last_sample_.count()));
  if (built_.sensor) built_.sensor->hash_state(hash);
  if (built_.actuator) built_.actuator->hash_state(hash);
}

}  // namespace sim
