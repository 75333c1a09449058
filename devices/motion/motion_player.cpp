// SPDX-License-Identifier: BSD-3-Clause
#include "devices/motion/motion_player.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "devices/joint/joint_of_device.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/motion_command_t.hpp"
#include "shoal/motion_state_t.hpp"
#include "sim/config/message_text.hpp"

namespace devices {

namespace {

constexpr double frame_rounding = 1e-6;  // share of a frame

/// Way of a soft start: at rest at both ends, at most 1.5 times the mean velocity between them.
double soft(double share) {
  return share * share * (3 - 2 * share);
}
constexpr double soft_peak = 1.5;

/// Returns the first device of this type that fits.
template <typename Device, typename Fits>
Device* first_device(const sim::Vehicle& vehicle, const Fits& fits) {
  for (const sim::MountedDevice* device : vehicle.devices())
    if (const auto* found = dynamic_cast<const Device*>(device->sensor()); found != nullptr && fits(*found))
      return const_cast<Device*>(found);  // devices of the vehicle command each other
  throw std::logic_error("the vehicle has lost a device");
}

}  // namespace

void MotionPlayer::MotionFile::read(sim::ParamReader& in) {
  const bool may_read = in.read_path("file", file, sim::PathUse::read, "motion file, relative to this file");
  if (!may_read) return;
  if (file.empty()) {
    if (!in.describing()) in.require("motion");
    return motion.read_keys(in);
  }
  const sim::SourcePlace& place = in.node()->place;
  const std::filesystem::path folder = place.file ? std::filesystem::path(*place.file).parent_path() : "";
  motion = sim::load_motion((folder / file).lexically_normal().string(), in.diagnostics());
}

void FirstPlay::read(sim::ParamReader& in) {
  in.require("motion");
  in.read("motion", motion, "name of the motion");
  in.read("from_s", from_s, sim::between(0, sim::max_motion_s), "start of the part that is played; unset: 0");
  in.read("to_s", to_s, sim::between(0, sim::max_motion_s),
          "end of the part that is played; unset: that of the motion");
  in.read("rate", rate, sim::between(0.01, 10), "speed; unset: 1");
  in.read("repeat", repeat, sim::between(-1, 1e9), "how often; 0: as the motion says, -1: until stopped");
  in.read("skip_approach", skip_approach, "the joints jump to the first values, limited by their servos");
}

void MotionPlayer::Params::read(sim::ParamReader& in) {
  in.require("group");
  in.read_name("group", group, "joint_group that it commands");
  in.read_list("motions", motions, "motion",
               "motions that it can play: {file: FILE}, or the keys of a motion file themselves");
  in.read("play", play, "what it plays from the start of the run; unset: nothing");
  if (in.describing()) return;
  for (const MotionFile& one : motions)
    if (!one.motion.name.empty()) in.declare("motion", one.motion.name);
}

MotionPlayer::MotionPlayer(const Params& params, const sim::DeviceContext& context)
    : group_name_(params.group), vehicle_(context.vehicle) {
  // Find the group, which is among the devices before this one.
  const sim::MountedDevice* device = vehicle_.find_device(group_name_);
  const auto* group = device != nullptr ? dynamic_cast<const JointGroup*>(device->sensor()) : nullptr;
  if (group == nullptr)
    refuse(context, "'group' must be a joint_group that is listed before this device, got '" + group_name_ + "'");
  group_ = const_cast<JointGroup*>(group);  // devices of the vehicle command each other
  try {
    motions_ = tracks_of(params);
    if (params.play) {
      const FirstPlay& first = *params.play;
      play({first.motion, first.from_s, first.to_s, first.rate, first.repeat, first.skip_approach});
    }
  } catch (const std::runtime_error& error) {
    refuse(context, error.what());
  }
}

std::vector<MotionPlayer::Tracks> MotionPlayer::tracks_of(const Params& params) const {
  std::vector<Tracks> motions;
  for (const MotionFile& file : params.motions) {
    const sim::JointMotion& motion = file.motion;
    Tracks& tracks = motions.emplace_back();
    tracks.name = motion.name;
    tracks.frame_s = motion.frame_s;
    // Set points go out at whole frames, so the motion lasts a whole number of them; the rounding constant keeps one
    // that ends at a frame from getting one more.
    tracks.duration_s = std::ceil(motion.end_s() / motion.frame_s - frame_rounding) * motion.frame_s;
    tracks.loop = motion.loop;
    tracks.start = motion.start;
    check_signals(motion);
    for (const sim::MotionSound& sound : motion.sounds) tracks.sounds.push_back({sound, nullptr, 0});
    for (sim::MotionTrack& track : motion.tracks()) {
      if (motion.is_light(track.joint)) {
        tracks.lights.push_back({std::move(track), nullptr, 0});
        continue;
      }
      const auto number = group_->servos().find(track.joint);
      if (!number)
        throw std::runtime_error("motion '" + motion.name + "' names joint '" +
                                 sim::shortened(sim::printable(track.joint)) + "', which is not a servo of the group" +
                                 sim::did_you_mean(track.joint, group_->names()) +
                                 "; known: " + sim::list_text(group_->names()));
      tracks.tracks.emplace_back(*number, std::move(track));
    }
  }
  return motions;
}

void MotionPlayer::check_signals(const sim::JointMotion& motion) const {
  const auto check = [&](const std::vector<std::string>& known, const std::string& name, const char* what) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw std::runtime_error("motion '" + motion.name + "' names " + what + " '" +
                               sim::shortened(sim::printable(name)) + "', which the vehicle does not have" +
                               sim::did_you_mean(name, known) + "; known: " + sim::list_text(known));
  };
  const std::vector<std::string> lights = lights_of(vehicle_.config()), sounds = sounds_of(vehicle_.config());
  for (const std::string& light : motion.lights) check(lights, light, "light");
  for (const sim::MotionSound& sound : motion.sounds) check(sounds, sound.sound, "sound");
}

