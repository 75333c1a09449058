// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "bridges/dds/dds_participant.hpp"
#include "tests/bridges/dds/own_domain.hpp"

namespace dds_test {

/// Settings for this machine, in the domain of this process.
inline bridges::DdsNetwork own_network() {
  bridges::DdsNetwork network = bridges::dds_network({}, [](const char*) -> const char* { return nullptr; });
  network.domain = own_domain();
  return network;
}

/// Waits for the next message of a reader; empty: the participant was stopped.
inline std::vector<std::byte> next(bridges::DdsParticipant& participant, bridges::DdsParticipant::Endpoint reader) {
  while (const auto ready = participant.wait())
    if (auto bytes = participant.take(reader)) return *bytes;
  return {};
}

}  // namespace dds_test
