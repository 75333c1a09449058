// SPDX-License-Identifier: BSD-3-Clause
#include "devices/signals/microphone.hpp"

#include <algorithm>
#include <cmath>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/sound_t.hpp"
#include "sim/base/math.hpp"

namespace devices {

namespace {

constexpr double nearest_m = 0.05;  // within the housing the law of a point source does not hold

double power(double level_dB) {
  return std::pow(10, level_dB / 10);
}

}  // namespace

void Microphone::Params::read(sim::ParamReader& in) {
  in.read("ambient_dB", ambient_dB, sim::between(-20, 194),
          "level of the ambient noise; softer sounds are not received");
  in.read("level_noise", level_noise, "error of the level, dB");
  in.read("bearing_noise", bearing_noise, "error of the bearing, rad");
}

Microphone::Microphone(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      in_air_(speakers_in_air(context)),
      level_noise_(context, params),
      bearing_noise_(context, params) {}

void Microphone::measure(const sim::SenseContext& context) {
  const bool received_before = !sound_.empty();
  sound_.clear();
  bearing_rad_ = elevation_rad_ = 0;
  double all = power(params_.ambient_dB), loudest_dB = params_.ambient_dB;
  for (const auto& [name, speaker] : in_air_.all) {
    const auto& playing = speaker->playing();
    if (!playing) continue;
    const sim::Vector3d p_S = context.X_WS.inverse() * speaker->position_W();
    const double level_dB = speaker->level_dB(*playing) - 20 * std::log10(std::max(p_S.norm(), nearest_m));
    all += power(level_dB);
    if (level_dB <= loudest_dB) continue;
    loudest_dB = level_dB;
    sound_ = speaker->sound(*playing).name;
    constexpr double same_place_m = 1e-6;
    const bool is_here = p_S.norm() < same_place_m;  // without a direction
    bearing_rad_ = is_here ? 0 : std::atan2(p_S.y(), p_S.x());
    elevation_rad_ = is_here ? 0 : std::atan2(p_S.z(), std::hypot(p_S.x(), p_S.y()));
  }
  level_dB_ = 10 * std::log10(all);
  is_update_ = received_before || !sound_.empty();
  used_ = used_ || is_update_;
}

void Microphone::disturb(double dt_s, sim::Random& random) {
  level_noise_.apply(level_dB_, dt_s, random);
  if (sound_.empty()) return;
  bearing_noise_.apply(bearing_rad_, dt_s, random);
  bearing_rad_ = sim::wrap_angle(bearing_rad_);
}

// Publishes shoal.sound_t while a sound is above the ambient noise, and once when that has ended.
bool fill(const Microphone& microphone, shoal::sound_t& message) {
  if (!microphone.is_update()) return false;
  message.sound = microphone.sound();
  message.level_dB = microphone.level_dB();
  message.bearing_rad = microphone.bearing_rad();
  message.elevation_rad = microphone.elevation_rad();
  return true;
}

SHOAL_SENSOR("microphone", Microphone, shoal::sound_t);

}  // namespace devices
