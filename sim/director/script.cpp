// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/script.hpp"

#include <algorithm>
#include <set>

#include "sim/director/action_run.hpp"
#include "sim/director/stage.hpp"
#include "sim/director/world_observer.hpp"
#include "sim/vehicle/entities.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/vehicle/world_warnings.hpp"
#include "sim/world_file/check_script.hpp"

namespace sim {

namespace {

constexpr int max_firings_per_step = 1000;
constexpr int max_depth = 100;

std::uint64_t seed_of(const Stage& stage) {
  return static_cast<std::uint64_t>(stage.config().run.seed);
}

}  // namespace

Script::EventState::EventState(const EventConfig& config_, std::uint64_t seed)
    : config(config_), random(seed, "event/" + config_.name), jitter(seed, "event/" + config_.name + "#jitter") {}

void Script::EventState::start_draws(std::int64_t step_number) {
  if (random_step == step_number) return;
  random_step = step_number;
  random.begin_step(step_number);
}

Script::Script(Stage& stage) : stage_(stage), zones_(stage.config().zones), live_random_(seed_of(stage), "action") {
  const WorldConfig& config = stage.config();
  for (std::size_t i = 0; i < config.zones.size(); ++i)
    if (config.zones[i].speed_limit_mps || config.zones[i].finish) ruled_zones_.push_back(static_cast<int>(i));
  for (const ActorConfig& actor : config.actors) {
    actors_.emplace_back(actor);
    actors_.back().place(stage);
  }
  for (const EventConfig& event : config.events) {
    plan_next(events_.emplace_back(event, seed_of(stage)));
    watches_.push_back(make_watch(event.when, stage, zones_));
  }
  // Events name others that may follow them in the file, so they are linked at the end.
  for (std::size_t i = 0; i < events_.size(); ++i)
    for (EventState& cause : events_)
      if (config.events[i].when.kind == Condition::Kind::fires && config.events[i].when.subject == cause.config.name)
        cause.fired_by_this.push_back(static_cast<int>(i));
}

Script::~Script() = default;

std::optional<std::int64_t> Script::firings(const std::string& event) const {
  for (const EventState& each : events_)
    if (each.config.name == event) return each.fired;
  return std::nullopt;
}

bool Script::empty() const {
  return zones_.all().empty() && actors_.empty() && events_.empty();
}

void Script::step() {
  const Time now = stage_.now();
  firings_ = 0;
  if (!ruled_zones_.empty()) update_records(now);
  // Evaluate all conditions before any action, so that events do not depend on partial effects of others.
  std::vector<int> counts(events_.size(), 0);
  for (std::size_t i = 0; i < events_.size(); ++i) {
    if (events_[i].next && *events_[i].next <= now) counts[i] += due_times(events_[i], now);
    if (watches_[i]) counts[i] += watches_[i]->count_new(stage_);
  }
  while (!delayed_.empty() && delayed_.begin()->first.first <= now) {
    const std::size_t event = delayed_.begin()->second;
    delayed_.erase(delayed_.begin());
    fire(event, 0);
  }
  for (std::size_t i = 0; i < events_.size(); ++i)
    for (int k = 0; k < counts[i]; ++k) attempt(i, 0);
  for (Actor& actor : actors_) actor.step(stage_, now);
}

void Script::update_records(Time now) {
  for (const auto& vehicle : stage_.entities().vehicles()) {
    ZoneRecord& record = records_[vehicle->name()];
    const Vector3d p_WV = vehicle->X_WV().translation();
    bool speeding = false;
    for (const int i : ruled_zones_) {
      const Zone& zone = zones_.all()[static_cast<std::size_t>(i)];
      if (!zone.contains(p_WV)) continue;
      const auto& limit = zone.config().speed_limit_mps;
      // Excess speed counts once per step, however many zones with limits overlap.
      speeding = speeding || (limit && vehicle->base().v_WB_W().norm() > *limit);
      if (zone.config().finish && !record.finish_s) record.finish_s = to_seconds(now);
    }
    if (!speeding) continue;
    ++record.speeding_steps;
    // Counted in steps and multiplied: a sum of many step times would drift.
    record.speeding_s = static_cast<double>(record.speeding_steps) * to_seconds(stage_.clock().step);
  }
}

void Script::plan_next(EventState& event) {
  const EventConfig& config = event.config;
  event.next.reset();
  if (!config.at_s.empty()) {
    if (event.planned < static_cast<std::int64_t>(config.at_s.size()))
      event.next = from_seconds(config.at_s[static_cast<std::size_t>(event.planned)]);
  } else if (config.every_s > 0) {
    const double planned_s = config.from_s + static_cast<double>(event.planned) * config.every_s;
    if (planned_s > config.until_s + 1e-9) return;
    // The jitter depends on the number of the firing, not on earlier draws: a rewind plans the same times.
    event.jitter.begin_step(event.planned);
    event.next = from_seconds(planned_s + (config.jitter_s > 0 ? config.jitter_s * event.jitter.uniform() : 0.0));
  }
}

int Script::due_times(EventState& event, Time now) {
  int count = 0;
  while (event.next && *event.next <= now) {
    ++count;
    ++event.planned;
    // More planned times than may fire in a step, from a restored count or another interval: skip the excess at once.
    if (count > max_firings_per_step && event.config.every_s > 0) {
      const double passed = (to_seconds(now) - event.config.from_s) / event.config.every_s;
      event.planned = std::max(event.planned, static_cast<std::int64_t>(passed));
    }
    plan_next(event);
  }
  return count;
}

void Script::attempt(std::size_t i, int depth) {
  EventState& event = events_[i];
  if (event.config.times > 0 && event.fired >= event.config.times) return;
  if (firings_ >= max_firings_per_step) return cut(event, "more than 1000 events fired in a step");
  if (depth > max_depth) return cut(event, "events fire each other more than 100 deep");
  // Draws depend on the event and the step only, so that one event does not change the chances of another.
  event.start_draws(stage_.clock().step_number);
  if (event.config.probability < 1 && event.random.uniform() >= event.config.probability) return;
  ++event.fired;
  if (event.config.delay_s > 0) {
    ++firings_;
    delayed_[{stage_.now() + from_seconds(event.config.delay_s), next_delayed_++}] = i;
  } else {
    fire(i, depth);
  }
}

void Script::fire(std::size_t i, int depth) {
  EventState& event = events_[i];
  ++firings_;
  event.start_draws(stage_.clock().step_number);
  if (WorldObserver* const observer = stage_.observer())
    observer->happened({Occurrence::Kind::event, event.config.name, ""});
  carry_out(event.config.actions, {*this, stage_, "event '" + event.config.name + "'", event.random, nullptr, depth});
  for (const int next : event.fired_by_this) attempt(static_cast<std::size_t>(next), depth + 1);
}

void Script::cut(EventState& event, const std::string& why) {
  if (!event.reported_cut)
    stage_.warnings().bad_message("event '" + event.config.name + "'", why + "; the remaining actions are skipped");
  event.reported_cut = true;
}

std::vector<ActionEntry> Script::parse_now(const ConfigNode& action, Diagnostics& diagnostics) const {
  // Wrap a single action in a list.
  ConfigNode list;
  list.kind = ConfigNode::Kind::list;
  list.place = action.place;
  list.items = {action};
  const ConfigNode map = map_node("do", action.kind == ConfigNode::Kind::list ? action : list);
  ParamReader in(map, "", diagnostics);
  // Declare the names that actions may refer to.
  const WorldConfig& config = stage_.config();
  std::set<std::string> objects, movable;
  for (const auto& [name, listed] : catalog_) objects.insert(name);
  for (const auto& [name, object] : stage_.entities().objects()) objects.insert(name);
  for (std::string& name : names_added_by(map)) objects.insert(std::move(name));
  movable = objects;
  for (const auto& vehicle : stage_.entities().vehicles()) movable.insert(vehicle->name());
  for (const std::string& name : objects) in.declare("object", name);
  for (const std::string& name : movable) in.declare(movable_kind, name);
  for (const ActorConfig& actor : config.actors) in.declare("actor", actor.name);
  for (const EventConfig& event : config.events) in.declare("event", event.name);
  declare_surfaces(in, config);
  std::vector<ActionEntry> actions;
  read_actions(in, "do", actions, "");
  return actions;
}

void Script::run_now(const ConfigNode& action, Diagnostics& diagnostics) {
  make_catalog();
  std::vector<ActionEntry> actions = parse_now(action, diagnostics);
  if (!diagnostics.ok()) return;
  const auto find = [this](const std::string& name) -> NamedDevice {
    const MountedDevice* device = stage_.entities().find_device(name);
    if (device == nullptr) return {};
    return {&device->vehicle().config(), &device->config()};
  };
  check_actions(actions, stage_.config(), find, diagnostics);
  if (!diagnostics.ok()) return;
  // Several requests in one step share a stream, so that equal ones get different draws.
  if (live_random_step_ != stage_.clock().step_number) {
    live_random_step_ = stage_.clock().step_number;
    live_random_.begin_step(live_random_step_);
  }
  firings_ = 0;
  carry_out(actions, {*this, stage_, "", live_random_, &diagnostics, 0});
}

void Script::EventState::visit_state(StateArchive& archive) {
  archive(fired, planned);
  archive.unhashed(next, random, random_step, reported_cut);
  constexpr std::int64_t max = std::int64_t{1} << 53;
  archive.require(fired, 0, max, "a count of firings");
  archive.require(planned, 0, max, "a count of firings");
}

void Script::visit_state(StateArchive& archive) {
  for (Actor& actor : actors_) archive(actor);
  for (std::size_t i = 0; i < events_.size(); ++i) {
    archive(events_[i]);
    // A forged count would cause any number of firings.
    const std::optional<Time>& next = events_[i].next;
    if (archive.restoring() && next && *next <= stage_.now() - stage_.clock().step)
      archive.fail("an event that is overdue");
    if (watches_[i]) archive(*watches_[i]);
  }
  archive(delayed_, records_);
  archive.unhashed(next_delayed_, live_random_, live_random_step_, log_lines_);
  if (!archive.restoring()) return;
  for (const auto& [due, event] : delayed_)
    if (event >= events_.size()) archive.fail("a delayed event that does not exist");
}

}  // namespace sim
