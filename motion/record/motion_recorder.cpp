// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/motion_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "devices/motion/joint_group.hpp"
#include "devices/motion/servo_bank.hpp"
#include "sim/config/message_text.hpp"
#include "sim/motion/motion_frames.hpp"

namespace motion {

namespace {

using devices::MotionPlayer;

constexpr double rounding = 1e-3;        // share of a step
constexpr double more_than_back_s = 1;   // frames for the snapshot before the earliest instant
constexpr std::int64_t tail_frames = 8;  // of the motion that replaces the live one at the end

/// Limits of the servos of a group, in its order.
std::vector<SetPoints::Limits> limits_of(const sim::VehicleConfig& vehicle, const std::vector<std::string>& names) {
  std::vector<SetPoints::Limits> limits;
  const std::vector<devices::ServoOfVehicle> servos = devices::servos_of(vehicle);
  for (const std::string& name : names)
    for (const devices::ServoOfVehicle& servo : servos)
      if (servo.device == name) limits.push_back({servo.low, servo.high, servo.params->max_velocity});
  return limits;
}

/// Names of the servos whose values are in m.
std::vector<std::string> sliders_of(const sim::VehicleConfig& vehicle, const std::vector<std::string>& names) {
  std::vector<std::string> sliders;
  for (const devices::ServoOfVehicle& servo : devices::servos_of(vehicle))
    for (const sim::JointConfig& joint : vehicle.joints)
      if (joint.name == servo.params->joint && !sim::joint_info(joint.type).turns &&
          std::find(names.begin(), names.end(), servo.device) != names.end())
        sliders.push_back(servo.device);
  return sliders;
}

/// Returns whether the keys of a motion mean the same when one is added at their end.
bool can_be_extended(const sim::JointMotion& motion) {
  if (!motion.frames.empty() || motion.ease == sim::Easing::spline) return false;
  return std::none_of(motion.keys.begin(), motion.keys.end(),
                      [](const sim::MotionKey& key) { return key.ease == sim::Easing::spline; });
}

void add_value(std::vector<sim::MotionKey>& keys, double at_s, const std::string& joint, double value) {
  auto key = std::lower_bound(keys.begin(), keys.end(), at_s,
                              [](const sim::MotionKey& one, double time_s) { return one.at_s < time_s; });
  if (key == keys.end() || key->at_s > at_s) {
    key = keys.insert(key, sim::MotionKey{});
    key->at_s = at_s;
  }
  key->joints.emplace_back(joint, value);
}

}  // namespace

MotionRecorder::MotionRecorder(RecordOptions options, const std::string& journal) : options_(std::move(options)) {
  options_.stage.kept_s = options_.back_s;
  if (options_.over) frame_s_ = options_.over->frame_s;
  stage_ = std::make_unique<MotionStage>(options_.stage, [this](MotionStage& stage) { return live_motion(stage); });
  // Settings that describe the recording.
  const sim::WorldConfig& world = stage_->world().config();
  settings_.world = world.name.empty() ? std::filesystem::path(options_.stage.world).stem().string() : world.name;
  settings_.vehicle = stage_->vehicle().name();
  settings_.model = stage_->vehicle().config().vehicle;
  settings_.seed = world.run.seed;
  settings_.set = options_.stage.load.sets;
  settings_.frame_s = frame_s_;
  std::vector<std::string> armed;
  for (const std::size_t joint : armed_) armed.push_back(over_[joint] ? over_[joint]->joint : names_[joint]);
  settings_.joints = armed;
  settings_.sliders = sliders_of(stage_->vehicle().config(), armed);
  settings_.over = options_.over.has_value();
  settings_.from_s = options_.from_s;
  settings_.to_s = options_.to_s;
  journal_.emplace(journal, settings_);
  // The first frame, to which its values hold, and the one after it.
  journal_->frame(recorded_values());
  recent_.push_back({0, recorded_values()});
  stage_->after_restore = [this](MotionPlayer& player) {
    const auto present = static_cast<std::int64_t>(std::floor(player.at_s() / frame_s_));
    for (const Frame& frame : recent_)
      if (frame.number > 0 && frame.number >= present) player.set_frame(frame.number, armed_, frame.values, 0x7fffffff);
  };
  frame(std::vector<double>(names_.size(), 0.0));
}

std::optional<std::size_t> MotionRecorder::find(const std::string& joint) {
  return stage_->player().group().servos().find(joint);
}

const devices::JointControls& MotionRecorder::controls() const {
  return std::as_const(*stage_).player().group().controls();
}

/// Returns `over` without the recorded joints, and these with their first values only; all hold until the end of time.
sim::JointMotion MotionRecorder::live_motion(MotionStage& stage) {
  devices::JointGroup& group = stage.player().group();
  names_ = group.names();
  if (!options_.over) frame_s_ = group.frame_s();
  over_.resize(names_.size());
  sim::JointMotion live;
  live.name = options_.name;
  live.frame_s = frame_s_;
  std::vector<sim::MotionTrack> lights;
  if (options_.over) {
    live = *options_.over;
    live.loop = false;
    live.changes.clear();
    live.recorded.reset();
    for (sim::MotionTrack& track : options_.over->tracks()) {
      if (live.is_light(track.joint)) {
        lights.push_back(std::move(track));
        continue;
      }
      const auto joint = group.servos().find(track.joint);
      if (!joint)
        throw sim::ConfigError({"motion '" + live.name + "' names joint '" + sim::printable(track.joint) +
                                "', which is not a servo of the group; known: " + sim::list_text(names_)});
      over_[*joint] = std::move(track);
    }
  }
  // Joints that are recorded.
  for (const std::string& joint : options_.joints) {
    const auto number = group.servos().find(joint);
    if (!number)
      throw sim::ConfigError({"joint '" + sim::shortened(sim::printable(joint)) + "' is not a servo of the group" +
                              sim::did_you_mean(joint, names_) + "; known: " + sim::list_text(names_)});
    if (std::find(armed_.begin(), armed_.end(), *number) == armed_.end()) armed_.push_back(*number);
  }
  if (options_.joints.empty())
    for (std::size_t i = 0; i < names_.size(); ++i) armed_.push_back(i);
  std::sort(armed_.begin(), armed_.end());
  check_part();
  const auto is_armed = [this](std::size_t joint) { return std::binary_search(armed_.begin(), armed_.end(), joint); };
  // Set points at the start.
  const sim::VehicleConfig& vehicle = stage.vehicle().config();
  set_points_.emplace(limits_of(vehicle, names_), group.limits(), frame_s_);
  for (std::size_t i = 0; i < names_.size(); ++i)
    set_points_->set(i, over_[i]
                            ? over_[i]->value_at(0)
                            : std::clamp(group.servos().set_point(i), group.servos().low(i), group.servos().high(i)));
  set_points_->limit(armed_);
  first_.assign(set_points_->values().begin(), set_points_->values().end());
  // Keys: those of the joints that play, the first values of the others, and a last key of all.
  if (!can_be_extended(live)) {
    live.keys.clear();
    live.ease = sim::Easing::linear;
    const auto add = [&](const sim::MotionTrack& track) {
      const std::vector<sim::MotionTrack> frames = sim::sampled({track}, options_.over->end_s(), frame_s_);
      for (const sim::TrackKey& key : frames.front().keys) add_value(live.keys, key.at_s, track.joint, key.value);
    };
    for (const auto& track : over_)
      if (track) add(*track);
    for (const sim::MotionTrack& track : lights) add(track);
    live.frames.clear();
    live.frames_file.clear();
  }
  for (sim::MotionKey& key : live.keys) {
    key.joints = live.values_of(key);
    key.pose.clear();
    std::erase_if(key.joints, [&](const auto& value) {
      const auto joint = group.servos().find(value.first);
      return joint && is_armed(*joint);
    });
  }
  live.poses.clear();
  std::erase_if(live.keys, [](const sim::MotionKey& key) { return key.joints.empty(); });
  sim::MotionKey last;
  last.at_s = sim::max_motion_s;
  last.ease = sim::Easing::step;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (!is_armed(i) && !over_[i]) continue;
    const std::string joint = over_[i] ? over_[i]->joint : names_[i];
    if (is_armed(i)) add_value(live.keys, 0, joint, set_points_->values()[i]);
    last.joints.emplace_back(joint, 0.0);
  }
  live.keys.push_back(std::move(last));
  return live;
}

