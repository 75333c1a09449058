// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/world.hpp"

#include <spdlog/fmt/fmt.h>

#include <utility>

#include "sim/base/shared_work.hpp"
#include "sim/base/thread_pool.hpp"
#include "sim/world/world_builder.hpp"
#include "sim/world/world_checks.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_journal.hpp"
#include "sim/world/world_parts.hpp"
#include "sim/world/world_state.hpp"

namespace sim {

World::World(const WorldConfig& config, Bus& bus, PortOpener open_port, BusFinder find_bus)
    : config_(config),
      parts_(std::make_unique<WorldParts>(*this, config, bus, std::move(open_port), std::move(find_bus))),
      clock_(parts_->clock),
      geodesy_(parts_->geodesy),
      physics_(parts_->physics),
      medium_(parts_->medium),
      entities_(parts_->entities),
      builder_(std::make_unique<WorldBuilder>(*parts_)),
      journal_(std::make_unique<WorldJournal>(*parts_)),
      editor_(std::make_unique<WorldEditor>(*this, *parts_, *builder_, *journal_)),
      state_(std::make_unique<WorldState>(*parts_, *builder_, *editor_, *journal_)) {
  // Checks of the start come after build(): they need the bodies at their places, the water and the bottom below
  // them.
  builder_->build();
  parts_->script = std::make_unique<Script>(*editor_);
  Warnings& warnings = parts_->warnings.building();
  warn_of_starts(*this, warnings);
  for (const std::string& warning : physics_.ground_warnings()) warnings.warn({}, "", warning);
  for (const Warning& warning : parts_->hydrodynamics->take_warnings()) warnings.warn(warning);
  for (const std::string& warning : bottom_warnings(*this)) warnings.warn({}, "", warning);
  for (const auto& vehicle : vehicles()) warn_of_plans(*this, *vehicle, warnings);
}

World::~World() = default;

void World::use_threads(int threads) {
  parts_->schedule.use_threads(threads);
  physics_.use_threads(threads);
}

void World::set_observer(WorldObserver* observer) {
  parts_->observer = observer;
  parts_->warnings.listen_to_device_faults([&parts = *parts_](const std::string& device, const std::string& text) {
    if (parts.observer != nullptr) parts.observer->happened({Occurrence::Kind::fault, device, text});
  });
  parts_->acoustics->set_observer(observer);
}

namespace {

/// Keeps warnings of the bodies that moved too far in this step.
void keep_leaps(WorldParts& parts) {
  for (const Leap& leap : parts.physics.take_leaps())
    parts.warnings.keep_for_end(
        "body '" + parts.physics.bodies()[static_cast<std::size_t>(leap.body)]->name() + "'",
        fmt::format(
            "it moves {:.3g} m in a step, further than its size of {:.3g} m, and may pass through what is thin; "
            "use a 'step_s' below {:.2g}",
            leap.moved_m, leap.size_m, parts.config.physics.step_s * leap.size_m / leap.moved_m));
}

/// Returns where to measure the work of this step; null: not.
SharedWork* work_to_measure(const WorldParts& parts) {
  constexpr std::int64_t steps_between = 61;  // not a multiple of any usual sensor period
  const ThreadPool* const threads = parts.schedule.threads();
  const bool due = threads != nullptr && threads->threads() > 1 && parts.clock.step_number % steps_between == 0;
  return due ? parts.shared_work : nullptr;
}

}  // namespace

void World::step() {
  WorldParts& parts = *parts_;
  if (!parts.script) throw SnapshotError("the world was lost when a snapshot was restored");
  parts.in_step = true;
  const SharedWorkClock work_clock(work_to_measure(parts));
  StageClock stages(parts.stage_times);
  parts.schedule.take_messages(parts.clock);
  stages.end(StepStage::messages);
  // Forces are those half-way through the step, see docs/models/rigid_bodies.md.
  parts.medium.advance_to(now() + from_seconds(config_.physics.step_s / 2));
  stages.end(StepStage::medium);
  act_in_water(stages);
  parts.script->step();
  stages.end(StepStage::script);
  parts.physics.step(parts.clock.step_number);
  keep_leaps(parts);
  stages.end(StepStage::physics);
  ++parts.clock.step_number;
  parts.medium.advance_to(now());
  stages.end(StepStage::medium);
  parts.schedule.advance_clocks(parts.clock, parts.medium);
  run_due_events();
  stages.end(StepStage::events);
  parts.schedule.sense(parts.clock, scene(), stages);
  add_to_run_hash();
  stages.end(StepStage::hash);
  parts.in_step = false;
}

/// Lets the actuators act, and adds the forces of the water.
void World::act_in_water(StageClock& stages) {
  Hydrodynamics& water = *parts_->hydrodynamics;
  StepSchedule& schedule = parts_->schedule;
  const double step_s = config_.physics.step_s, gravity_mps2 = parts_->physics.gravity_mps2();
  ThreadPool* const threads = schedule.threads();
  if (schedule.acting().begin_by_groups()) {
    water.step_by_groups(gravity_mps2,
                         {[&](int group) { schedule.acting().act_of(group, parts_->clock, step_s); },
                          [&] {
                            stages.end(StepStage::hydrodynamics);
                            schedule.acting().act_rest(parts_->clock, step_s, threads);
                            stages.end(StepStage::act);
                          }},
                         threads);
    stages.end(StepStage::hydrodynamics);
    return;
  }
  water.begin_step(threads);
  stages.end(StepStage::hydrodynamics);
  schedule.act(parts_->clock, step_s);
  stages.end(StepStage::act);
  water.step(gravity_mps2, threads);
  stages.end(StepStage::hydrodynamics);
}

void World::run_due_events() {
  AcousticChannel& sound = *parts_->acoustics;
  ThreadPool* const threads = parts_->schedule.threads();
  const Time now = this->now();
  for (Event event;;) {
    if (!parts_->events.take_due(now, event)) {
      if (sound.handle_deferred(now + Time{1}, now, threads)) continue;  // more may be due
      return;
    }
    if (event.device == Event::of_acoustics && sound.defer(event, now)) continue;
    sound.handle_deferred(event.due, now, threads);
    if (event.device == Event::of_acoustics)
      sound.handle(event, now);
    else if (MountedDevice* device = parts_->devices.at(event.device))
      device->handle(event);
  }
}

/// Adds the motion after each step, and the whole state after every fiftieth: hashing it takes as long as some steps,
/// and a difference in it affects motion or messages, or persists until then.
void World::add_to_run_hash() {
  constexpr std::int64_t steps_per_whole_state = 50;
  ThreadPool* const threads = parts_->schedule.threads();
  const bool whole = step_number() % steps_per_whole_state == 0;
  parts_->buses.run_hash().add_state(whole ? parts_->step_hash.of_state(*parts_, threads)
                                           : parts_->step_hash.of_motion(*parts_, threads));
}

const Hydrodynamics& World::hydrodynamics() const {
  return *parts_->hydrodynamics;
}

AcousticChannel& World::acoustics() {
  return *parts_->acoustics;
}

const AcousticChannel& World::acoustics() const {
  return *parts_->acoustics;
}

std::span<const std::unique_ptr<MountedDevice>> World::devices() const {
  return parts_->devices.all();
}

const SharedByDevices& World::shared() const {
  return parts_->shared;
}

Bus& World::bus() {
  return parts_->buses.own();
}

Bus& World::bus_of_channel(const std::string& channel) {
  return parts_->buses.of_channel(channel);
}

WorldWarnings& World::warnings() {
  return parts_->warnings;
}

const WorldWarnings& World::warnings() const {
  return parts_->warnings;
}

const std::optional<EndOfRun>& World::ended() const {
  return parts_->ended;
}

const Zones& World::zones() const {
  return parts_->script->zones();
}

std::optional<std::int64_t> World::event_firings(const std::string& name) const {
  return parts_->script->firings(name);
}

const std::map<std::string, ZoneRecord>& World::zone_records() const {
  return parts_->script->zone_records();
}

WorldCounts World::counts() const {
  return {parts_->schedule.samples(), parts_->warnings.bad_messages()};
}

}  // namespace sim
