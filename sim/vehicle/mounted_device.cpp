// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/mounted_device.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/bus/utime_stamp.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/vehicle/run_hash.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace sim {

/// Publisher that holds the reports of a sensor until the world publishes them: immediately, or at a later simulated
/// time by an event.
class MountedDevice::Outlet final : public Publisher {
 public:
  Outlet(MountedDevice& device, Bus& bus, const std::string& channel, const VehicleClock* clock)
      : Publisher(device.host_.epoch_us, clock), device_(device), bus_(bus), channel_(channel) {}

  void set(Time now, Time latency) {
    now_ = now;
    latency_ = latency;
  }

  /// Also stores messages published from now on in `copies`; null: stops.
  void copy_to(std::vector<Bytes>* copies) { copies_ = copies; }

  void publish(std::span<const std::byte> payload) override {
    if (copies_) copies_->emplace_back(payload.begin(), payload.end());
    // Keep payloads to reuse their memory: those of cameras are large.
    if (waiting_ == payloads_.size()) payloads_.emplace_back();
    payloads_[waiting_++].assign(payload.begin(), payload.end());
  }

  void flush() {
    for (std::size_t i = 0; i < waiting_; ++i) {
      if (latency_.count() == 0) {
        bus_.publish(channel_, payloads_[i], now_);
        continue;
      }
      Event event;
      event.due = now_ + latency_;
      event.device = device_.number_;
      event.kind = report_event;
      event.stamp = now_;
      event.payload = payloads_[i];
      device_.host_.events.schedule(std::move(event));
    }
    waiting_ = 0;
  }

 private:
  MountedDevice& device_;
  Bus& bus_;
  const std::string& channel_;
  Time now_{0};
  Time latency_{0};
  std::vector<Bytes> payloads_;
  std::size_t waiting_ = 0;
  std::vector<Bytes>* copies_ = nullptr;
};

MountedDevice::MountedDevice(Vehicle& vehicle, const DeviceConfig& config, DeviceHost& host, int number)
    : config_(config),
      type_(*config.device_type),
      host_(host),
      bus_(vehicle.bus()),
      vehicle_(vehicle),
      body_(config.body.empty() ? vehicle.base() : vehicle.body(config.body)),
      number_(number),
      full_name_(vehicle.name() + "/" + config.name),
      report_channel_(device_channel(host.channels, vehicle.name(), config, ChannelKind::report)),
      truth_channel_(device_channel(host.channels, vehicle.name(), config, ChannelKind::truth)),
      command_channel_(device_channel(host.channels, vehicle.name(), config, ChannelKind::command)),
      X_BS_(config_.X_BS()),
      built_(type_.build(*config_.params, {host.world, vehicle, config_,
                                           config.body.empty() ? vehicle.body(vehicle.config().bodies.front().name)
                                                               : vehicle.body(config.body),
                                           number, faults_, host})),
      noise_random_(host.seed, full_name_),
      link_random_(host.seed, full_name_ + "#link") {
  if (built_.controller) mailbox_ = bus_.open_mailbox(command_channel_, Bus::default_mailbox_capacity);
  acting_->actuator = built_.actuator.get();
  acting_->systems = &vehicle.systems();
  acting_->watchdog = from_seconds(config_.watchdog_s);
  acting_->safe_state = config_.safe;
  acting_->is_actuator = type_.is_actuator();
  acting_->always_on = type_.always_on;
  report_outlet_ = std::make_unique<Outlet>(*this, bus_, report_channel_, &vehicle.clock());
  // The truth channel is for observation: it does not change the run and its hash.
  truth_outlet_ = std::make_unique<Outlet>(*this, RunHash::uncounted(bus_), truth_channel_, nullptr);
  plan_again(host.clock.now());
}

void MountedDevice::plan_schedule() {
  period_us_ = phase_us_ = 0;
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
  const std::int64_t earliest = next_sample_step_ + 1;
  if (config_.rate_hz <= 0) {
    next_sample_step_ = earliest;
    ++samples_planned_;
    return;
  }
  // Sample k is due at phase + k * period, so that a rate that does not divide the step rate is correct on average. Two
  // samples are never in one step, and the first is at the earliest in the step after the device was added.
  const auto step_us = static_cast<double>(host_.clock.step.count());
  // When many samples fall into one step, skip all but one at once.
  const double skip = (static_cast<double>(earliest - 1) * step_us - phase_us_) / period_us_;
  std::int64_t sample = std::max(samples_planned_, static_cast<std::int64_t>(std::floor(skip)));
  while (step_of_sample(sample) < earliest) ++sample;
  samples_planned_ = sample + 1;
  next_sample_step_ = step_of_sample(sample);
}

