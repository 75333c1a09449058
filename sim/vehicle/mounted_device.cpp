// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/mounted_device.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/bus/bus.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/vehicle/run_hash.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace sim {

/// Publisher of the reports of a sensor: immediately, at a later simulated time by an event, or when the world
/// publishes what it has held.
class MountedDevice::Outlet final : public Publisher {
 public:
  Outlet(MountedDevice& device, Bus& bus, const std::string& channel, const VehicleClock* clock)
      : Publisher(device.host_.epoch_us, clock), device_(device), channel_(bus.open_channel(channel)) {}

  /// Sets the time of the following messages.  `hold`: they wait for flush().
  void set(Time now, Time latency, bool hold) {
    now_ = now;
    latency_ = latency;
    hold_ = hold;
  }

  /// Stores messages published from now on in `copies` as well; null: stops.
  void copy_to(std::vector<Bytes>* copies) { copies_ = copies; }

  void publish(std::span<const std::byte> payload) override {
    if (copies_) copies_->emplace_back(payload.begin(), payload.end());
    if (!hold_) return send(payload);
    // Keep payloads to reuse their memory: those of cameras are large.
    if (waiting_ == payloads_.size()) payloads_.emplace_back();
    payloads_[waiting_++].assign(payload.begin(), payload.end());
  }

  void flush() {
    for (std::size_t i = 0; i < waiting_; ++i) send(payloads_[i]);
    waiting_ = 0;
  }

  void publish_late(std::span<const std::byte> payload, Time at) { channel_->publish(payload, at); }

 private:
  void send(std::span<const std::byte> payload) {
    if (latency_.count() == 0) return channel_->publish(payload, now_);
    Event event;
    event.due = now_ + latency_;
    event.device = device_.number_;
    event.kind = report_event;
    event.stamp = now_;
    event.payload.assign(payload.begin(), payload.end());
    device_.host_.events.schedule(std::move(event));
  }

  MountedDevice& device_;
  const std::unique_ptr<OpenChannel> channel_;
  Time now_{0};
  Time latency_{0};
  bool hold_ = false;
  std::size_t waiting_ = 0;
  std::vector<Bytes> payloads_;
  std::vector<Bytes>* copies_ = nullptr;
};

MountedDevice::MountedDevice(Vehicle& vehicle, const DeviceConfig& config, DeviceHost& host, int number)
    : body_(config.body.empty() ? vehicle.base() : vehicle.body(config.body)),
      vehicle_(vehicle),
      X_BS_(config.X_BS()),
      host_(host),
      full_name_(vehicle.name() + "/" + config.name),
      // Two streams: drawing the loss and delay of messages must not change the noise, so that a run with another
      // link keeps its errors.
      noise_random_(host.seed, full_name_),
      link_random_(host.seed, full_name_ + "#link"),
      number_(number),
      type_(*config.device_type),
      bus_(vehicle.bus()),
      config_(&config),
      report_channel_(device_channel(host.channels, vehicle.name(), config, ChannelKind::report)),
      command_channel_(device_channel(host.channels, vehicle.name(), config, ChannelKind::command)),
      awake_(host.awake.of(number)),
      built_(type_.build(*config.params, {host.world, vehicle, config,
                                          config.body.empty() ? vehicle.body(vehicle.config().bodies.front().name)
                                                              : vehicle.body(config.body),
                                          number, faults_, host})) {
  sensor_ = built_.sensor.get();
  reporter_ = built_.reporter.get();
  if (built_.controller) mailbox_ = bus_.open_mailbox(command_channel_, Bus::default_mailbox_capacity);
  acting_->actuator = built_.actuator.get();
  acting_->systems = &vehicle.systems();
  acting_->is_actuator = type_.is_actuator();
  acting_->always_on = type_.always_on;
  take_config();
  if (reporter_) report_outlet_ = std::make_unique<Outlet>(*this, bus_, report_channel_, &vehicle.clock());
  wake();
  plan_again(host.clock.now());
}

