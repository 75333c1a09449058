// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/transducers.hpp"

#include <algorithm>

namespace sim {

void Transducers::add(Transducer& transducer) {
  const int number = numbers_.take();
  slot(transducers_, number) = &transducer;
  transducer.ref_ = {number, ++registrations_};
}

void Transducers::remove(Transducer& transducer) {
  const Transducer::Counts counts = transducer.counts();
  removed_.sent += counts.sent;
  removed_.sent_bytes += counts.sent_bytes;
  removed_.understood += counts.understood;
  removed_.understood_bytes += counts.understood_bytes;
  removed_.unsent += counts.unsent;
  for (std::size_t i = 0; i < counts.lost.size(); ++i) removed_.lost[i] += counts.lost[i];
  slot(transducers_, transducer.number()) = nullptr;
  numbers_.give_back(transducer.number());
}

bool Transducers::any_has(const Audience& address) const {
  return std::any_of(transducers_.begin(), transducers_.end(),
                     [&](const Transducer* each) { return each != nullptr && each->own_ == address; });
}

Transducer* Transducers::visit_reference(StateArchive& archive, const Transducer* transducer) const {
  int number = transducer != nullptr ? transducer->number() : -1;
  archive(number);
  if (number >= count()) archive.fail("a signal of a transducer that does not exist");
  return number < 0 ? nullptr : at(number);
}

void Transducers::visit_each(StateArchive& archive) {
  for_each([&](Transducer& each) { archive(each); });
}

}  // namespace sim