void MotionPlayer::set_light(LightTrack& light) const {
  if (light.led == nullptr)
    light.led = first_device<Led>(vehicle_, [&](const Led& led) {
      light.light = led.find(light.track.joint).value_or(0);
      return led.find(light.track.joint).has_value();
    });
  light.led->set(light.light, light.track.value_at(playhead_s_));
}

void MotionPlayer::play_sounds(double from_s, double to_s, bool with_end, sim::Time now) {
  for (SoundTime& time : motions_[number_].sounds) {
    const double at_s = time.sound.at_s;
    // Half-open intervals, so that a sound at the border of two steps is played once.
    if (at_s < from_s || at_s > to_s || (at_s == to_s && !with_end)) continue;
    if (time.speaker == nullptr)
      time.speaker = first_device<Speaker>(vehicle_, [&](const Speaker& speaker) {
        time.number = speaker.find(time.sound.sound).value_or(0);
        return speaker.find(time.sound.sound).has_value();
      });
    time.speaker->play(time.number, time.sound.volume, now);
  }
}

void MotionPlayer::change(const Params& params) {
  std::vector<Tracks> motions = tracks_of(params);
  const double old_duration_s = motions_.empty() ? 0 : tracks().duration_s;
  motions_ = std::move(motions);
  const auto same =
      std::find_if(motions_.begin(), motions_.end(), [&](const Tracks& one) { return one.name == name_; });
  number_ = same == motions_.end() ? 0 : static_cast<std::size_t>(same - motions_.begin());
  if (same == motions_.end()) {
    name_.clear();
    return stop();
  }
  // A part up to the end of the motion follows its new end.
  if (to_s_ > same->duration_s || to_s_ >= old_duration_s - same->frame_s * frame_rounding) to_s_ = same->duration_s;
  from_s_ = std::min(from_s_, to_s_);
  playhead_s_ = std::clamp(playhead_s_, from_s_, to_s_);
}

