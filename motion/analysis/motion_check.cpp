// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/motion_check.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>

#include "devices/motion/joint_group.hpp"
#include "devices/motion/servo_bank.hpp"
#include "devices/signals/led.hpp"
#include "devices/signals/speaker.hpp"
#include "motion/analysis/motion_edit.hpp"
#include "sim/config/message_text.hpp"
#include "sim/motion/motion_frames.hpp"

namespace motion {

namespace {

constexpr double rounding = 1e-9;
constexpr double position_rounding = 1e-5;  // rad or m: limits in vehicle files have five decimals

/// Servo of a track, with its limits.
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  double velocity = std::numeric_limits<double>::infinity();
  double acceleration = std::numeric_limits<double>::infinity();
};

/// The servos of a vehicle file by name and alias.
class Servos {
 public:
  explicit Servos(const sim::VehicleConfig& vehicle) : all_(devices::servos_of(vehicle)) {}

  std::optional<std::size_t> find(const std::string& joint) const {
    for (std::size_t i = 0; i < all_.size(); ++i)
      if (all_[i].is_called(joint)) return i;
    return std::nullopt;
  }
  std::size_t size() const { return all_.size(); }
  const std::string& name(std::size_t i) const { return all_[i].device; }

  /// Position of a joint that a motion does not name, rad or m.
  double at_rest(std::size_t i) const { return std::clamp(0.0, all_[i].low, all_[i].high); }

  Limits limits(std::size_t i) const {
    const devices::ServoOfVehicle& servo = all_[i];
    Limits limits{servo.low, servo.high};
    limits.velocity = servo.params->max_velocity;
    limits.acceleration = servo.params->max_acceleration.value_or(limits.acceleration);
    return limits;
  }

 private:
  std::vector<devices::ServoOfVehicle> all_;
};

/// Keeps the worst of each stretch of frames that break a rule.
class Stretch {
 public:
  Stretch(MotionRule rule, std::string joint, std::vector<MotionFinding>& findings)
      : rule_(rule), joint_(std::move(joint)), findings_(findings) {}

  /// `excess`: value beyond the limit; <= 0: within.
  void add(double at_s, double value, double limit, double excess) {
    const bool is_rate = rule_ == MotionRule::velocity || rule_ == MotionRule::acceleration;
    if (excess <= (is_rate ? rounding : position_rounding)) {
      number_.reset();
      return;
    }
    if (!number_) {
      number_ = findings_.size();
      findings_.push_back({rule_, joint_, at_s, 0, value, limit});
      worst_ = excess;
    } else if (excess > worst_) {
      worst_ = excess;
      findings_[*number_] = {rule_, joint_, at_s, 0, value, limit};
    }
  }

