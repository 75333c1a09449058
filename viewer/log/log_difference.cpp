// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/log/log_difference.hpp"

#include <map>
#include <string_view>
#include <vector>

#include "viewer/log/log_poses.hpp"

namespace viewer {

namespace {

/// Calls `use` with the elements of equal times until it returns false; returns the number of such pairs.
template <typename Timed, typename Use>
std::size_t for_equal_times(const std::vector<Timed>& a, const std::vector<Timed>& b, const Use& use) {
  std::size_t pairs = 0;
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    if (i->time_us != j->time_us) {
      if (i->time_us < j->time_us)
        ++i;
      else
        ++j;
      continue;
    }
    ++pairs;
    if (!use(*i, *j)) break;
    ++i;
    ++j;
  }
  return pairs;
}

/// Returns whether a body that both have is at another pose.
bool differ(const LogPoses::Poses& a, const LogPoses::Poses& b) {
  std::map<std::string_view, std::size_t> index;
  for (std::size_t i = 0; i < a.names->size() && i < a.message.position_m.size(); ++i) index.emplace((*a.names)[i], i);
  for (std::size_t j = 0; j < b.names->size() && j < b.message.position_m.size(); ++j) {
    const auto found = index.find((*b.names)[j]);
    if (found == index.end()) continue;
    const std::size_t i = found->second;
    if (a.message.position_m[i] != b.message.position_m[j] || a.message.orientation[i] != b.message.orientation[j])
      return true;
  }
  return false;
}

}  // namespace

std::optional<LogDifference> first_difference(const std::string& path_a, const LogIndex& a, const std::string& path_b,
                                              const LogIndex& b) {
  std::optional<LogDifference> difference;
  // Hashes: they have all of the state.
  const std::size_t hashes =
      for_equal_times(a.hashes(), b.hashes(), [&](const LogIndex::Hash& one, const LogIndex::Hash& other) {
        if (one.hash == other.hash) return true;
        difference = LogDifference{one.time_us, one.step, "sim.hash"};
        return false;
      });
  if (hashes > 0) return difference;
  // Poses, of logs without hashes.
  LogPoses poses_a(path_a, a), poses_b(path_b, b);
  for_equal_times(a.bodies(), b.bodies(), [&](const LogIndex::Mark& one, const LogIndex::Mark& other) {
    const LogPoses::Poses* const here = poses_a.at(one.time_us);
    const LogPoses::Poses* const there = poses_b.at(other.time_us);
    if (here == nullptr || there == nullptr || !differ(*here, *there)) return true;
    difference = LogDifference{one.time_us, std::nullopt, "poses"};
    return false;
  });
  return difference;
}

}  // namespace viewer