const MotionPlayer::Tracks& MotionPlayer::motion_named(const std::string& name) const {
  std::vector<std::string> known;
  for (const Tracks& one : motions_) {
    if (one.name == name) return one;
    known.push_back(one.name);
  }
  throw std::runtime_error("there is no motion '" + sim::shortened(sim::printable(name)) + "'" +
                           sim::did_you_mean(name, known) + "; known: " + sim::list_text(known));
}

void MotionPlayer::check_part(const Tracks& motion, double from_s, double to_s) const {
  const bool is_within = from_s >= 0 && to_s <= motion.duration_s + motion.frame_s * frame_rounding && from_s <= to_s;
  if (!is_within)
    throw std::runtime_error("'from_s' and 'to_s' must be a part of motion '" + motion.name + "', from 0 to " +
                             sim::number_text(motion.duration_s) + ", got " + sim::number_text(from_s) + " and " +
                             sim::number_text(to_s));
}

void MotionPlayer::play(const Play& play) {
  const Tracks& motion = motion_named(play.motion);
  const double from_s = play.from_s.value_or(0), to_s = play.to_s.value_or(motion.duration_s);
  check_part(motion, from_s, to_s);
  if (play.repeat < -1) throw std::runtime_error("'repeat' must be >= -1, got " + std::to_string(play.repeat));
  set_rate(play.rate.value_or(1));
  // Start.
  name_ = motion.name;
  number_ = static_cast<std::size_t>(&motion - motions_.data());
  from_s_ = playhead_s_ = from_s;
  to_s_ = to_s;
  repeats_left_ = play.repeat == 0 ? (motion.loop ? -1 : 0) : play.repeat - (play.repeat > 0 ? 1 : 0);
  skips_approach_ = play.skip_approach;
  is_starting_ = true;
  approach_s_ = approached_s_ = 0;
  phase_ = Phase::approach;
}

void MotionPlayer::stop() {
  phase_ = Phase::idle;
  is_starting_ = false;
}

void MotionPlayer::pause() {
  if (phase_ == Phase::idle || phase_ == Phase::paused) return;
  phase_before_ = phase_;
  phase_ = Phase::paused;
}

void MotionPlayer::resume() {
  if (phase_ == Phase::paused) phase_ = phase_before_;
}

void MotionPlayer::seek(double at_s) {
  if (phase_ == Phase::idle) throw std::runtime_error("seek: no motion is played");
  check_part(tracks(), at_s, to_s_);
  playhead_s_ = at_s;
  if (phase_ == Phase::approach) is_starting_ = true;
}

void MotionPlayer::set_frame(std::int64_t frame, std::span<const std::size_t> joints, std::span<const double> values,
                             std::int64_t kept_frames) {
  if (name_.empty()) throw std::runtime_error("set_frame: no motion is played");
  Tracks& motion = motions_[number_];
  const double at_s = static_cast<double>(frame) * motion.frame_s;
  const auto is_before = [](const sim::TrackKey& key, double time_s) { return key.at_s < time_s; };
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto track = std::find_if(motion.tracks.begin(), motion.tracks.end(),
                                    [&](const auto& one) { return one.first == joints[i]; });
    if (track == motion.tracks.end() || !(at_s < track->second.keys.back().at_s))
      throw std::runtime_error("set_frame: the motion has no later key of a joint");
    std::vector<sim::TrackKey>& keys = track->second.keys;
    const auto from = std::lower_bound(keys.begin(), keys.end(), at_s - motion.frame_s * frame_rounding, is_before);
    const auto last = keys.erase(from, keys.end() - 1);
    keys.insert(last, {at_s, values[i], sim::Easing::linear});
    // Drop half of the keys at once: removal from the front moves all others.
    const double old_s = static_cast<double>(frame - kept_frames) * motion.frame_s;
    const auto kept = std::lower_bound(keys.begin(), keys.end(), old_s, is_before);
    if (kept - keys.begin() > keys.end() - kept) keys.erase(keys.begin(), kept - 1);
  }
}