 private:
  MotionRule rule_;
  std::string joint_;
  std::vector<MotionFinding>& findings_;
  std::optional<std::size_t> number_;
  double worst_ = 0;
};

void check_track(const sim::MotionTrack& frames, const Limits& limits, double frame_s,
                 std::vector<MotionFinding>& findings) {
  const auto stretch = [&](MotionRule rule) { return Stretch(rule, frames.joint, findings); };
  Stretch low = stretch(MotionRule::low), high = stretch(MotionRule::high);
  Stretch velocity = stretch(MotionRule::velocity), acceleration = stretch(MotionRule::acceleration);
  double velocity_before = 0;
  for (std::size_t i = 0; i < frames.keys.size(); ++i) {
    const auto& [at_s, value, ease] = frames.keys[i];
    low.add(at_s, value, limits.low, limits.low - value);
    high.add(at_s, value, limits.high, value - limits.high);
    if (i == 0) continue;
    const double per_s = (value - frames.keys[i - 1].value) / frame_s;
    // Rounding of set points must not break a limit.
    velocity.add(at_s, per_s, limits.velocity, std::abs(per_s) - limits.velocity * (1 + 1e-6));
    const double per_s2 = (per_s - velocity_before) / frame_s;
    acceleration.add(at_s, per_s2, limits.acceleration, std::abs(per_s2) - limits.acceleration * (1 + 1e-6));
    velocity_before = per_s;
  }
}

void check_two_joints(const std::vector<sim::MotionTrack>& frames, const std::vector<std::size_t>& servo_of,
                      const Servos& servos, const devices::JointGroup::Params& group,
                      std::vector<MotionFinding>& findings) {
  const devices::JointLimitTable table(group.limits, [&](const std::string& name) { return servos.find(name); });
  std::vector<Stretch> low, high;
  for (std::size_t i = 0; i < servos.size(); ++i) {
    low.emplace_back(MotionRule::two_joint_low, servos.name(i), findings);
    high.emplace_back(MotionRule::two_joint_high, servos.name(i), findings);
  }
  // A limit may depend on a joint that the motion does not move, which stays at rest.
  std::vector<double> positions;
  for (std::size_t i = 0; i < servos.size(); ++i) positions.push_back(servos.at_rest(i));
  for (std::size_t frame = 0; frame < frames.front().keys.size(); ++frame) {
    for (std::size_t i = 0; i < frames.size(); ++i) positions[servo_of[i]] = frames[i].keys[frame].value;
    for (std::size_t i = 0; i < servos.size(); ++i) {
      const auto range = table.range_of(i, positions);
      const double at_s = frames.front().keys[frame].at_s;
      low[i].add(at_s, positions[i], range.low.value_or(0), range.low ? *range.low - positions[i] : 0);
      high[i].add(at_s, positions[i], range.high.value_or(0), range.high ? positions[i] - *range.high : 0);
    }
  }
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void check_light(const sim::MotionTrack& track, std::vector<MotionFinding>& findings) {
  Stretch range(MotionRule::light_range, track.joint, findings);
  for (const sim::TrackKey& key : track.keys) {
    const double limit = std::clamp(key.value, 0.0, 1.0);
    range.add(key.at_s, key.value, limit, std::abs(key.value - limit));
  }
}

void check_sounds(const sim::JointMotion& motion, const sim::VehicleConfig& vehicle,
                  std::vector<MotionFinding>& findings) {
  const std::vector<std::string> known = devices::sounds_of(vehicle);
  const double end_s = motion.end_s();
  for (const sim::MotionSound& sound : motion.sounds) {
    if (!has(known, sound.sound)) findings.push_back({MotionRule::unknown_sound, sound.sound, sound.at_s});
    if (sound.at_s > end_s + rounding)
      findings.push_back({MotionRule::late_sound, sound.sound, sound.at_s, 0, sound.at_s, end_s});
  }
}

std::string shown(double value, bool is_angle) {
  return is_angle ? fmt::format("{:.2f} deg", value * 180 / std::numbers::pi) : fmt::format("{:.4g}", value);
}

}  // namespace

std::string MotionFinding::text() const {
  const std::string who = "joint '" + joint + "'" + (key > 0 ? " after key " + std::to_string(key) : "") +
                          fmt::format(" at {:.3f} s: ", at_s);
  const std::string is = shown(value, true), may_be = shown(limit, true);
  switch (rule) {
    case MotionRule::unknown_joint:
      return "joint '" + joint + "': the vehicle has no servo of this name or alias";
    case MotionRule::unknown_light:
      return "light '" + joint + "': no led of the vehicle has a light of this name";
    case MotionRule::unknown_sound:
      return "sound '" + joint + "'" + fmt::format(" at {:.3f} s: ", at_s) +
             "no speaker of the vehicle has a sound of this name";
    case MotionRule::late_sound:
      return "sound '" + joint + "'" +
             fmt::format(" at {:.3f} s is never played: the motion ends at {:.3f} s", at_s, limit);
    case MotionRule::light_range:
      return "light '" + joint + "'" + fmt::format(" at {:.3f} s: ", at_s) + shown(value, false) +
             " is not within 0 to 1";
    case MotionRule::low:
      return who + is + " is below its lower limit, " + may_be;
    case MotionRule::high:
      return who + is + " is above its upper limit, " + may_be;
    case MotionRule::two_joint_low:
      return who + is + " is below its lower limit at this position of another joint, " + may_be;
    case MotionRule::two_joint_high:
      return who + is + " is above its upper limit at this position of another joint, " + may_be;
    case MotionRule::velocity:
      return who + is + "/s is faster than its servo, " + may_be + "/s";
    case MotionRule::acceleration:
      return who + is + "/s^2 is more than its servo accelerates, " + may_be + "/s^2";
    case MotionRule::loop_seam:
      break;
  }
  return who + "the loop ends at " + is + " and starts at " + may_be;
}

std::vector<MotionFinding> check_motion(const sim::JointMotion& motion, const sim::VehicleConfig& vehicle) {
  std::vector<MotionFinding> findings;
  const Servos servos(vehicle);
  const std::vector<std::string> lights = devices::lights_of(vehicle);
  for (const std::string& light : motion.lights)  // also those that no key has
    if (!has(lights, light)) findings.push_back({MotionRule::unknown_light, light});
  check_sounds(motion, vehicle, findings);
  // Sample the joints that the vehicle has.
  std::vector<sim::MotionTrack> tracks;
  std::vector<std::size_t> servo_of;
  for (sim::MotionTrack& track : motion.tracks()) {
    const auto servo = servos.find(track.joint);
    if (motion.is_light(track.joint)) {
      check_light(track, findings);
    } else if (servo) {
      tracks.push_back(std::move(track));
      servo_of.push_back(*servo);
    } else {
      findings.push_back({MotionRule::unknown_joint, track.joint});
    }
  }
  if (tracks.empty()) return findings;
  const double end_s = std::ceil(motion.end_s() / motion.frame_s - 1e-6) * motion.frame_s;
  const std::vector<sim::MotionTrack> frames = sim::sampled(tracks, end_s, motion.frame_s);
  // Check each joint, then each pair.
  for (std::size_t i = 0; i < frames.size(); ++i) {
    check_track(frames[i], servos.limits(servo_of[i]), motion.frame_s, findings);
    const double first = frames[i].keys.front().value, last = frames[i].keys.back().value;
    if (motion.loop && std::abs(last - first) > 1e-3)
      findings.push_back({MotionRule::loop_seam, frames[i].joint, end_s, 0, last, first});
  }
  for (const sim::DeviceConfig& device : vehicle.devices)
    if (const auto* group =
            dynamic_cast<const sim::detail::ParamsOf<devices::JointGroup::Params>*>(device.params.get()))
      check_two_joints(frames, servo_of, servos, group->params, findings);
  for (MotionFinding& finding : findings)
    for (const sim::MotionKey& key : motion.keys)
      if (key.at_s <= finding.at_s + 1e-9 && finding.rule != MotionRule::unknown_joint) ++finding.key;
  return findings;
}

sim::JointMotion mended(const sim::JointMotion& motion, const sim::VehicleConfig& vehicle) {
  const Servos servos(vehicle);
  std::vector<sim::MotionTrack> tracks = motion.tracks();
  std::vector<double> times{0};
  const auto limits_of = [&](const sim::MotionTrack& track) {
    const auto servo = servos.find(track.joint);
    return motion.is_light(track.joint) ? Limits{0, 1} : servo ? servos.limits(*servo) : Limits{};
  };
  // Clamp the values.
  for (sim::MotionTrack& track : tracks) {
    const Limits limits = limits_of(track);
    for (sim::TrackKey& key : track.keys) {
      key.value = std::clamp(key.value, limits.low, limits.high);
      times.push_back(key.at_s);
    }
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  // Stretch each segment by its fastest joint.
  std::vector<double> moved{times.front()};
  for (std::size_t i = 1; i < times.size(); ++i) {
    double factor = 1;
    for (const sim::MotionTrack& track : tracks) {
      const double step_s = std::min(motion.frame_s, times[i] - times[i - 1]);
      double fastest = 0;
      for (double t_s = times[i - 1]; t_s < times[i] - 1e-9; t_s += step_s)
        fastest = std::max(fastest, std::abs(track.value_at(t_s + step_s) - track.value_at(t_s)) / step_s);
      factor = std::max(factor, fastest / limits_of(track).velocity);
    }
    // Whole frames, so that no frame is faster than the segment.
    const double needed_s = factor > 1
                                ? std::ceil((times[i] - times[i - 1]) * factor / motion.frame_s - 1e-6) * motion.frame_s
                                : times[i] - times[i - 1];
    moved.push_back(moved.back() + needed_s);
  }
  const auto new_time = [&](double t_s) {
    const auto after = std::lower_bound(times.begin(), times.end(), t_s - 1e-9);
    return moved[static_cast<std::size_t>(std::min(after, times.end() - 1) - times.begin())];
  };
  for (sim::MotionTrack& track : tracks)
    for (sim::TrackKey& key : track.keys) key.at_s = new_time(key.at_s);
  return with_tracks(motion, std::move(tracks), new_time);
}

}  // namespace motion
