// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "sim/bus/bus.hpp"

namespace viewer {

/// Poses of all movable bodies of a run in the past, for each of its branches: ten times per simulated second, in
/// bounded memory.  When it is full, the states of the older half are kept further apart.
class PoseHistory {
 public:
  /// Part of a run between two rewinds.
  struct Branch {
    std::int32_t number = 0;
    std::optional<std::int32_t> parent;  ///< unset: the first one, or one that began with a snapshot file
    std::int64_t start_us = 0, end_us = 0;
  };
  /// Poses at a time.
  struct State {
    std::int64_t time_us = 0;
    std::uint32_t revision = 0;         ///< of the scene that has these bodies
    std::span<const std::byte> bodies;  ///< as in StateFrame::bodies(); valid until the history changes
  };
  static constexpr std::size_t usual_bytes = std::size_t{64} << 20;
  static constexpr std::int64_t interval_us = 100'000;
  /// Maximum number of branches; at a further one the history starts again.
  static constexpr std::size_t max_branches = 1000;

  explicit PoseHistory(std::size_t max_bytes = usual_bytes) : max_bytes_(max_bytes) {}

  /// Starts a branch; the one before ends at `left_us`.  `continues`: the states before its start are those of the
  /// branch before.
  void start_branch(std::int32_t number, std::int64_t start_us, std::int64_t left_us, bool continues);
  /// Returns whether the poses after a step are to be kept: at the first step at or after each multiple of the
  /// interval.
  bool is_due(std::int64_t time_us, std::int64_t step_us) const;
  /// Keeps poses of the present branch; times must increase.
  void add(std::int64_t time_us, std::uint32_t revision, std::span<const std::byte> bodies);
  /// Returns the last state of a branch at or before a time, else its first; none: there is no such branch or state.
  std::optional<State> at(std::int32_t branch, std::int64_t time_us) const;
  /// Returns the first time at which two branches have states that differ; none: none that is kept.
  std::optional<std::int64_t> first_difference(std::int32_t one, std::int32_t other) const;

  /// Returns the branches in the order of their starts; the last one is the present one.
  std::vector<Branch> branches() const;
  std::int32_t present() const { return present_; }
  bool has(std::int32_t branch) const { return tracks_.contains(branch); }
  std::size_t bytes() const { return bytes_; }
  void clear();

 private:
  struct Saved {
    std::int64_t time_us = 0;
    std::uint32_t revision = 0;
    std::uint64_t number = 0;  // in the order of recording
    sim::Bytes bodies;
    std::size_t bytes() const { return sizeof(Saved) + bodies.size(); }
  };
  struct Track {
    Branch branch;
    std::vector<Saved> states;
  };

  void thin();
  std::size_t keep_apart(std::uint64_t newer, std::int64_t apart_us, bool remove);
  const Saved* last_until(const Track& track, std::int64_t time_us) const;
  /// All states of a branch, with those of its ancestors before it, from a time on.
  std::vector<const Saved*> all_from(const Track& track, std::int64_t from_us) const;
  std::int64_t fork_of(std::int32_t one, std::int32_t other) const;

  std::size_t max_bytes_, bytes_ = 0;
  std::uint64_t count_ = 0;
  std::int32_t present_ = 0;
  std::map<std::int32_t, Track> tracks_{{0, {}}};
};

}  // namespace viewer
