// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/pose_history.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace viewer {

void PoseHistory::clear() {
  tracks_.clear();
  bytes_ = 0;
}

void PoseHistory::start_branch(std::int32_t number, std::int64_t start_us, std::int64_t left_us, bool continues) {
  const auto before = tracks_.find(present_);
  Track track{{number, std::nullopt, start_us, start_us}, {}};
  if (before != tracks_.end()) {
    before->second.branch.end_us = left_us;
    // Only a branch that continues the present one has its past.
    if (continues) track.branch.parent = present_;
  }
  // A fresh start is better than growing without limit, or refusing to branch.
  if (tracks_.size() >= max_branches) {
    clear();
    track.branch.parent.reset();
  }
  tracks_.insert_or_assign(number, std::move(track));
  present_ = number;
}

bool PoseHistory::is_due(std::int64_t time_us, std::int64_t step_us) const {
  const auto track = tracks_.find(present_);
  if (track == tracks_.end() || track->second.states.empty()) return true;
  return time_us / interval_us > (time_us - step_us) / interval_us;
}

void PoseHistory::add(std::int64_t time_us, std::uint32_t revision, std::span<const std::byte> bodies) {
  Track& track = tracks_[present_];
  if (!track.states.empty() && track.states.back().time_us >= time_us) return;
  if (track.states.empty() && !track.branch.parent) track.branch.start_us = time_us;
  track.branch.number = present_;
  track.branch.end_us = time_us;
  track.states.push_back({time_us, revision, count_++, {bodies.begin(), bodies.end()}});
  bytes_ += track.states.back().bytes();
  while (bytes_ > max_bytes_) {
    const std::size_t before = bytes_;
    thin();
    if (bytes_ == before) break;  // two states alone are larger
  }
}

void PoseHistory::thin() {
  // Find the older half, by the order of recording.
  std::vector<std::uint64_t> numbers;
  for (const auto& [number, track] : tracks_)
    for (const Saved& kept : track.states) numbers.push_back(kept.number);
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>((numbers.size() + 1) / 2);
  if (numbers.size() < 3) return;
  std::nth_element(numbers.begin(), middle, numbers.end());
  const std::uint64_t newer = *middle;
  // Thin it: keep states twice as far apart, or further, until an eighth of all is removed.
  constexpr std::int64_t max_apart_us = 1'000'000'000'000'000;
  for (std::int64_t apart_us = 2 * interval_us; apart_us < max_apart_us; apart_us *= 2)
    if (keep_apart(newer, apart_us, false) > numbers.size() / 8) {
      keep_apart(newer, apart_us, true);
      return;
    }
  // With many short branches, remove every second state.
  bool removes = false;
  for (auto& [number, track] : tracks_) {
    const auto end = std::remove_if(track.states.begin(), track.states.end(), [&](const Saved& kept) {
      if (kept.number >= newer || !std::exchange(removes, !removes)) return false;
      bytes_ -= kept.bytes();
      return true;
    });
    track.states.erase(end, track.states.end());
  }
}

/// Removes, or only counts, states that are less than a time after the one before in their branch.
std::size_t PoseHistory::keep_apart(std::uint64_t newer, std::int64_t apart_us, bool remove) {
  std::size_t count = 0;
  for (auto& [number, track] : tracks_) {
    std::optional<std::int64_t> before_us;
    const auto too_close = [&](const Saved& saved) {
      if (saved.number >= newer) return false;
      if (before_us && saved.time_us - *before_us < apart_us) {
        ++count;
        if (remove) bytes_ -= saved.bytes();
        return true;
      }
      before_us = saved.time_us;
      return false;
    };
    if (remove)
      track.states.erase(std::remove_if(track.states.begin(), track.states.end(), too_close), track.states.end());
    else
      static_cast<void>(std::count_if(track.states.begin(), track.states.end(), too_close));
  }
  return count;
}

