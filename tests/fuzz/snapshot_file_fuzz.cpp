// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/snapshot/snapshot_file.hpp"
#include "sim/base/crc32.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// The file of a snapshot.  Its checksum is made right: it protects from accidents, not from people.

SHOAL_FUZZ_TARGET(snapshot_file) {
  sim::Bytes bytes(input.begin(), input.end());
  constexpr std::size_t checksum_bytes = 4;
  if (bytes.size() >= checksum_bytes) {
    const std::uint32_t sum = sim::crc32(std::span(bytes).first(bytes.size() - checksum_bytes));
    std::memcpy(bytes.data() + bytes.size() - checksum_bytes, &sum, sizeof sum);
  }
  fuzz::allow<experiment::SnapshotFileError>([&] {
    const experiment::Snapshot snapshot = experiment::snapshot_from_bytes(bytes, "fuzz");
    const experiment::Snapshot again = experiment::snapshot_from_bytes(experiment::to_bytes(snapshot), "again");
    fuzz::require(again.state == snapshot.state && again.step == snapshot.step, "a snapshot is written as it was read");
  });
}