/// Returns the first step at or after the due time of a sample.
std::int64_t MountedDevice::step_of_sample(std::int64_t sample) const {
  constexpr double beyond_all_runs_us = 1e18;
  const auto step_us = static_cast<double>(host_.clock.step.count());
  const double due_us = phase_us_ + static_cast<double>(sample) * period_us_;
  return static_cast<std::int64_t>(
      std::ceil(std::clamp(due_us, -beyond_all_runs_us, beyond_all_runs_us) / step_us - 1e-9));
}

/// Checks that the next sample follows from the last one: for other values in a snapshot the device would catch up
/// sample by sample.
void MountedDevice::check_schedule(const StateArchive& archive) const {
  if (!senses()) return;
  archive.require(samples_planned_, 1, std::numeric_limits<std::int64_t>::max() / 2, "a next sample");
  const bool fits = config_.rate_hz > 0 ? next_sample_step_ == step_of_sample(samples_planned_ - 1)
                                        : next_sample_step_ > 0 && next_sample_step_ <= host_.clock.step_number + 1;
  if (!fits) archive.fail("the snapshot has an invalid value: a next sample");
}

Time MountedDevice::next_latency() {
  double latency_s = config_.latency_s;
  if (config_.jitter_s > 0) latency_s += link_random_.uniform() * config_.jitter_s;
  return from_seconds(latency_s);
}

void MountedDevice::take_messages(Time now, std::int64_t step_number) {
  bool first = true;
  while (const std::optional<Message> message = mailbox_->take()) {
    if (first) link_random_.begin_step(step_number);
    first = false;
    if (config_.dropout > 0 && link_random_.uniform() < config_.dropout) continue;
    if (faults_.dropout() > 0 && link_random_.uniform() < faults_.dropout()) continue;
    Time latency = next_latency();
    if (type_.is_actuator()) latency += from_seconds(vehicle_.config().actuator_latency_s);
    // The latency of a sensor delays its reports, not its commands (a modem has both).
    if (latency.count() == 0 || built_.sensor) {
      receive(now, message->payload);
      continue;
    }
    host_.events.schedule({now + latency, 0, number_, command_event, now, message->payload});
  }
}

bool MountedDevice::works() const {
  return type_.always_on || vehicle_.systems().powered;
}

void MountedDevice::receive(Time now, std::span<const std::byte> payload) {
  if (!works() || faults_.silent()) return;
  if (type_.is_actuator() && (vehicle_.systems().estopped || faults_.stuck())) return;
  try {
    built_.controller->receive(now, payload);
    acting_->last_command = now;
    acting_->safe = false;
  } catch (const std::runtime_error& error) {
    host_.warnings.bad_message(command_channel_, error.what());
  }
}

bool Acting::take_command(Time now) {
  if (stuck || silent || systems->estopped || !(always_on || systems->powered)) return false;
  last_command = now;
  safe = false;
  return true;
}

void Acting::act(Time now, double step_s) {
  const bool works = always_on || systems->powered;
  if (is_actuator) {
    const bool stale = watchdog.count() > 0 && last_command.count() >= 0 && !stuck && now - last_command > watchdog;
    if ((stale || systems->estopped || !works) && !safe) {
      actuator->make_safe(safe_state);
      safe = true;
    }
  }
  actuator->act({now, step_s, works ? effectiveness : 0.0});
  if (systems->metered && works) systems->drawn_J += actuator->power_W() * step_s;
}

void MountedDevice::sweep(Time now) {
  const Pose X_WS = body_.X_WB() * X_BS_;
  if (works())
    built_.sensor->sweep({host_.world, vehicle_, now - host_.clock.step, now, X_WS_before_.value_or(X_WS), X_WS,
                          Time{next_sample_step_ * host_.clock.step.count()}});
  X_WS_before_ = X_WS;
}

void MountedDevice::publish_reports() {
  truth_outlet_->flush();
  report_outlet_->flush();
}

