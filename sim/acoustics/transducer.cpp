// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/transducer.hpp"

#include "sim/acoustics/channel.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/world/world.hpp"

namespace sim {

namespace {

/// The channel, where there is water to carry sound.
AcousticChannel& channel_of(const DeviceContext& context) {
  AcousticChannel& channel = context.world.acoustics();
  if (!channel.has_water())
    throw_config_error(context.config.place,
                       "vehicle '" + context.vehicle.name() + "': device '" + context.config.name + "'",
                       "a device of type '" + context.config.type +
                           "' needs water to carry its sound: the world has no 'medium: {water: ...}'");
  return channel;
}

}  // namespace

void ReceiverConfig::read(ParamReader& in) {
  in.read("detection_dB", detection_dB, between(-60, 100), "signal over noise and other sounds to notice a signal");
  in.read("capture_dB", capture_dB, between(0, 200), "a signal this much stronger takes over from the one it takes");
  in.read("protection_dB", protection_dB, between(-60, 200),
          "a message that it takes is lost where it is not this much stronger than all others in its band together");
  in.read("doppler_limit_mps", doppler_limit_mps, between(0, 1000), "closing or parting speed that it follows");
  in.read("directivity", directivity, "for sending and hearing; its axis is x of the device");
}

Transducer::Transducer(AcousticListener& listener, const ReceiverConfig& config, const DeviceContext& context)
    : listener_(listener),
      config_(config),
      channel_(channel_of(context)),
      vehicle_(context.vehicle),
      body_(context.body),
      X_BS_(context.config.X_BS()),
      faults_(context.faults),
      full_name_(context.full_name()) {
  channel_.join(*this);
}

Transducer::~Transducer() {
  channel_.leave(*this);
}

void Transducer::transmit(Signal signal, Time at) {
  busy_until_ = std::max(busy_until_, at + signal.duration);
  channel_.transmit(*this, std::move(signal), at);
}

void Transducer::call_back() {
  busy_until_ = channel_.call_back(*this);
}

void Transducer::belong_to(const Audience& own) {
  counts_.lost[static_cast<std::size_t>(SignalLoss::range)] += out_of_range();
  own_ = own;
  meant_before_ = channel_.messages_for(own_);
  meant_near_ = 0;
}

std::int64_t Transducer::out_of_range() const {
  // Without signs: a snapshot that somebody made up may hold any counts.
  const auto meant = static_cast<std::uint64_t>(channel_.messages_for(own_));
  return static_cast<std::int64_t>(meant - static_cast<std::uint64_t>(meant_before_) -
                                   static_cast<std::uint64_t>(meant_near_));
}

Transducer::Counts Transducer::counts() const {
  Counts counts = counts_;
  counts.lost[static_cast<std::size_t>(SignalLoss::range)] += out_of_range();
  return counts;
}

bool Transducer::works() const {
  return vehicle_.systems().powered && !faults_.silent();
}

const Transducer::Motion& Transducer::motion() const {
  // Where hundreds of signals come to it in a step, it is worked out once.
  const std::int64_t look = channel_.look();
  if (look == motion_of_ && look >= 0) return motion_;
  const BodyMotion body = body_.motion();
  const Vector3d p_BS_W = body.R_WB * X_BS_.translation();
  motion_.p_W = body.p_WB + p_BS_W;
  motion_.drift_W = body.v_WB_W + body.w_WB_W.cross(p_BS_W);
  motion_.v_W = body_.velocity_at_W(X_BS_.translation());
  motion_of_ = look;
  return motion_;
}

Vector3d Transducer::p_W(Time at) const {
  const Motion& now = motion();
  return now.p_W + now.drift_W * to_seconds(at - channel_.step_end());
}

Matrix3d Transducer::R_WS() const {
  return body_.motion().R_WB * X_BS_.linear();
}

void Transducer::change(const ReceiverConfig& config) {
  config_ = config;
  channel_.forget_receivers();
  index_of_Hz_ = std::numeric_limits<double>::quiet_NaN();
}

Decibels Transducer::noise_reduction(double frequency_Hz) const {
  if (config_.directivity.pattern == DirectivityConfig::Pattern::omni) return {};
  if (index_of_Hz_ != frequency_Hz) {
    // The speed of sound in water changes by some percent at most, the index by hundredths of dB.
    constexpr double usual_mps = 1500;
    index_ = directivity_index(config_.directivity, frequency_Hz, usual_mps);
    index_of_Hz_ = frequency_Hz;
  }
  return index_;
}

ContinuousSound::ContinuousSound(Decibels source_level, double centre_Hz, double bandwidth_Hz,
                                 const DeviceContext& context)
    : channel_(channel_of(context)),
      vehicle_(context.vehicle),
      body_(context.body),
      p_BS_(context.config.position_m),
      faults_(context.faults),
      source_level_(source_level),
      centre_Hz_(centre_Hz),
      bandwidth_Hz_(bandwidth_Hz) {
  channel_.join(*this);
}

void ContinuousSound::set_on(bool on) {
  if (on == on_) return;
  on_ = on;
  channel_.noise_changed();
}

void ContinuousSound::set_level(Decibels source_level) {
  source_level_ = source_level;
  channel_.noise_changed();
}

ContinuousSound::~ContinuousSound() {
  channel_.leave(*this);
}

}  // namespace sim
