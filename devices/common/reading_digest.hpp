// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "sim/state/state_archive.hpp"

namespace devices {

/// Represents in a snapshot a large reading, such as an image, that was published when it was taken and is not used
/// until the next one replaces it: only its hash is kept.
class ReadingDigest {
 public:
  /// Another reading takes the place of the last one.
  void renew() { restored_.reset(); }

  /// `values`: all vectors of numbers that the reading consists of.
  template <typename... Values>
  void visit(sim::StateArchive& archive, const Values&... values) {
    std::uint64_t digest = 0;
    if (!archive.restoring()) digest = restored_ ? *restored_ : hash_of(values...);
    archive(digest);
    if (archive.restoring()) restored_ = digest;
  }

 private:
  template <typename... Values>
  static std::uint64_t hash_of(const Values&... values) {
    sim::StateHash hash;
    (hash.add_bytes(values.data(), values.size() * sizeof values[0]), ...);
    return hash.value();
  }

  std::optional<std::uint64_t> restored_;  ///< of a reading that is not here: it was taken before the snapshot
};

}  // namespace devices