void MotionPlayer::set_rate(double rate) {
  constexpr double min_rate = 0.01, max_rate = 10;
  if (!(rate >= min_rate && rate <= max_rate))
    throw std::runtime_error("'rate' must be >= 0.01 and <= 10, got " + sim::number_text(rate));
  rate_ = rate;
}

double MotionPlayer::at_s() const {
  const bool is_before = phase_ == Phase::approach || (phase_ == Phase::paused && phase_before_ == Phase::approach);
  return is_before ? approached_s_ - approach_s_ : playhead_s_;
}

void MotionPlayer::values_at(const Tracks& motion, double at_s, std::vector<double>& values) const {
  values.assign(group_->servos().size(), std::numeric_limits<double>::quiet_NaN());
  // A whole frame is taken as such, so that the same time always gives the same value.
  const double frames = at_s / motion.frame_s;
  double frame = std::floor(frames);
  double share = frames - frame;
  if (share > 1 - frame_rounding) {
    frame += 1;
    share = 0;
  }
  if (share < frame_rounding) share = 0;
  for (const auto& [joint, track] : motion.tracks) {
    const double before = track.value_at(frame * motion.frame_s);
    values[joint] = share == 0 ? before : before + share * (track.value_at((frame + 1) * motion.frame_s) - before);
  }
}

void MotionPlayer::begin() {
  is_starting_ = false;
  approached_s_ = approach_s_ = 0;
  // Others may have commanded the joints; the approach begins where they are.
  group_->take_up();
  if (skips_approach_) return;
  const std::span<const double> present = group_->commanded();
  approach_from_.assign(present.begin(), present.end());
  values_at(tracks(), playhead_s_, first_);
  double furthest = 0;
  for (std::size_t i = 0; i < first_.size(); ++i)
    if (!std::isnan(first_[i])) furthest = std::max(furthest, std::abs(first_[i] - approach_from_[i]));
  // The soft start and end of the approach make its fastest moment faster than its mean; the limit holds for the
  // fastest.
  if (furthest > 0) approach_s_ = std::max(tracks().start.min_s, soft_peak * furthest / tracks().start.max_velocity);
}

void MotionPlayer::approach(const sim::ActContext& context) {
  if (is_starting_) begin();
  approached_s_ += context.step_s;
  if (approach_s_ <= 0 || approached_s_ >= approach_s_ + context.step_s * (1 - frame_rounding)) {
    phase_ = Phase::playing;
    return advance(context);
  }
  const double share = soft(std::min(1.0, approached_s_ / approach_s_));
  values_at(tracks(), playhead_s_, values_);
  for (std::size_t i = 0; i < values_.size(); ++i)
    values_[i] = approach_from_[i] + share * (values_[i] - approach_from_[i]);
  group_->command(values_, context.now, context.step_s);
}

void MotionPlayer::advance(const sim::ActContext& context) {
  const double rounding_s = tracks().frame_s * frame_rounding;
  double sounded_s = playhead_s_;
  playhead_s_ += rate_ * context.step_s;
  // Rounding does not add up.
  if (const double frame_s = tracks().frame_s;
      std::abs(playhead_s_ - std::round(playhead_s_ / frame_s) * frame_s) < rounding_s)
    playhead_s_ = std::round(playhead_s_ / frame_s) * frame_s;
  // At the end: repeat, or stop there.
  const double length_s = to_s_ - from_s_;
  while (playhead_s_ > to_s_ + rounding_s && repeats_left_ != 0 && length_s > rounding_s) {
    play_sounds(sounded_s, to_s_, true, context.now);
    sounded_s = from_s_;
    playhead_s_ -= length_s;
    if (repeats_left_ > 0) --repeats_left_;
  }
  const bool is_at_end = playhead_s_ >= to_s_ - rounding_s && repeats_left_ == 0;
  if (is_at_end) playhead_s_ = to_s_;
  play_sounds(sounded_s, playhead_s_, is_at_end, context.now);
  for (LightTrack& light : motions_[number_].lights) set_light(light);
  values_at(tracks(), playhead_s_, values_);
  group_->command(values_, context.now, context.step_s);
  if (!is_at_end && length_s > rounding_s) return;
  phase_ = Phase::idle;
  ++finished_;
}