void MotionRecorder::check_part() const {
  if (!options_.from_s && !options_.to_s) return;
  const double end_s = options_.over ? options_.over->end_s() : 0;
  const double from_s = options_.from_s.value_or(0), to_s = options_.to_s.value_or(end_s);
  // Without an end it may start where the motion ends.
  const double last_s = static_cast<double>(frames_over()) * frame_s_;
  const bool is_within = options_.to_s || options_.over->loop ? from_s < to_s && to_s <= end_s + rounding * frame_s_
                                                              : from_s <= last_s + rounding * frame_s_;
  if (from_s >= 0 && is_within) return;
  throw sim::ConfigError({"the part must lie within the motion, from 0 to " + sim::number_text(end_s) + " s, got " +
                          sim::number_text(from_s) + " to " + sim::number_text(to_s)});
}

std::vector<double> MotionRecorder::recorded_values() const {
  std::vector<double> values;
  for (const std::size_t joint : armed_) values.push_back(set_points_->values()[joint]);
  return values;
}

std::int64_t MotionRecorder::frames_over() const {
  return options_.over ? std::llround(std::ceil(options_.over->end_s() / frame_s_ - 1e-6)) : 0;
}

bool MotionRecorder::is_full() const {
  const bool ends_with_over = options_.over && (options_.over->loop || options_.to_s);
  const bool is_at_end = ends_with_over && frames_ + 1 >= frames_over();
  return is_at_end || frames_ + 2 >= static_cast<std::int64_t>(max_take_frames(armed_.size()));
}

