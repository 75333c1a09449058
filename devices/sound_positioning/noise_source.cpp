// SPDX-License-Identifier: BSD-3-Clause
#include "devices/sound_positioning/noise_source.hpp"

#include "devices/common/actuator_commands.hpp"

namespace devices {

void NoiseSource::Params::read(sim::ParamReader& in) {
  in.read_choice("kind", kind, {{"continuous", Kind::continuous}, {"pulses", Kind::pulses}},
                 "continuous: part of the ambient noise; pulses: travel as the signals of modems do");
  in.read("on", on, "at the start; a command of 0 turns it off, any other on");
  in.read("level_dB", level_dB, sim::between(0, 280), "over its band, re 1 uPa at 1 m");
  in.read("frequency_Hz", frequency_Hz, sim::between(1, 1e6), "middle of its band");
  in.read("bandwidth_Hz", bandwidth_Hz, sim::between(1, 1e6), "bandwidth, which it fills evenly");
  in.read("period_s", period_s, sim::between(1e-3, 1e6), "it sounds once per period; unset: all the time (continuous)");
  in.read("sound_s", sound_s, sim::between(1e-4, 1e6), "duration of the sound in each period");
  if (in.describing()) return;
  if (kind == Kind::pulses && !period_s) in.error("kind", "kind 'pulses' needs a 'period_s'");
  if (period_s && sound_s > *period_s) in.error("sound_s", "'sound_s' must be at most 'period_s'");
}

NoiseSource::NoiseSource(const Params& params, const sim::DeviceContext& context) : params_(params), on_(params.on) {
  if (params.kind == Kind::pulses)
    transducer_.emplace(*this, sim::ReceiverConfig{}, context.sound_site());
  else
    sound_.emplace(sim::Decibels{params.level_dB}, params.frequency_Hz, params.bandwidth_Hz, context.sound_site());
}

void NoiseSource::change(const Params& params) {
  if (params.on != params_.on) on_ = params.on;
  params_ = params;
  if (sound_) sound_->set_level(sim::Decibels{params.level_dB});
}

void NoiseSource::act(const sim::ActContext& context) {
  const bool on = on_ && context.effectiveness > 0;
  if (sound_) {
    const bool now =
        !params_.period_s || context.now % sim::from_seconds(*params_.period_s) < sim::from_seconds(params_.sound_s);
    sound_->set_on(on && now);
  } else if (on) {
    send_pulses(context);
  }
}

void NoiseSource::send_pulses(const sim::ActContext& context) {
  const sim::Time period = sim::from_seconds(*params_.period_s);
  const sim::Time end = context.now + sim::from_seconds(context.step_s);
  for (sim::Time at = (context.now + period - sim::Time{1}) / period * period; at < end; at += period) {
    if (at < transducer_->busy_until()) continue;  // the last pulse of a longer period, before a change
    sim::Signal pulse;
    pulse.kind = sim::Signal::Kind::noise;
    pulse.source_level = sim::Decibels{params_.level_dB};
    pulse.centre_Hz = params_.frequency_Hz;
    pulse.bandwidth_Hz = params_.bandwidth_Hz;
    pulse.duration = sim::from_seconds(params_.sound_s);
    transducer_->transmit(std::move(pulse), at);
  }
}

void NoiseSource::make_safe(sim::SafeState safe) {
  if (safe == sim::SafeState::stop) on_ = false;
}

void NoiseSource::visit_state(sim::StateArchive& archive) {
  archive(on_);  // the acoustic channel visits the present sound
}

SHOAL_ACTUATOR("noise_source", NoiseSource, NumberController<NoiseSource>);

}  // namespace devices
