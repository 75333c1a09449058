// SPDX-License-Identifier: BSD-3-Clause
#include "verification/motions/push_prediction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "devices/motion/servo_bank.hpp"
#include "motion/analysis/motion_check.hpp"
#include "motion/analysis/motion_tracking.hpp"

namespace verification {
namespace {

constexpr double longest_play_s = 600;
constexpr double two_pi = 2 * std::numbers::pi;
constexpr double hold_s = 0.5;               // of a held pose
constexpr double fallen_displacement_m = 1;  // displacement of a pose that falls

/// Plays a motion to its end and some time more.  Returns whether it has fallen.
bool falls_by_itself(motion::MotionStage& stage, double watch_s) {
  motion::MotionTracking tracking;
  bool touched = false;
  stage.world().physics().watch_contacts(stage.vehicle().group());
  stage.after_step = [&](motion::MotionStage& now) {
    tracking.add(now);
    touched = touched || motion::first_body_touches(now.world(), now.vehicle());
  };
  stage.play_out(watch_s, longest_play_s);
  stage.after_step = {};
  stage.world().physics().unwatch_contacts(stage.vehicle().group());
  return tracking.has_fallen() || touched;
}

/// Returns the pose of a motion at a time as a motion.
sim::JointMotion held_pose(const sim::JointMotion& motion, double at_s) {
  sim::JointMotion held;
  held.name = "held";
  sim::MotionKey& key = held.keys.emplace_back();
  for (const sim::MotionTrack& track : motion.tracks()) key.joints.emplace_back(track.joint, track.value_at(at_s));
  return held;
}

/// Returns the largest displacement after a push of a pose that is held, over all directions, m.
double static_displacement_m(const motion::StageOptions& options, const sim::JointMotion& pose,
                             const motion::PushOptions& push) {
  motion::MotionStage stage(options, pose);
  if (falls_by_itself(stage, hold_s)) return fallen_displacement_m;
  // The first push is none, for comparison.
  std::vector<motion::Push> pushes(1, {stage.now_s(), 0, 0});
  for (int i = 0; i < push.directions; ++i)
    pushes.push_back({stage.now_s(), two_pi * i / push.directions, push.settle_mps});
  const std::vector<motion::PushOutcome> outcomes = motion::outcomes_of(stage, pushes, push);
  double greatest_m = 0;
  for (const motion::PushOutcome& outcome : outcomes)
    greatest_m = std::max(greatest_m, outcome.fell ? fallen_displacement_m : outcome.distance_m(outcomes.front()));
  return greatest_m;
}

/// Draws the pushes of a motion between two times of the run, by time.
std::vector<motion::Push> drawn_pushes(const PredictionOptions& options, double from_s, sim::Random& random) {
  // Within the chord of two directions that both withstand the largest push.
  const double greatest_mps = options.push.greatest_mps * std::cos(std::numbers::pi / options.push.directions);
  std::vector<motion::Push> pushes(static_cast<std::size_t>(options.pushes));
  for (motion::Push& push : pushes) {
    push.at_s = from_s + options.row_s * random.uniform();
    push.direction_rad = two_pi * random.uniform();
    push.mps = greatest_mps * random.uniform();
  }
  std::sort(pushes.begin(), pushes.end(), [](const motion::Push& a, const motion::Push& b) { return a.at_s < b.at_s; });
  return pushes;
}

/// Adds the trials of a motion.  Returns false when it falls by itself.
bool add_trials(const motion::StageOptions& stage_options, const sim::JointMotion& motion,
                const PredictionOptions& options, int number, sim::Random& random, std::vector<PushTrial>& trials) {
  motion::MotionStage stage(stage_options, motion);
  if (falls_by_itself(stage, options.push.watch_s)) return false;
  const double motion_s = random.uniform() * std::max(0.0, motion.end_s() - options.row_s);
  const double from_s = stage.time_of(motion_s);
  const std::vector<motion::PushMargin> margins =
      motion::push_margins(stage, {from_s, from_s + options.row_s}, options.push);
  const std::vector<motion::Push> pushes = drawn_pushes(options, from_s, random);
  const std::vector<motion::PushOutcome> outcomes = motion::outcomes_of(stage, pushes, options.push);
  const double displacement_m = static_displacement_m(stage_options, held_pose(motion, motion_s), options.push);
  for (std::size_t i = 0; i < pushes.size(); ++i) {
    const double share = (pushes[i].at_s - from_s) / options.row_s;
    const double withstood_mps = (1 - share) * margin_at(margins[0], pushes[i].direction_rad) +
                                 share * margin_at(margins[1], pushes[i].direction_rad);
    trials.push_back({number, pushes[i], outcomes[i].fell, withstood_mps, displacement_m});
  }
  return true;
}

}  // namespace

double margin_at(const motion::PushMargin& margin, double direction_rad) {
  const std::size_t count = margin.withstood_mps.size();
  const double sector_rad = two_pi / static_cast<double>(count);
  const double turned_rad = direction_rad - two_pi * std::floor(direction_rad / two_pi);
  const std::size_t before = std::min(static_cast<std::size_t>(turned_rad / sector_rad), count - 1);
  const double a_mps = margin.withstood_mps[before], b_mps = margin.withstood_mps[(before + 1) % count];
  // Fewer than three directions enclose nothing.
  if (count < 3 || a_mps <= 0 || b_mps <= 0) return std::min(a_mps, b_mps);
  // The line through both points, in polar coordinates.
  const double from_a_rad = turned_rad - static_cast<double>(before) * sector_rad;
  return std::sin(sector_rad) / (std::sin(sector_rad - from_a_rad) / a_mps + std::sin(from_a_rad) / b_mps);
}

PushTrials push_trials(const motion::StageOptions& stage, const sim::VehicleConfig& vehicle,
                       const std::vector<sim::MotionPose>& poses, const PredictionOptions& options) {
  PushTrials result;
  sim::Random random(options.seed, "push_prediction");
  for (int number = 1, draw = 0; number <= options.motions; ++draw) {
    random.begin_step(draw);
    const sim::JointMotion motion = random_motion(poses, vehicle, options.motion, random);
    if (add_trials(stage, motion, options, number, random, result.trials))
      ++number;
    else
      ++result.refused_motions;
  }
  return result;
}

Detection detection_by_margin(const std::vector<PushTrial>& trials) {
  Detection result;
  for (const PushTrial& trial : trials) {
    const bool predicted = trial.push.mps > trial.withstood_mps;
    ++(predicted ? (trial.fell ? result.found : result.false_alarms)
                 : (trial.fell ? result.missed : result.right_passes));
  }
  return result;
}

Detection detection_by_static_check(const std::vector<PushTrial>& trials, bool by_push) {
  // Each score is the threshold once, from the largest down.
  std::vector<std::pair<double, bool>> scores;
  Detection now;
  for (const PushTrial& trial : trials) {
    scores.emplace_back(trial.static_displacement_m * (by_push ? trial.push.mps : 1), trial.fell);
    ++(trial.fell ? now.missed : now.right_passes);
  }
  std::sort(scores.begin(), scores.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  Detection best = now;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (scores[i].second)
      ++now.found, --now.missed;
    else
      ++now.false_alarms, --now.right_passes;
    const bool is_last_of_its_score = i + 1 == scores.size() || scores[i + 1].first < scores[i].first;
    if (is_last_of_its_score && now.f1() > best.f1()) best = now;
  }
  return best;
}

namespace {

double drawn_between(double low, double high, sim::Random& random) {
  return low + (high - low) * random.uniform();
}

/// Returns the servos that no pose names.
std::vector<devices::ServoOfVehicle> free_servos(const std::vector<sim::MotionPose>& poses,
                                                 const sim::VehicleConfig& vehicle) {
  std::vector<devices::ServoOfVehicle> servos = devices::servos_of(vehicle);
  std::erase_if(servos, [&](const devices::ServoOfVehicle& servo) {
    return !std::isfinite(servo.low) || !std::isfinite(servo.high) ||
           std::any_of(poses.begin(), poses.end(), [&](const sim::MotionPose& pose) {
             return std::any_of(pose.joints.begin(), pose.joints.end(),
                                [&](const auto& joint) { return servo.is_called(joint.first); });
           });
  });
  return servos;
}

}  // namespace

sim::JointMotion random_motion(const std::vector<sim::MotionPose>& poses, const sim::VehicleConfig& vehicle,
                               const RandomMotionOptions& options, sim::Random& random) {
  const std::vector<devices::ServoOfVehicle> others = free_servos(poses, vehicle);
  sim::JointMotion motion;
  motion.name = "random";
  motion.vehicle = vehicle.vehicle;
  motion.ease = sim::Easing::smooth;
  double at_s = 0;
  for (int i = 0; i < options.keys; ++i) {
    sim::MotionKey& key = motion.keys.emplace_back();
    key.at_s = at_s;
    at_s += drawn_between(options.least_key_s, options.greatest_key_s, random);
    // The first key is a pose in which the vehicle stands, so that every fall is due to the motion.
    const double offset = i == 0 ? 0 : options.offset;
    for (const auto& [joint, value] : poses[random.integer_below(static_cast<std::uint32_t>(poses.size()))].joints)
      key.joints.emplace_back(joint, drawn_between(value - offset, value + offset, random));
    for (const devices::ServoOfVehicle& servo : others)
      key.joints.emplace_back(servo.device, drawn_between(servo.low, servo.high, random));
  }
  return motion::mended(motion, vehicle);
}

}  // namespace verification
