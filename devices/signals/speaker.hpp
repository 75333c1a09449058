// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/device/device.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/world_file/vehicle_config.hpp"

namespace devices {

class Speaker;

/// The speakers of a world by their full names, in whose order microphones add their sounds.
struct SpeakersInAir {
  std::map<std::string, const Speaker*> all;
};

/// Sound that a speaker plays.
struct PlayedSound {
  std::int64_t number = 0;  ///< among the sounds of the speaker
  double volume = 1;        ///< share of its sound pressure
  sim::Time until{0};
  void visit_state(sim::StateArchive& archive) { archive(number, volume, until); }
};

/// Loudspeaker that plays named sounds, each with its duration and its level at 1 m.  It radiates equally in all
/// directions.
class Speaker final : public sim::Sensor, public sim::UnhashedUntilUsed {
 public:
  static constexpr const char* meaning = "Loudspeaker in air: plays named sounds, which microphones receive.";
  static constexpr double default_rate_hz = 50;
  static constexpr const char* example = "sounds: [{name: beep}]";
  struct SoundParams {
    std::string name;
    double duration_s = 0.5;
    double level_dB = 70;
    void read(sim::ParamReader& in);
  };
  struct Params {
    std::vector<SoundParams> sounds;
    void read(sim::ParamReader& in);
  };
  using Playing = PlayedSound;

  Speaker(const Params& params, const sim::DeviceContext& context);
  ~Speaker() override;
  void act(const sim::ActContext& context);
  void measure(const sim::SenseContext& context) override;
  void disturb(double, sim::Random&) override {}
  void visit_state(sim::StateArchive& archive) override;
  bool used() const override { return used_; }

  /// Returns the number of a sound; unset: there is none of this name.
  std::optional<std::int64_t> find(const std::string& sound) const;
  std::vector<std::string> names() const;
  /// Plays a sound in place of the present one, with a share of its sound pressure, > 0 to 1.
  void play(std::int64_t sound, double volume, sim::Time now);
  void stop();

  const std::optional<Playing>& playing() const { return playing_; }
  const SoundParams& sound(const Playing& playing) const { return sounds_[static_cast<std::size_t>(playing.number)]; }
  /// Returns the sound level at 1 m, dB re 20 uPa.
  double level_dB(const Playing& playing) const;
  sim::Vector3d position_W() const;
  /// Returns how long the sound still lasts at the last sample.
  sim::Time remaining() const { return playing_ ? playing_->until - sampled_at_ : sim::Time{0}; }
  /// Returns whether a sound has begun or ended since the last sample.
  bool is_update() const { return changed_; }

 private:
  const std::vector<SoundParams> sounds_;
  const sim::Body& body_;
  const sim::Vector3d p_BS_;
  const std::string name_;
  SpeakersInAir& in_air_;
  std::optional<Playing> playing_;
  bool used_ = false, pending_ = false, changed_ = false;
  sim::Time sampled_at_{0};  ///< set at each sample before its use
};

/// Receives shoal.sound_t.
class SpeakerController final : public sim::Controller {
 public:
  static constexpr const char* command_messages = "shoal.sound_t";
  explicit SpeakerController(Speaker& speaker) : speaker_(speaker) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  Speaker& speaker_;
};

/// Returns the names of the sounds of the speakers of a vehicle file.
std::vector<std::string> sounds_of(const sim::VehicleConfig& vehicle);

/// Returns the speakers of the world of a device.
SpeakersInAir& speakers_in_air(const sim::DeviceContext& context);

}  // namespace devices