bool MotionRecorder::is_recording() const {
  const double at_s = now_s() + frame_s_;
  const auto frame_at = [this](double time_s) { return std::round(time_s / frame_s_) * frame_s_; };
  if (options_.from_s && at_s < frame_at(*options_.from_s) + frame_s_ * (1 - rounding)) return false;
  return !options_.to_s || at_s < frame_at(*options_.to_s) - frame_s_ * rounding;
}

std::optional<SetPoints::Goal> MotionRecorder::goal(std::size_t joint, double at_s) const {
  if (options_.to_s && over_[joint]) {
    const double end_s = std::round(*options_.to_s / frame_s_) * frame_s_;
    return SetPoints::Goal{over_[joint]->value_at(end_s), end_s - at_s};
  }
  // A loop ends where it starts.
  if (!options_.over || !options_.over->loop) return std::nullopt;
  return SetPoints::Goal{first_[joint], static_cast<double>(frames_over()) * frame_s_ - at_s};
}

void MotionRecorder::add_frame(std::span<const double> velocities) {
  const bool records = is_recording();
  const double at_s = static_cast<double>(frames_ + 1) * frame_s_;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const bool is_armed = std::binary_search(armed_.begin(), armed_.end(), i);
    if (is_armed && records)
      set_points_->move(i, velocities[i], goal(i, at_s));
    else if (over_[i])
      set_points_->set(i, over_[i]->value_at(at_s));
  }
  if (records) set_points_->limit(armed_);
  ++frames_;
  // Written before it is played, so that a crash of the world loses no frame.
  journal_->frame(recorded_values());
  const auto kept = static_cast<std::int64_t>((options_.back_s + more_than_back_s) / frame_s_);
  stage_->player().set_frame(frames_, armed_, recorded_values(), kept);
  recent_.push_back({frames_, recorded_values()});
  while (static_cast<std::int64_t>(recent_.size()) > kept) recent_.pop_front();
}

void MotionRecorder::play_frame() {
  const double step_s = sim::to_seconds(stage_->world().step_time());
  const auto is_due = [&] {
    const MotionPlayer& player = stage_->player();
    const bool runs = player.phase() == MotionPlayer::Phase::approach || player.phase() == MotionPlayer::Phase::playing;
    return runs && player.at_s() + step_s <= now_s() + rounding * step_s;
  };
  while (is_due()) {
    stage_->go_to(stage_->now_s() + step_s);
    carry_out_changes();
  }
}

void MotionRecorder::carry_out_changes() {
  if (!options_.over) return;
  const std::vector<sim::MotionChange>& changes = options_.over->changes;
  for (; next_change_ < changes.size() && stage_->player().at_s() >= changes[next_change_].at_s - 1e-9; ++next_change_)
    stage_->run_action(changes[next_change_].action);
}

void MotionRecorder::frame(std::span<const double> velocities) {
  add_frame(velocities);
  play_frame();
}

