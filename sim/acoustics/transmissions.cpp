// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/transmissions.hpp"

#include <algorithm>
#include <utility>

namespace sim {

void Transmission::visit_state(StateArchive& archive) {
  archive(signal, source, number, group, sequence, sent, p_W, v_W, R_WS, truncated_by, truncated_after, users);
  archive.unhashed(directivity.pattern, directivity.diameter_m, directivity.length_m, directivity.floor_dB);
  if (!archive.restoring()) return;
  check_loss(truncated_by, archive);
  if (truncated_after < Time{0} || truncated_after > std::max(signal.duration, Time{0}))
    archive.fail("a signal cut beyond its end");
}

TransmissionId Transmissions::add(Transducer& from, std::int64_t sequence, Signal signal, Time at) {
  const TransmissionId id = pool_.add();
  Transmission& added = pool_[id];
  added.signal = std::move(signal);
  added.from = &from;
  added.source = from.full_name();
  added.number = from.number();
  added.group = from.group();
  added.sequence = sequence;
  added.sent = at;
  added.users = 2;
  return id;
}

void Transmissions::release(TransmissionId id) {
  if (--pool_[id].users <= 0) pool_.remove(id);
}

void Transmissions::cancel_pending(const Transducer& from, TransmissionId present) {
  pool_.for_each([&](TransmissionId id, Transmission& each) {
    if (each.from == &from && id != present) each.from = nullptr;
  });
}

void Transmissions::truncate(TransmissionId id, SignalLoss why, Time at) {
  Transmission& truncated = pool_[id];
  truncated.truncated_by = why;
  truncated.truncated_after = std::clamp(at - truncated.sent, Time{0}, truncated.signal.duration);
}

void Transmissions::visit_items(StateArchive& archive, std::uint64_t count, const Transducers& transducers) {
  pool_.visit_items(archive, count, [&](TransmissionId, Transmission& each) {
    archive(each);
    Transducer* const from = transducers.visit_reference(archive, each.from);
    if (archive.restoring()) each.from = from;
  });
}

}  // namespace sim
