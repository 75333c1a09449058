// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/motion_stage.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "messages/yaml/message_writer.hpp"
#include "sim/config/message_text.hpp"
#include "sim/motion/motion_frames.hpp"
#include "sim/state/state_archive.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"

namespace motion {

namespace {

/// Returns the motion with its frames as keys, which need no other file.
sim::JointMotion in_one_piece(const sim::JointMotion& motion) {
  sim::JointMotion whole = motion;
  whole.frames.clear();
  whole.frames_file.clear();
  whole.keys.clear();
  if (motion.frames.empty()) {
    whole.keys = motion.keys;
    return whole;
  }
  std::map<double, sim::JointValues> by_time;
  for (const sim::MotionTrack& track : sim::sampled(motion.tracks(), motion.end_s(), motion.frame_s))
    for (const sim::TrackKey& key : track.keys) by_time[key.at_s].emplace_back(track.joint, key.value);
  whole.ease = sim::Easing::linear;
  for (auto& [at_s, values] : by_time) whole.keys.emplace_back().at_s = at_s, whole.keys.back().joints = values;
  return whole;
}

}  // namespace

double end_limit_s(const sim::JointMotion& motion) {
  // A joint that turns by a whole turn at the least velocity of an approach, 0.001 rad/s, takes 9425 s.
  constexpr double max_approach_s = 10'000;
  return max_approach_s + motion.end_s();
}

sim::ConfigNode node_of(const sim::JointMotion& motion) {
  sim::JointMotion exact = in_one_piece(motion);
  exact.angles = sim::AngleUnit::rad;
  if (exact.recorded) exact.recorded->embedded_world = {};
  sim::Diagnostics diagnostics;
  sim::ConfigNode node = sim::parse_config_text(sim::motion_text(exact), "motion " + motion.name, diagnostics);
  diagnostics.throw_if_any();
  std::erase_if(node.entries, [](const auto& entry) { return entry.key == "shoal"; });
  return node;
}

MotionStage::MotionStage(const StageOptions& options, const sim::JointMotion& motion)
    : MotionStage(options, [&](MotionStage&) { return motion; }) {}

MotionStage::MotionStage(const StageOptions& options, const std::function<sim::JointMotion(MotionStage&)>& make_motion)
    : options_(options) {
  sim::LoadOptions load = options.load;
  load.encode_message = shoal::encode_own_message;
  loaded_ =
      options.tree ? sim::load_world_tree(*options.tree, options.world, load) : sim::load_world(options.world, load);
  world_ = std::make_unique<sim::StandaloneWorld>(loaded_.config);
  if (options.scores) scoring_ = std::make_unique<experiment::Scoring>(*world_);
  // Find the player.
  for (const auto& vehicle : world_->vehicles())
    for (const sim::MountedDevice* device : vehicle->devices()) {
      if (dynamic_cast<const devices::MotionPlayer*>(device->sensor()) == nullptr) continue;
      if (!options.vehicle.empty() && vehicle->name() != options.vehicle) continue;
      if (!vehicle_.empty() && vehicle_ != vehicle->name())
        throw sim::ConfigError({options.world + ": several vehicles have a motion_player: name one with --vehicle"});
      if (!vehicle_.empty()) continue;
      vehicle_ = vehicle->name();
      player_ = vehicle_ + "/" + device->config().name;
    }
  if (player_.empty())
    throw sim::ConfigError(
        {options.world + ": " +
         (options.vehicle.empty() ? "no vehicle has a motion_player"
                                  : "there is no vehicle '" + options.vehicle + "' with a motion_player")});
  const sim::JointMotion motion = make_motion(*this);
  due_ = motion.changes;
  std::stable_sort(due_.begin(), due_.end(), [](const auto& a, const auto& b) { return a.at_s < b.at_s; });
  // Play the motion from the start.
  set_motion(*world_, motion);
  devices::MotionPlayer::Play play = options.play;
  play.motion = motion.name;
  player().play(play);
  snapshots_[0] = save();
}

MotionStage::~MotionStage() = default;

const sim::Vehicle& MotionStage::vehicle() const {
  const sim::Vehicle* vehicle = world_->find_vehicle(vehicle_);
  if (vehicle == nullptr) throw std::runtime_error("vehicle '" + vehicle_ + "' is no longer in the world");
  return *vehicle;
}

const devices::MotionPlayer& MotionStage::player() const {
  return player_in(*world_);
}

devices::MotionPlayer& MotionStage::player_in(sim::World& world) const {
  const auto& player = dynamic_cast<const devices::MotionPlayer&>(*world.find_device(player_)->sensor());
  return const_cast<devices::MotionPlayer&>(player);
}

std::optional<experiment::Support> MotionStage::support() {
  if (watched_generation_ == world_->generation()) return experiment::support_of(*world_, vehicle());
  watched_generation_ = world_->generation();
  world_->physics().watch_contacts(vehicle().group());
  return std::nullopt;
}

MotionStage::Saved MotionStage::save() {
  Saved saved{world_->state().snapshot(), {}};
  if (!scoring_) return saved;
  auto archive = sim::StateArchive::saver();
  scoring_->visit_state(archive, experiment::History::length);
  archive.end();
  saved.scores = archive.take_bytes();
  return saved;
}

void MotionStage::restore(const Saved& saved) {
  world_->state().restore(saved.world);
  watched_generation_.reset();
  if (after_restore) after_restore(player());
  if (!scoring_) return;
  auto archive = sim::StateArchive::restorer(saved.scores);
  scoring_->visit_state(archive, experiment::History::length);
  archive.end();
}

void MotionStage::restore(sim::World& copy, const sim::Bytes& snapshot) const {
  copy.state().restore(snapshot);
  if (after_restore) after_restore(player_in(copy));
}

std::uint64_t MotionStage::state_hash() const {
  return world_->state().hash();
}

double MotionStage::now_s() const {
  return sim::to_seconds(world_->now());
}

double MotionStage::time_of(double motion_s) const {
  if (started_s_) return *started_s_ + motion_s / player().rate();
  // Before the start, the time of the player is the rest of the approach, negative.
  return (motion_s - player().from_s()) / player().rate() - player().at_s() + now_s();
}

void MotionStage::set_motion(sim::World& world, const sim::JointMotion& motion) const {
  sim::ConfigNode values;
  values.kind = sim::ConfigNode::Kind::map;
  sim::ConfigNode list;
  list.kind = sim::ConfigNode::Kind::list;
  list.items.push_back(node_of(motion));
  values.entries.push_back({"motions", {}, std::move(list)});
  sim::Diagnostics diagnostics;
  world.editor().change_device(player_, values, diagnostics);
  diagnostics.throw_if_any();
}

void MotionStage::apply(sim::World& world, const Change& change) const {
  if (change.action.kind == sim::ConfigNode::Kind::null)
    set_motion(world, change.motion);
  else
    world.editor().run_action(change.action);
}

void MotionStage::apply_changes(sim::World& world) const {
  for (const Change& change : changes_)
    if (change.step == world.step_number()) apply(world, change);
}

void MotionStage::cut() {
  const std::int64_t step = world_->step_number();
  if (furthest_step_ > step) {
    branches_.push_back(
        {now_s(), static_cast<double>(furthest_step_) * sim::to_seconds(world_->step_time()), furthest_hash_});
    snapshots_.erase(snapshots_.upper_bound(step), snapshots_.end());
    std::erase_if(changes_, [step](const Change& one) { return one.step > step; });
  }
  if (started_s_ && now_s() < *started_s_) started_s_.reset();
  furthest_step_ = step;
}

void MotionStage::start_branch(Change change) {
  const std::int64_t step = change.step;
  cut();
  const Saved before = save();
  try {
    apply(*world_, change);
    if (world_->find_vehicle(vehicle_) == nullptr)
      throw sim::ConfigError({"vehicle '" + vehicle_ + "' has the motion, and cannot be removed"});
  } catch (const std::runtime_error&) {
    restore(before);
    throw;
  }
  changes_.push_back(std::move(change));
  snapshots_[step] = save();  // it holds the change
}

void MotionStage::change_motion(const sim::JointMotion& motion) {
  start_branch({world_->step_number(), {}, motion});
}

void MotionStage::run_action(const sim::ConfigNode& action) {
  start_branch({world_->step_number(), action, {}});
}

void MotionStage::step() {
  const bool was_there = world_->step_number() < furthest_step_;
  world_->step();
  if (scoring_) scoring_->after_step();
  const std::int64_t step = world_->step_number();
  // Changes of the branch that the snapshot from which it was restored does not hold.
  if (was_there) apply_changes(*world_);
  const auto period =
      std::max<std::int64_t>(1, std::llround(options_.snapshot_s / sim::to_seconds(world_->step_time())));
  if (step % period == 0 && !snapshots_.contains(step)) {
    snapshots_[step] = save();
    drop_old_snapshots();
  }
  furthest_step_ = std::max(furthest_step_, step);
  if (!started_s_ && player().phase() == devices::MotionPlayer::Phase::playing)
    started_s_ = now_s() - player().at_s() / player().rate();
  if (after_step) after_step(*this);
}

void MotionStage::drop_old_snapshots() {
  if (std::isinf(options_.kept_s)) return;
  // The last one before the earliest time stays.
  const auto earliest = world_->step_number() - std::llround(options_.kept_s / sim::to_seconds(world_->step_time()));
  while (snapshots_.size() > 1 && std::next(snapshots_.begin())->first <= earliest)
    snapshots_.erase(snapshots_.begin());
}

double MotionStage::earliest_s() const {
  return static_cast<double>(snapshots_.begin()->first) * sim::to_seconds(world_->step_time());
}

void MotionStage::go_to(double at_s) {
  const auto desired = std::max<std::int64_t>(0, std::llround(at_s / sim::to_seconds(world_->step_time())));
  if (desired < world_->step_number()) {
    if (world_->step_number() == furthest_step_) furthest_hash_ = state_hash();
    const auto later = snapshots_.upper_bound(desired);
    if (later == snapshots_.begin())
      throw std::runtime_error("the earliest snapshot is at " + sim::number_text(earliest_s()) + " s");
    restore(std::prev(later)->second);
  }
  while (world_->step_number() < desired) step();
}

void MotionStage::play_step() {
  step();
  // The approach is planned in the first step.
  while (!due_.empty() && player().at_s() >= due_.front().at_s - 1e-9) {
    const sim::MotionChange change = due_.front();
    due_.erase(due_.begin());
    run_action(change.action);
  }
}

bool MotionStage::play_out(double settle_s, double max_s) {
  while (player().phase() != devices::MotionPlayer::Phase::idle && now_s() < max_s) play_step();
  const double end_s = std::min(now_s() + settle_s, max_s);
  while (now_s() < end_s - 1e-9) step();
  return player().phase() == devices::MotionPlayer::Phase::idle;
}

}  // namespace motion