void MountedDevice::sample(Time now, std::int64_t step_number) {
  plan_next_sample();
  if (!works()) return;
  const double dt_s = last_sample_.count() < 0 ? 0.0 : to_seconds(now - last_sample_);
  last_sample_ = now;
  // Measure the truth.
  const Pose X_WB = body_.X_WB();
  const SenseContext context{host_.world, vehicle_, now, dt_s, X_WB * X_BS_, body_.velocity_at_W(X_BS_.translation())};
  built_.sensor->measure(context);
  if (!built_.reporter) return;
  // Report it on the truth channel.
  if (config_.truth) {
    truth_outlet_->set(now, Time{0});
    built_.reporter->report(now, *truth_outlet_);
  }
  // Add the errors.
  noise_random_.begin_step(step_number);
  built_.sensor->disturb(dt_s, noise_random_);
  link_random_.begin_step(-step_number);  // independent of the draws of take_messages in the same step
  // Report, unless the message is lost.
  if (config_.dropout > 0 && link_random_.uniform() < config_.dropout) return;
  const Time latency = next_latency();
  if (faults_.silent()) return;
  if (faults_.dropout() > 0 && link_random_.uniform() < faults_.dropout()) return;
  report_outlet_->set(now, latency);
  report(now);
}

void MountedDevice::report(Time now) {
  if (!faults_.stuck()) {
    built_.reporter->report(now, *report_outlet_);
    return;
  }
  if (!frozen_) {  // the first report after the fault is repeated
    frozen_.emplace();
    frozen_utime_ = report_outlet_->utime(now);
    report_outlet_->copy_to(&*frozen_);
    built_.reporter->report(now, *report_outlet_);
    report_outlet_->copy_to(nullptr);
    return;
  }
  // Only the time stamp advances.
  const std::int64_t utime = report_outlet_->utime(now);
  for (Bytes& payload : *frozen_) {
    if (utime_of(payload) == frozen_utime_) set_utime(payload, utime);
    report_outlet_->publish(payload);
  }
  frozen_utime_ = utime;
}

void MountedDevice::handle(const Event& event) {
  switch (event.kind) {
    case report_event:
      bus_.publish(report_channel_, event.payload, event.due);
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

void MountedDevice::set_fault(const FaultConfig& fault) {
  faults_.set(fault);
  acting_->effectiveness = faults_.effectiveness();
  acting_->stuck = faults_.stuck();
  acting_->silent = faults_.silent();
}

void MountedDevice::clear_faults() {
  faults_.clear();
  acting_->effectiveness = faults_.effectiveness();
  acting_->stuck = faults_.stuck();
  acting_->silent = faults_.silent();
  frozen_.reset();
}

void MountedDevice::change(const DeviceConfig& changed, Time now) {
  if (built_.change) built_.change(*changed.params);  // first: it may throw
  const bool other_rate = changed.rate_hz != config_.rate_hz || changed.phase_s != config_.phase_s;
  config_ = changed;  // changed_device() refuses changes of fixed values
  acting_->watchdog = from_seconds(config_.watchdog_s);
  acting_->safe_state = config_.safe;
  if (other_rate) plan_again(now);
}

/// Plans the samples from time 0, independent of when the device was added or changed; the next sample is the first
/// after now.
void MountedDevice::plan_again(Time now) {
  samples_planned_ = 0;
  next_sample_step_ = now / host_.clock.step;
  plan_schedule();
}

void MountedDevice::visit_state(StateArchive& archive) {
  archive(samples_planned_, next_sample_step_, last_sample_, X_WS_before_, faults_, frozen_, frozen_utime_);
  archive(acting_->last_command, acting_->safe);
  double period_us = period_us_, phase_us = phase_us_;
  archive.unhashed(period_us, phase_us);
  if (archive.restoring()) {
    // The device may have another rate in the restored world.
    if (period_us != period_us_ || phase_us != phase_us_) plan_again(host_.clock.now());
    check_schedule(archive);
    archive.require(last_sample_, Time{-1}, host_.clock.now(), "the time of a last sample");
    archive.require(acting_->last_command, Time{-1}, host_.clock.now(), "the time of a last command");
    acting_->effectiveness = faults_.effectiveness();
    acting_->stuck = faults_.stuck();
    acting_->silent = faults_.silent();
  }
  if (built_.sensor) built_.sensor->visit_state(archive);
  if (built_.actuator) built_.actuator->visit_state(archive);
}

}  // namespace sim
