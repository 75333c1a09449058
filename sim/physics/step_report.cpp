// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/step_report.hpp"

#include <algorithm>
#include <utility>

namespace sim {

void StepReport::collect(std::span<const Shard* const> stepped, int rows_of_joints) {
  counts_ = {0, rows_of_joints, false};
  contacts_.clear();
  bool quick_instead = false;
  for (const Shard* shard : stepped) {
    broken_ |= shard->solver_failed;
    counts_.contacts += shard->contact_count;
    counts_.max_island_rows = std::max(counts_.max_island_rows, shard->max_rows);
    counts_.quick |= shard->quick;
    quick_instead |= shard->quick_instead;
    contacts_.insert(contacts_.end(), shard->contacts.begin(), shard->contacts.end());
  }
  if (quick_instead) ++quick_steps_;
  std::stable_sort(contacts_.begin(), contacts_.end(), [](const ContactReport& a, const ContactReport& b) {
    return std::pair(a.parts[0], a.parts[1]) < std::pair(b.parts[0], b.parts[1]);
  });
}

void StepReport::throw_first_fault(std::span<const Shard* const> stepped) {
  for (const Shard* shard : stepped)
    if (shard->fault) std::rethrow_exception(shard->fault);
}

void StepReport::remove(int group, const Parts& parts) {
  std::erase_if(contacts_, [&](const ContactReport& contact) {
    return parts[contact.parts[0]].group == group || parts[contact.parts[1]].group == group;
  });
}

void StepReport::visit_state(StateArchive& archive, const Parts& parts) {
  archive.unhashed(contacts_, counts_, quick_steps_);
  const auto known = [&](int part) { return part >= 0 && part < static_cast<int>(parts.all().size()); };
  for (const ContactReport& contact : contacts_)
    if (!known(contact.parts[0]) || !known(contact.parts[1])) archive.fail("a contact of a part that does not exist");
}

}  // namespace sim