void MotionRecorder::check_change(const sim::ConfigNode& action) const {
  for (const sim::MountedDevice* device : stage_->vehicle().devices()) {
    if (device->sensor() != &stage_->player() && device->sensor() != &stage_->player().group()) continue;
    const auto is_of_device = [&](const std::string& text) {
      return text == device->full_name() || text == device->command_channel();
    };
    if (sim::any_scalar(action, is_of_device))
      throw sim::ConfigError({"'" + device->full_name() + "' makes the recording, and cannot be changed by it"});
  }
}

void MotionRecorder::change(const sim::ConfigNode& action) {
  check_change(action);
  if (changes_ == max_take_changes)
    throw sim::ConfigError({"a recording has at most " + std::to_string(max_take_changes) + " changes of the world"});
  stage_->run_action(action);
  ++changes_;
  const double at_s = std::max(0.0, stage_->player().at_s());
  journal_->change(std::round(at_s * 1e9) / 1e9, action);  // at a step: the same after rounding
}

PushMargin MotionRecorder::push_margin() {
  PushOptions options;
  options.watch_s = 1;
  options.resolution_mps = 1.0 / 16;
  options.settle_mps = 0;
  return push_margins(*stage_, {stage_->now_s()}, options).front();
}

double MotionRecorder::back(double by_s) {
  const double step_s = sim::to_seconds(stage_->world().step_time());
  // Not before the first frame, the earliest snapshot and the frames that are known.
  const double earliest_s = std::max(stage_->earliest_s() - stage_->time_of(0), now_s() - options_.back_s);
  const std::int64_t earliest = std::max(
      {std::int64_t{1}, recent_.front().number + 1, static_cast<std::int64_t>(std::ceil(earliest_s / frame_s_))});
  const std::int64_t desired = frames_ - std::llround(by_s / frame_s_);
  const std::int64_t frame = std::clamp(desired, std::min(earliest, frames_), frames_);
  if (frame == frames_) return 0;
  const double went_s = static_cast<double>(frames_ - frame) * frame_s_;
  while (recent_.back().number > frame) recent_.pop_back();
  frames_ = frame;
  journal_->back(frame);
  stage_->go_to(std::floor(stage_->time_of(now_s()) / step_s + rounding) * step_s);
  stage_->cut();
  for (std::size_t i = 0; i < armed_.size(); ++i) set_points_->set(armed_[i], recent_.back().values[i]);
  if (options_.over) {
    const std::vector<sim::MotionChange>& changes = options_.over->changes;
    while (next_change_ > 0 && changes[next_change_ - 1].at_s > stage_->player().at_s() + 1e-9) --next_change_;
  }
  return went_s;
}

/// The last frames of all joints: they are the same as those of the live motion, and the motion ends with them.
sim::JointMotion MotionRecorder::tail() const {
  sim::JointMotion motion;
  motion.name = options_.over ? options_.over->name : options_.name;
  motion.frame_s = frame_s_;
  if (options_.over) motion.start = options_.over->start;
  for (const Frame& frame : recent_) {
    if (frame.number < frames_ - tail_frames) continue;
    const double at_s = static_cast<double>(frame.number) * frame_s_;
    sim::MotionKey& key = motion.keys.emplace_back();
    key.at_s = at_s;
    for (std::size_t i = 0; i < armed_.size(); ++i) {
      const auto& track = over_[armed_[i]];
      key.joints.emplace_back(track ? track->joint : names_[armed_[i]], frame.values[i]);
    }
    for (std::size_t i = 0; i < names_.size(); ++i)
      if (over_[i] && !std::binary_search(armed_.begin(), armed_.end(), i))
        key.joints.emplace_back(over_[i]->joint, over_[i]->value_at(at_s));
  }
  return motion;
}

std::uint64_t MotionRecorder::finish() {
  const std::vector<double> rest(names_.size(), 0.0);
  while (frames_ + 1 < frames_over()) frame(rest);
  add_frame(rest);
  stage_->change_motion(tail());
  play_frame();
  // The end may lie within a step.
  if (stage_->player().phase() == MotionPlayer::Phase::playing) {
    stage_->go_to(stage_->now_s() + sim::to_seconds(stage_->world().step_time()));
    carry_out_changes();
  }
  return stage_->state_hash();
}

}  // namespace motion