void MotionPlayer::act(const sim::ActContext& context) {
  if (phase_ == Phase::idle || phase_ == Phase::paused) return;
  if (context.effectiveness <= 0 || vehicle_.systems().estopped) return stop();
  if (phase_ == Phase::approach)
    approach(context);
  else
    advance(context);
}

void MotionPlayer::visit_state(sim::StateArchive& archive) {
  archive(name_, phase_, phase_before_, playhead_s_, from_s_, to_s_, rate_, repeats_left_, is_starting_,
          skips_approach_, approach_s_, approached_s_, approach_from_, finished_);
  if (!archive.restoring()) return;
  const auto refuse_it = [&] { archive.fail("the snapshot has an invalid value: the state of a motion player"); };
  if (!approach_from_.empty() && approach_from_.size() != group_->servos().size()) refuse_it();
  if (name_.empty() && phase_ == Phase::idle) return;
  const auto found =
      std::find_if(motions_.begin(), motions_.end(), [&](const Tracks& one) { return one.name == name_; });
  if (found == motions_.end()) archive.fail("the snapshot has a motion that the player does not have");
  number_ = static_cast<std::size_t>(found - motions_.begin());
  archive.require(from_s_, 0, to_s_, "the part of a motion");
  archive.require(to_s_, from_s_, found->duration_s + found->frame_s, "the part of a motion");
  archive.require(playhead_s_, from_s_ - 1, to_s_ + 1, "the playhead of a motion");
  archive.require(rate_, 0.01, 10, "the rate of a motion");
  const bool is_approaching =
      phase_ == Phase::approach || (phase_ == Phase::paused && phase_before_ == Phase::approach);
  if (is_approaching && !is_starting_ && !skips_approach_ && approach_from_.empty()) refuse_it();
}

void MotionPlayerController::receive(sim::Time, std::span<const std::byte> payload) {
  const auto message = shoal::decode<shoal::motion_command_t>(payload, shoal::Finite::any);
  for (const double value : {message.from_s, message.to_s, message.rate})
    if (std::isinf(value)) throw std::runtime_error("'from_s', 'to_s' and 'rate' must be finite, or NaN");
  // NaN stands for a number that the sender leaves to the motion.
  const auto given = [](double value) { return std::isnan(value) ? std::nullopt : std::optional(value); };
  switch (message.command) {
    case 0:
      return player_.play({message.motion, given(message.from_s), given(message.to_s), given(message.rate),
                           message.repeat, message.skip_approach != 0});
    case 1:
      return player_.stop();
    case 2:
      return player_.pause();
    case 3:
      if (given(message.rate)) player_.set_rate(message.rate);
      return player_.resume();
    case 4:
      if (!given(message.from_s)) throw std::runtime_error("seek needs 'from_s'");
      return player_.seek(message.from_s);
    default:
      throw std::runtime_error("'command' must be 0 (play), 1 (stop), 2 (pause), 3 (resume) or 4 (seek), got " +
                               std::to_string(static_cast<int>(message.command)));
  }
}

bool fill(const MotionPlayer& player, shoal::motion_state_t& message) {
  message.motion = player.motion_name();
  message.phase = static_cast<std::int8_t>(player.phase());
  message.at_s = player.at_s();
  message.from_s = player.from_s();
  message.to_s = player.to_s();
  message.rate = player.rate();
  message.repeats_left = player.repeats_left();
  message.finished = player.finished();
  return true;
}

SHOAL_TRANSCEIVER("motion_player", MotionPlayer, shoal::motion_state_t, MotionPlayerController);

}  // namespace devices