const PoseHistory::Saved* PoseHistory::last_until(const Track& track, std::int64_t time_us) const {
  const auto after = std::upper_bound(track.states.begin(), track.states.end(), time_us,
                                      [](std::int64_t time, const Saved& kept) { return time < kept.time_us; });
  if (after != track.states.begin()) return &*std::prev(after);
  if (track.branch.parent) {
    const auto parent = tracks_.find(*track.branch.parent);
    if (parent != tracks_.end())
      if (const Saved* const kept = last_until(parent->second, std::min(time_us, track.branch.start_us))) return kept;
  }
  return track.states.empty() ? nullptr : &track.states.front();
}

std::optional<PoseHistory::State> PoseHistory::at(std::int32_t branch, std::int64_t time_us) const {
  const auto track = tracks_.find(branch);
  if (track == tracks_.end()) return std::nullopt;
  const Saved* const kept = last_until(track->second, time_us);
  if (kept == nullptr) return std::nullopt;
  return State{kept->time_us, kept->revision, kept->bodies};
}

std::vector<const PoseHistory::Saved*> PoseHistory::all_from(const Track& track, std::int64_t from_us) const {
  std::vector<const Saved*> states;
  // Walk from the branch back to its ancestors: each covers the time until the start of its child.
  std::int64_t until_us = std::numeric_limits<std::int64_t>::max();
  for (const Track* at = &track; at != nullptr;) {
    for (auto kept = at->states.rbegin(); kept != at->states.rend() && kept->time_us >= from_us; ++kept)
      if (kept->time_us <= until_us) states.push_back(&*kept);
    if (!at->branch.parent || at->branch.start_us < from_us) break;
    until_us = std::min(until_us, at->branch.start_us);
    const auto parent = tracks_.find(*at->branch.parent);
    at = parent == tracks_.end() ? nullptr : &parent->second;
  }
  std::reverse(states.begin(), states.end());
  return states;
}

/// Returns the time up to which two branches are one.
std::int64_t PoseHistory::fork_of(std::int32_t one, std::int32_t other) const {
  constexpr std::int64_t none = std::numeric_limits<std::int64_t>::min();
  // The ancestors of the first, with the time up to which it follows them.
  std::map<std::int32_t, std::int64_t> shared;
  std::int64_t until_us = std::numeric_limits<std::int64_t>::max();
  const auto parent_of = [&](std::int32_t number) -> std::optional<std::int32_t> {
    const auto track = tracks_.find(number);
    if (track == tracks_.end()) return std::nullopt;
    until_us = std::min(until_us, track->second.branch.start_us);
    return track->second.branch.parent;
  };
  for (std::optional<std::int32_t> at = one; at; at = parent_of(*at)) shared[*at] = until_us;
  until_us = std::numeric_limits<std::int64_t>::max();
  for (std::optional<std::int32_t> at = other; at; at = parent_of(*at))
    if (const auto found = shared.find(*at); found != shared.end()) return std::min(found->second, until_us);
  return none;
}

std::optional<std::int64_t> PoseHistory::first_difference(std::int32_t one, std::int32_t other) const {
  const auto a = tracks_.find(one), b = tracks_.find(other);
  if (a == tracks_.end() || b == tracks_.end() || one == other) return std::nullopt;
  const std::int64_t fork_us = fork_of(one, other);
  const std::vector<const Saved*> first = all_from(a->second, fork_us), second = all_from(b->second, fork_us);
  // Compare the states of equal times.
  for (auto i = first.begin(), j = second.begin(); i != first.end() && j != second.end();) {
    if ((*i)->time_us != (*j)->time_us) {
      ++((*i)->time_us < (*j)->time_us ? i : j);
      continue;
    }
    if ((*i)->bodies != (*j)->bodies) return (*i)->time_us;
    ++i, ++j;
  }
  return std::nullopt;
}

std::vector<PoseHistory::Branch> PoseHistory::branches() const {
  std::vector<Branch> all;
  for (const auto& [number, track] : tracks_) all.push_back(track.branch);
  return all;
}

}  // namespace viewer
