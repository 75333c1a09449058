// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "sim/acoustics/channel.hpp"
#include "sim/config/warnings.hpp"
#include "sim/director/script.hpp"
#include "sim/world/run_hash.hpp"
#include "sim/world/world.hpp"
#include "sim/world/world_journal.hpp"

// The state of a world: hashed, saved, restored.

namespace sim {

namespace {

/// Grows when the order or the meaning of what a snapshot holds changes.
constexpr std::uint32_t state_version = 4;

/// Whom the events are for is looked up by number when they are due.
void check_events(EventQueue& queue, std::size_t devices, const AcousticChannel& acoustics,
                  const StateArchive& archive) {
  StateArchive saver = StateArchive::saver();
  saver(queue);
  const Bytes bytes = saver.take_bytes();
  StateArchive reader = StateArchive::restorer(bytes);
  std::int64_t reached = 0;  // what the queue saves before its events
  std::uint64_t next_sequence = 0;
  std::vector<Event> events;
  reader(reached, next_sequence, events);
  for (const Event& event : events)
    if (event.device != Event::of_acoustics && static_cast<std::size_t>(event.device) >= devices)
      archive.fail("an event of a device that is not there");
  acoustics.check_events(events, archive);
}

}  // namespace

void World::visit_state(StateArchive& archive) {
  archive.section("world");
  archive(step_number_, ended_);
  archive.require(step_number_, 0, StateArchive::max_time.count() / step_us_, "a step");
  archive.unhashed(next_vehicle_number_, next_object_number_, counts_, complaints_, *run_hash_);
  constexpr int most_vehicles_ever = 100'000'000;  // lists have a place for each number
  if (archive.restoring() &&
      (next_vehicle_number_ < 0 || next_vehicle_number_ > most_vehicles_ever || next_object_number_ < 0))
    archive.fail("numbers of vehicles or objects that cannot be");
  physics_->visit_state(archive);
  archive.section("medium");
  archive(medium_, *hydrodynamics_);
  for (const auto& vehicle : vehicles_) {
    archive.section(vehicle->name());
    archive(*vehicle);
    // It would be advanced from there in as many small steps as a forger likes.
    if (archive.restoring() && !vehicle->clock().stands_at(now()))
      archive.fail("a clock that stands at another time than the world");
    for (MountedDevice* device : vehicle->devices()) {
      archive.section(device->full_name());
      archive(*device);
    }
  }
  archive.section("objects");
  for (auto& [name, object] : objects_) archive(*object.body);
  archive.section("events");
  archive(events_);
  archive.section("acoustics");
  archive(*acoustics_);
  if (archive.restoring()) check_events(events_, devices_.size(), *acoustics_, archive);
  archive.section("script");
  archive(*script_);
  if (!archive.hashing()) {
    archive.section("mail");
    visit_mail(archive);
  }
  archive.end();
}

/// What the world itself has sent to its devices in the step that ended.
void World::visit_mail(StateArchive& archive) {
  std::map<int, std::vector<Message>> mail;
  for (const auto& device : devices_) {
    if (!device || !device->mailbox() || archive.restoring()) continue;
    if (std::vector<Message> unread = device->mailbox()->unread(); !unread.empty())
      mail[device->number()] = std::move(unread);
  }
  archive(mail);
  if (!archive.restoring()) return;
  for (const auto& device : devices_)
    if (device && device->mailbox()) device->mailbox()->set_unread(std::move(mail[device->number()]));
}

std::uint64_t World::state_hash() const {
  StateArchive archive = StateArchive::quick_hasher();
  const_cast<World*>(this)->visit_state(archive);  // hashing changes nothing
  return archive.hash();
}

std::uint64_t World::run_hash() const {
  StateHash hash;
  hash.add(run_hash_->value());
  hash.add(state_hash());
  return hash.value();
}

/// What moves after each step, the rest after every tenth: the whole state takes up to a tenth of a step to hash, and
/// what differs in it shows in motion or in messages, or still differs then.
void World::add_to_run_hash() {
  constexpr std::int64_t steps_per_whole_state = 10;
  StateArchive archive = StateArchive::quick_hasher();
  if (step_number_ % steps_per_whole_state == 0)
    visit_state(archive);
  else
    for (const auto& body : physics_->bodies())
      if (body && !body->fixed()) body->visit_state(archive);
  run_hash_->add_state(archive.hash());
}

std::vector<PartHash> World::part_hashes() const {
  StateArchive archive = StateArchive::hasher();
  const_cast<World*>(this)->visit_state(archive);
  return archive.parts();
}

namespace {

/// What says which world a snapshot is of.
struct SnapshotHead {
  std::uint32_t version = state_version;
  std::uint64_t seed = 0;
  std::int64_t step_us = 0, step = 0;
  Bytes journal;
  void visit_state(StateArchive& archive) { archive(version, seed, step_us, step, journal); }
};

}  // namespace

Bytes World::snapshot() const {
  if (!script_) throw SnapshotError("the world was lost when a snapshot was restored");
  if (in_step_) throw SnapshotError("the last step of the world was not ended: there is nothing to go on from");
  if (!journal_->gap().empty()) throw SnapshotError("this world cannot be saved: " + journal_->gap());
  StateArchive archive = StateArchive::saver(last_snapshot_bytes_ + last_snapshot_bytes_ / 8);
  archive.section("make");
  SnapshotHead head{state_version, seed(), step_us_, step_number_, journal_->bytes()};
  archive(head);
  const_cast<World*>(this)->visit_state(archive);  // saving changes nothing
  Bytes bytes = archive.take_bytes();
  last_snapshot_bytes_ = bytes.size();
  return bytes;
}

void World::restore(std::span<const std::byte> snapshot) {
  std::optional<Bytes> before;
  if (script_ && !in_step_ && journal_->gap().empty()) before = this->snapshot();
  try {
    restore_state(snapshot);
  } catch (const std::exception& error) {
    std::string what = error.what();
    try {
      if (!before) throw SnapshotError("it was broken before");
      restore_state(*before);
    } catch (const std::exception& again) {
      script_.reset();
      what += std::string("; and the world as it was is lost: ") + again.what();
    }
    throw SnapshotError(what);
  }
}

void World::restore_state(std::span<const std::byte> snapshot) {
  StateArchive archive = StateArchive::restorer(snapshot);
  archive.section("make");
  SnapshotHead head;
  archive(head);
  if (head.version != state_version)
    archive.fail("its state is of version " + std::to_string(head.version) + ", this program's of " +
                 std::to_string(state_version));
  if (head.seed != seed() || head.step_us != step_us_)
    archive.fail("it is of another world: seed " + std::to_string(head.seed) + ", step " +
                 std::to_string(head.step_us) + " us; this one has seed " + std::to_string(seed()) + ", step " +
                 std::to_string(step_us_) + " us");
  if (head.step < 0 || head.step > StateArchive::max_time.count() / step_us_)
    archive.fail("its step " + std::to_string(head.step) + " cannot be");
  const bool same_make = head.journal == journal_->bytes() && journal_->gap().empty();
  if (!same_make || !script_ || in_step_) {
    build_again();
    journal_->replay(head.journal, head.step);
  }
  visit_state(archive);
  if (step_number_ != head.step) archive.fail("its step is not the one it begins with");
  sort_devices();
  in_step_ = false;
}

/// Devices before what they hold on to, as at the end of the world.
void World::take_all_apart() {
  script_.reset();
  due_.clear();
  casting_.clear();
  listening_.clear();
  acting_.clear();
  sensing_.clear();
  clocked_.clear();
  devices_.clear();
  vehicles_by_name_.clear();
  vehicles_.clear();
  objects_.clear();
  channels_.clear();
  acoustics_.reset();
  hydrodynamics_.reset();
  free_numbers_.clear();
  // What was warned of is known: it stays said.
  std::erase_if(shared_, [](const auto& each) { return each.first != std::type_index(typeid(Warnings)); });
  events_ = {};
  ended_.reset();
  next_vehicle_number_ = 0;
  next_object_number_ = 0;
  step_number_ = 0;
}

/// The world as it was at its start.
void World::build_again() {
  take_all_apart();
  physics_->start_again(config_.physics, config_.materials, config_.contacts, config_.categories, seed());
  StateArchive start = StateArchive::restorer(medium_at_start_);
  start(medium_);
  build();
  ++generation_;
}

}  // namespace sim
