// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/world_state.hpp"

#include <optional>
#include <string>

#include "sim/base/state_hash.hpp"
#include "sim/world/journal_replay.hpp"
#include "sim/world/world_builder.hpp"
#include "sim/world/world_journal.hpp"
#include "sim/world/world_parts.hpp"

namespace sim {

namespace {

/// Version of the snapshot format; increases when order or meaning of its contents change.
constexpr std::uint32_t state_version = 4;

/// Identification of the world of a snapshot.
struct SnapshotHead {
  std::uint32_t version = state_version;
  std::uint64_t seed = 0;
  std::int64_t step_us = 0, step = 0;
  Bytes journal;
  void visit_state(StateArchive& archive) { archive(version, seed, step_us, step, journal); }
};

void check_head(const SnapshotHead& head, const WorldParts& parts, const StateArchive& archive) {
  const std::int64_t step_us = parts.clock.step.count();
  if (head.version != state_version)
    archive.fail("its state is of version " + std::to_string(head.version) + ", this program's of " +
                 std::to_string(state_version));
  if (head.seed != parts.seed() || head.step_us != step_us)
    archive.fail("it is of another world: seed " + std::to_string(head.seed) + ", step " +
                 std::to_string(head.step_us) + " us; this one has seed " + std::to_string(parts.seed()) + ", step " +
                 std::to_string(step_us) + " us");
  if (head.step < 0 || head.step > StateArchive::max_time.count() / step_us)
    archive.fail("its step " + std::to_string(head.step) + " cannot be");
}

}  // namespace

std::uint64_t WorldState::hash() const {
  StateArchive archive = StateArchive::quick_hasher();
  parts_.visit_state(archive);
  return archive.hash();
}

void WorldState::measure_stages(StageTimes* times) {
  parts_.stage_times = times;
}

void WorldState::measure_shared_work(SharedWork* work) {
  parts_.shared_work = work;
}

std::uint64_t WorldState::run_hash(std::uint64_t state_hash) const {
  StateHash all;
  all.add(parts_.buses.run_hash().value());
  all.add(state_hash);
  return all.value();
}

std::vector<PartHash> WorldState::part_hashes() const {
  StateArchive archive = StateArchive::hasher();
  parts_.visit_state(archive);
  return archive.parts();
}

Bytes WorldState::snapshot() const {
  if (!parts_.script) throw SnapshotError("the world was lost when a snapshot was restored");
  if (parts_.in_step)
    throw SnapshotError("the last step of the world was not finished: there is nothing to continue from");
  if (!journal_.gap().empty()) throw SnapshotError("this world cannot be saved: " + journal_.gap());
  StateArchive archive = StateArchive::saver(last_bytes_ + last_bytes_ / 8);
  archive.section("make");
  SnapshotHead head{state_version, parts_.seed(), parts_.clock.step.count(), parts_.clock.step_number,
                    journal_.bytes()};
  archive(head);
  parts_.visit_state(archive);
  Bytes bytes = archive.take_bytes();
  last_bytes_ = bytes.size();
  return bytes;
}

void WorldState::restore(std::span<const std::byte> snapshot) {
  std::optional<Bytes> before;
  if (parts_.script && !parts_.in_step && journal_.gap().empty()) before = this->snapshot();
  try {
    load(snapshot);
  } catch (const std::exception& error) {
    std::string what = error.what();
    try {
      if (!before) throw SnapshotError("it was broken before");
      load(*before);
    } catch (const std::exception& again) {
      parts_.script.reset();
      what += std::string("; and the world as it was is lost: ") + again.what();
    }
    throw SnapshotError(what);
  }
}

void WorldState::load(std::span<const std::byte> snapshot) {
  StateArchive archive = StateArchive::restorer(snapshot);
  archive.section("make");
  SnapshotHead head;
  archive(head);
  check_head(head, parts_, archive);
  const bool same_structure = head.journal == journal_.bytes() && journal_.gap().empty();
  if (!same_structure || !parts_.script || parts_.in_step) {
    builder_.rebuild();
    parts_.script = std::make_unique<Script>(stage_);
    JournalReplay(parts_, builder_, journal_).replay(head.journal, head.step);
  }
  parts_.visit_state(archive);
  if (parts_.clock.step_number != head.step) archive.fail("its step is not the one with which it starts");
  builder_.sort_devices();
  parts_.in_step = false;
}

}  // namespace sim
