// SPDX-License-Identifier: BSD-3-Clause
#include "devices/signals/speaker.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sound_t.hpp"
#include "sim/config/message_text.hpp"
#include "sim/physics/body.hpp"

namespace devices {

namespace {

const sim::SharedKind<SpeakersInAir> speakers;

}  // namespace

SpeakersInAir& speakers_in_air(const sim::DeviceContext& context) {
  return context.shared(speakers);
}

void Speaker::SoundParams::read(sim::ParamReader& in) {
  in.require("name");
  in.read_name("name", name, "name of the sound");
  in.read("duration_s", duration_s, sim::between(0.001, 3600), "how long it lasts");
  in.read("level_dB", level_dB, sim::between(-20, 194), "sound pressure level at 1 m at full volume, re 20 uPa");
}

void Speaker::Params::read(sim::ParamReader& in) {
  in.require("sounds");
  in.read_list("sounds", sounds, "sound", "sounds that it can play");
  if (in.describing()) return;
  for (std::size_t i = 0; i < sounds.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (sounds[i].name == sounds[j].name) in.error("sounds", "'sounds' names '" + sounds[i].name + "' twice");
}

Speaker::Speaker(const Params& params, const sim::DeviceContext& context)
    : sounds_(params.sounds),
      body_(context.body),
      p_BS_(context.config.X_BS().translation()),
      name_(context.full_name()),
      in_air_(speakers_in_air(context)) {
  in_air_.all[name_] = this;
}

Speaker::~Speaker() {
  const auto place = in_air_.all.find(name_);
  if (place != in_air_.all.end() && place->second == this) in_air_.all.erase(place);
}

std::optional<std::int64_t> Speaker::find(const std::string& sound) const {
  for (std::size_t i = 0; i < sounds_.size(); ++i)
    if (sounds_[i].name == sound) return static_cast<std::int64_t>(i);
  return std::nullopt;
}

std::vector<std::string> Speaker::names() const {
  std::vector<std::string> names;
  for (const SoundParams& sound : sounds_) names.push_back(sound.name);
  return names;
}

void Speaker::play(std::int64_t sound, double volume, sim::Time now) {
  const double duration_s = sounds_[static_cast<std::size_t>(sound)].duration_s;
  playing_ = Playing{sound, std::clamp(volume, 1e-6, 1.0), now + sim::from_seconds(duration_s)};
  used_ = pending_ = true;
}

void Speaker::stop() {
  pending_ = pending_ || playing_.has_value();
  playing_.reset();
}

void Speaker::act(const sim::ActContext& context) {
  if (playing_ && (context.effectiveness <= 0 || context.now >= playing_->until)) stop();
}

void Speaker::measure(const sim::SenseContext& context) {
  sampled_at_ = context.now;
  changed_ = pending_;
  pending_ = false;
}

double Speaker::level_dB(const Playing& playing) const {
  return sound(playing).level_dB + 20 * std::log10(playing.volume);
}

sim::Vector3d Speaker::position_W() const {
  return body_.X_WB() * p_BS_;
}

void Speaker::visit_state(sim::StateArchive& archive) {
  archive(used_, pending_, changed_, playing_);
  if (!archive.restoring() || !playing_) return;
  archive.require(playing_->number, 0, static_cast<std::int64_t>(sounds_.size()) - 1, "the number of a sound");
  archive.require(playing_->volume, 1e-6, 1, "the volume of a sound");
}

std::vector<std::string> sounds_of(const sim::VehicleConfig& vehicle) {
  std::vector<std::string> names;
  for (const sim::DeviceConfig& device : vehicle.devices)
    if (const auto* speaker = dynamic_cast<const sim::detail::ParamsOf<Speaker::Params>*>(device.params.get()))
      for (const Speaker::SoundParams& sound : speaker->params.sounds) names.push_back(sound.name);
  return names;
}

bool fill(const Speaker& speaker, shoal::sound_t& message) {
  if (!speaker.is_update()) return false;
  const auto& playing = speaker.playing();
  message.until_utime = message.utime + speaker.remaining().count();
  if (!playing) return true;
  message.sound = speaker.sound(*playing).name;
  message.volume = playing->volume;
  message.level_dB = speaker.level_dB(*playing);
  return true;
}

void SpeakerController::receive(sim::Time now, std::span<const std::byte> payload) {
  const auto message = shoal::decode<shoal::sound_t>(payload, shoal::Finite::required);
  if (message.sound.empty()) return speaker_.stop();
  if (!(message.volume > 0 && message.volume <= 1))
    throw std::runtime_error("'volume' must be > 0 and <= 1, got " + sim::number_text(message.volume));
  const auto number = speaker_.find(message.sound);
  if (!number)
    throw std::runtime_error("there is no sound '" + sim::shortened(sim::printable(message.sound)) + "'" +
                             sim::did_you_mean(message.sound, speaker_.names()) +
                             "; known: " + sim::list_text(speaker_.names()));
  speaker_.play(*number, message.volume, now);
}

SHOAL_TRANSCEIVER("speaker", Speaker, shoal::sound_t, SpeakerController);

}  // namespace devices
