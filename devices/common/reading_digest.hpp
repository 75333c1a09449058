// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "sim/state/state_archive.hpp"

namespace devices {

/// Digest of a large reading, such as an image, in a snapshot.  Such a reading is published when it is taken and not
/// used again, so that the snapshot contains only its hash.
class ReadingDigest {
 public:
  /// Marks that a new reading has replaced the last one.
  void renew() { restored_.reset(); }

  /// Visits the digest.  `values`: all vectors of numbers of the reading.
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

  std::optional<std::uint64_t> restored_;  ///< digest of a reading taken before the snapshot, which is not available
};

}  // namespace devices
