// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

#include "shoal/sim_info_t.hpp"

namespace bridges {

/// Decodes the sim.info of a record.  Its world and versions, which are printed, have no control characters: the record
/// may be a stranger's.  Throws shoal::MessageError.
shoal::sim_info_t read_run_info(std::span<const std::byte> payload);

}  // namespace bridges
