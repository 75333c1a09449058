// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/transducer.hpp"

#include "sim/acoustics/channel.hpp"
#include "sim/device/fault.hpp"
#include "sim/physics/body.hpp"

namespace sim {

void ReceiverConfig::read(ParamReader& in) {
  in.read("detection_dB", detection_dB, between(-60, 100),
          "signal-to-noise-and-interference ratio needed to detect a signal");
  in.read("capture_dB", capture_dB, between(0, 200),
          "capture ratio: a signal this much stronger replaces the one being received");
  in.read("protection_dB", protection_dB, between(-60, 200),
          "a message is lost unless it is this much stronger than all other signals in its band together");
  in.read("doppler_limit_mps", doppler_limit_mps, between(0, 1000), "maximum closing or opening speed that it tracks");
  in.read("directivity", directivity, "directivity for sending and receiving; its axis is x of the device");
}

Transducer::Transducer(AcousticListener& listener, const ReceiverConfig& config, SoundSite site)
    : listener_(listener), config_(config), site_(std::move(site)) {
  site_.channel.add(*this);
}

Transducer::~Transducer() {
  site_.channel.remove(*this);
}

void Transducer::transmit(Signal signal, Time at) {
  busy_until_ = std::max(busy_until_, at + signal.duration);
  site_.channel.transmit(*this, std::move(signal), at);
}

void Transducer::cancel_pending() {
  busy_until_ = site_.channel.cancel_pending(*this);
}

void Transducer::set_address(const Audience& own) {
  counts_.lost[static_cast<std::size_t>(SignalLoss::range)] += out_of_range();
  own_ = own;
  addressed_before_ = site_.channel.messages_for(own_);
  addressed_in_range_ = 0;
}

std::int64_t Transducer::out_of_range() const {
  // Unsigned arithmetic, as a forged snapshot may contain any counts.
  const auto sent = static_cast<std::uint64_t>(site_.channel.messages_for(own_));
  return static_cast<std::int64_t>(sent - static_cast<std::uint64_t>(addressed_before_) -
                                   static_cast<std::uint64_t>(addressed_in_range_));
}

Transducer::Counts Transducer::counts() const {
  Counts counts = counts_;
  counts.lost[static_cast<std::size_t>(SignalLoss::range)] += out_of_range();
  return counts;
}

bool Transducer::works() const {
  return site_.powered && !site_.faults.silent();
}

const Transducer::Motion& Transducer::motion() const {
  // Cached, as hundreds of signals may arrive in one step.
  const std::int64_t serial = site_.channel.clock().serial();
  if (serial == motion_of_ && serial >= 0) return motion_;
  const BodyMotion body = site_.body.motion();
  const Vector3d p_BS_W = body.R_WB * site_.X_BS.translation();
  motion_.p_W = body.p_WB + p_BS_W;
  motion_.drift_W = body.v_WB_W + body.w_WB_W.cross(p_BS_W);
  motion_.v_W = site_.body.velocity_at_W(site_.X_BS.translation());
  motion_of_ = serial;
  return motion_;
}

Vector3d Transducer::p_W(Time at) const {
  const Motion& now = motion();
  return now.p_W + now.drift_W * to_seconds(at - site_.channel.clock().step_end());
}

Matrix3d Transducer::R_WS() const {
  return site_.body.motion().R_WB * site_.X_BS.linear();
}

void Transducer::change(const ReceiverConfig& config) {
  config_ = config;
  site_.channel.clear_receivers();
  index_of_Hz_ = std::numeric_limits<double>::quiet_NaN();
}

Decibels Transducer::noise_reduction(double frequency_Hz) const {
  if (config_.directivity.pattern == DirectivityConfig::Pattern::omni) return {};
  if (index_of_Hz_ != frequency_Hz) {
    // A variation of the speed of sound by some percent changes the index by hundredths of dB only.
    constexpr double usual_mps = 1500;
    index_ = directivity_index(config_.directivity, frequency_Hz, usual_mps);
    index_of_Hz_ = frequency_Hz;
  }
  return index_;
}

ContinuousSound::ContinuousSound(Decibels source_level, double centre_Hz, double bandwidth_Hz, SoundSite site)
    : site_(std::move(site)), source_level_(source_level), center_Hz_(centre_Hz), bandwidth_Hz_(bandwidth_Hz) {
  site_.channel.add(*this);
}

void ContinuousSound::set_on(bool on) {
  if (on == on_) return;
  on_ = on;
  site_.channel.noise_changed();
}

void ContinuousSound::set_level(Decibels source_level) {
  source_level_ = source_level;
  site_.channel.noise_changed();
}

ContinuousSound::~ContinuousSound() {
  site_.channel.remove(*this);
}

}  // namespace sim
