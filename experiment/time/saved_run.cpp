// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/time/saved_run.hpp"

#include <array>
#include <cstdint>
#include <cstring>

#include "sim/state/state_archive.hpp"

namespace experiment {

namespace {

using Sizes = std::array<std::uint64_t, 3>;

}  // namespace

sim::Bytes joined(const SavedRun& saved) {
  sim::Bytes all;
  all.reserve(saved.state.size() + saved.scores.size() + saved.owners.size() + 64);
  auto sizes = sim::StateArchive::saver();
  sizes.section("sizes");  // the last one: split() finds the sizes at the end
  for (const sim::Bytes* part : {&saved.state, &saved.scores, &saved.owners}) {
    all.insert(all.end(), part->begin(), part->end());
    std::uint64_t size = part->size();
    sizes(size);
  }
  sizes.end();
  const sim::Bytes end = sizes.take_bytes();
  all.insert(all.end(), end.begin(), end.end());
  return all;
}

SavedRun split(const sim::Bytes& bytes) {
  Sizes sizes{};
  std::memcpy(sizes.data(), bytes.data() + bytes.size() - sizeof sizes, sizeof sizes);
  auto at = bytes.begin();
  const auto next = [&at](std::uint64_t size) {
    const auto begin = at;
    at += static_cast<std::ptrdiff_t>(size);
    return sim::Bytes(begin, at);
  };
  SavedRun saved;
  saved.state = next(sizes[0]);
  saved.scores = next(sizes[1]);
  saved.owners = next(sizes[2]);
  return saved;
}

}  // namespace experiment