/// Takes the values that steps use out of the configuration.
void MountedDevice::take_config() {
  acting_->watchdog = from_seconds(config_->watchdog_s);
  acting_->safe_state = config_->safe;
  latency_s_ = config_->latency_s;
  jitter_s_ = config_->jitter_s;
  dropout_ = config_->dropout;
  truth_ = config_->truth && reporter_;
  // The truth channel is for observation: it does not change the run and its hash.
  if (truth_ && !truth_outlet_)
    truth_outlet_ = std::make_unique<Outlet>(
        *this, RunHash::uncounted(bus_), device_channel(host_.channels, vehicle_.name(), *config_, ChannelKind::truth),
        nullptr);
}

void MountedDevice::plan_schedule() {
  period_us_ = phase_us_ = 0;
  if (config_->rate_hz > 0) {
    period_us_ = 1e6 / config_->rate_hz;
    // The top 32 bits of the name's hash as a fraction of the period.
    const double fraction = static_cast<double>(hash_text(full_name_) >> 32) / 4294967296.0;
    phase_us_ = config_->phase_s ? *config_->phase_s * 1e6 : fraction * period_us_;
  }
  plan_next_sample();
}

MountedDevice::~MountedDevice() = default;

void MountedDevice::plan_next_sample() {
  const std::int64_t earliest = next_sample_step_ + 1;
  if (period_us_ == 0) {
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
  const bool fits = config_->rate_hz > 0 ? next_sample_step_ == step_of_sample(samples_planned_ - 1)
                                         : next_sample_step_ > 0 && next_sample_step_ <= host_.clock.step_number + 1;
  if (!fits) archive.fail("the snapshot has an invalid value: a next sample");
}

Time MountedDevice::next_latency() {
  double latency_s = latency_s_;
  if (jitter_s_ > 0) latency_s += link_random_.uniform() * jitter_s_;
  return from_seconds(latency_s);
}

bool MountedDevice::takes_messages_alone() const {
  const bool at_once = latency_s_ == 0 && jitter_s_ == 0 && vehicle_.config().actuator_latency_s == 0;
  return type_.acts_alone && sensor_ == nullptr && at_once;
}

void MountedDevice::take_messages(Time now, std::int64_t step_number, std::vector<std::string>* bad) {
  bool first = true;
  while (const std::optional<Message> message = mailbox_->take()) {
    if (first) link_random_.begin_step(step_number);
    first = false;
    if (dropout_ > 0 && link_random_.uniform() < dropout_) continue;
    if (faults_.dropout() > 0 && link_random_.uniform() < faults_.dropout()) continue;
    Time latency = next_latency();
    if (type_.is_actuator()) latency += from_seconds(vehicle_.config().actuator_latency_s);
    // The latency of a sensor delays its reports, not its commands (a modem has both).
    if (latency.count() == 0 || built_.sensor) {
      receive(now, message->payload, bad);
      continue;
    }
    host_.events.schedule({now + latency, 0, number_, command_event, now, message->payload});
  }
}

bool MountedDevice::works() const {
  return type_.always_on || vehicle_.systems().powered;
}

void MountedDevice::receive(Time now, std::span<const std::byte> payload, std::vector<std::string>* bad) {
  if (!works() || faults_.silent()) return;
  // A stuck actuator keeps its last command; after an emergency stop it gets none until the release.
  if (type_.is_actuator() && (vehicle_.systems().estopped || faults_.stuck())) return;
  wake();
  try {
    built_.controller->receive(now, payload);
    acting_->last_command = now;
    acting_->safe = false;
  } catch (const std::runtime_error& error) {
    if (bad != nullptr)
      bad->push_back(error.what());
    else
      host_.warnings.bad_message(command_channel_, error.what());
  }
}

void MountedDevice::report_bad_messages(const std::vector<std::string>& bad) {
  for (const std::string& text : bad) host_.warnings.bad_message(command_channel_, text);
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
    // Never commanded is not stale: the actuator is in its initial state.
    const bool stale = watchdog.count() > 0 && last_command.count() >= 0 && !stuck && now - last_command > watchdog;
    // Once only: an actuator may move on its own in its safe state.
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

void MountedDevice::displaced() {
  X_WS_before_.reset();
  if (sensor_ != nullptr) sensor_->displaced();
}

void MountedDevice::publish_reports() {
  if (truth_outlet_) truth_outlet_->flush();
  if (report_outlet_) report_outlet_->flush();
}

void MountedDevice::sample(Time now, std::int64_t step_number, bool hold) {
  double dt_s = 0;
  if (!sleeps()) {  // a sample without effect leaves no trace in the state
    plan_next_sample();
    if (!works()) return;
    if (last_sample_.count() >= 0) dt_s = to_seconds(now - last_sample_);
    last_sample_ = now;
  } else if (!works()) {
    return;
  }
  // Measure the truth.
  const Pose X_WB = body_.X_WB();
  const SenseContext context{host_.world, vehicle_, now, dt_s, X_WB * X_BS_, body_.velocity_at_W(X_BS_.translation())};
  sensor_->measure(context);
  if (!reporter_) return;
  // Report it on the truth channel.
  if (truth_) {
    truth_outlet_->set(now, Time{0}, hold);
    reporter_->report(now, *truth_outlet_);
  }
  // Add the errors.
  noise_random_.begin_step(step_number);
  sensor_->disturb(dt_s, noise_random_);
  if (!complete_) {
    complete_ = sensor_->lacks().empty();
    if (lacking_since_.count() < 0) lacking_since_ = now;
  }
  link_random_.begin_step(-step_number);  // independent of the draws of take_messages in the same step
  // Report, unless the message is lost.
  if (dropout_ > 0 && link_random_.uniform() < dropout_) return;
  const Time latency = next_latency();
  if (faults_.silent()) return;
  if (faults_.dropout() > 0 && link_random_.uniform() < faults_.dropout()) return;
  report_outlet_->set(now, latency, hold);
  report(now);
}

std::optional<MountedDevice::Lack> MountedDevice::lack() const {
  if (complete_ || lacking_since_.count() < 0) return std::nullopt;
  const std::string_view what = sensor_->lacks();
  if (what.empty()) return std::nullopt;  // since it was restored
  return Lack{what, last_sample_ - lacking_since_};
}

void MountedDevice::report(Time now) {
  if (!faults_.stuck()) {
    reporter_->report(now, *report_outlet_);
    return;
  }
  if (!frozen_) {  // the first report after the fault is repeated
    frozen_.emplace();
    frozen_utime_ = report_outlet_->utime(now);
    report_outlet_->copy_to(&*frozen_);
    reporter_->report(now, *report_outlet_);
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
      if (report_outlet_) report_outlet_->publish_late(event.payload, event.due);
      break;
    case command_event:
      receive(event.due, event.payload);
      break;
    case arrival_event:
      wake();
      built_.sensor->arrive(event.due, event.payload);
      break;
    default:
      break;
  }
}

void MountedDevice::set_fault(const FaultConfig& fault) {
  faults_.set(fault);
  wake();
  acting_->effectiveness = faults_.effectiveness();
  acting_->stuck = faults_.stuck();
  acting_->silent = faults_.silent();
}

void MountedDevice::clear_faults() {
  faults_.clear();
  wake();
  acting_->effectiveness = faults_.effectiveness();
  acting_->stuck = faults_.stuck();
  acting_->silent = faults_.silent();
  frozen_.reset();
}

void MountedDevice::change(const DeviceConfig& changed, Time now) {
  if (built_.change) built_.change(*changed.params);  // first: it may throw
  const bool other_rate = changed.rate_hz != config_->rate_hz || changed.phase_s != config_->phase_s;
  changed_ = std::make_unique<DeviceConfig>(changed);  // changed_device() refuses changes of fixed values
  config_ = changed_.get();
  take_config();
  wake();
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
  archive.unhashed(period_us, phase_us, lacking_since_, complete_);
  if (archive.restoring()) {
    wake();
    // The device may have another rate in the restored world.
    if (period_us != period_us_ || phase_us != phase_us_) plan_again(host_.clock.now());
    check_schedule(archive);
    archive.require(last_sample_, Time{-1}, host_.clock.now(), "the time of a last sample");
    archive.require(lacking_since_, Time{-1}, host_.clock.now(), "the time of a first sample");
    archive.require(acting_->last_command, Time{-1}, host_.clock.now(), "the time of a last command");
    acting_->effectiveness = faults_.effectiveness();
    acting_->stuck = faults_.stuck();
    acting_->silent = faults_.silent();
  }
  if (built_.sensor) built_.sensor->visit_state(archive);
  if (built_.actuator) built_.actuator->visit_state(archive);
}

}  // namespace sim
